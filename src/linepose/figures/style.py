"""How every figure looks: sizes, fonts, colours that colour-blind readers can tell apart, and files without dates."""

from collections.abc import Callable
from functools import wraps
from pathlib import Path
from typing import Any, Final, ParamSpec

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from linepose.storage import whole_file

HALF_PAGE_IN: Final = 3.5
WIDE_IN: Final = 5.2  # for several panels: still read when printed at half a page
PNG_DPI: Final = 200

# Okabe and Ito's colours.
BLACK: Final = "#000000"
BLUE: Final = "#0072B2"
GREEN: Final = "#009E73"
GREY: Final = "#999999"
ORANGE: Final = "#E69F00"
PURPLE: Final = "#CC79A7"
RED: Final = "#D55E00"
SKY: Final = "#56B4E9"
SEQUENTIAL: Final = "viridis"

# One colour for one thing in all figures.
ESTIMATE: Final = BLUE
HAND_MEASURED: Final = RED
TRUTH: Final = GREEN

_STYLE: Final[Any] = {
    "font.family": "DejaVu Sans",
    "font.size": 8,
    "axes.titlesize": 8,
    "axes.labelsize": 8,
    "xtick.labelsize": 7,
    "ytick.labelsize": 7,
    "legend.fontsize": 7,
    "legend.frameon": True,
    "legend.framealpha": 0.85,
    "legend.edgecolor": "none",
    "axes.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.formatter.useoffset": False,
    "grid.color": "#DDDDDD",
    "grid.linewidth": 0.4,
    "lines.linewidth": 1.2,
    "lines.markersize": 4,
    "patch.linewidth": 0.6,
    "image.cmap": SEQUENTIAL,
    "savefig.dpi": PNG_DPI,
    "pdf.fonttype": 42,
    "pdf.compression": 9,
    "mathtext.fontset": "dejavusans",
}

P = ParamSpec("P")


def styled(draw: Callable[P, Figure]) -> Callable[P, Figure]:
    """A drawing function that draws in this style, whatever matplotlib is set to elsewhere."""

    @wraps(draw)
    def in_style(*args: P.args, **kwargs: P.kwargs) -> Figure:
        with mpl.rc_context(_STYLE):
            return draw(*args, **kwargs)

    return in_style


def blank_figure(width_in: float, height_in: float) -> Figure:
    """An empty figure whose panels make room for their labels."""
    return Figure(figsize=(width_in, height_in), layout="constrained")


def few_ticks(axes: Axes, most: int = 5) -> None:
    """At most so many intervals on both axes, so that labels do not touch."""
    axes.xaxis.set_major_locator(MaxNLocator(most))
    axes.yaxis.set_major_locator(MaxNLocator(most))


def save(figure: Figure, stem: Path) -> None:
    """Write `stem`.png and `stem`.pdf, the same bytes for the same figure."""
    undated = {"CreationDate": None, "ModDate": None, "Producer": None, "Creator": None}
    with mpl.rc_context(_STYLE):
        with whole_file(stem.with_suffix(".png")) as path:
            figure.savefig(path, metadata={"Software": None})
        with whole_file(stem.with_suffix(".pdf")) as path:
            figure.savefig(path, metadata=undated)

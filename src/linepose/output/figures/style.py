"""How every figure looks: sizes, fonts, colours that colour-blind readers can tell apart, and files without dates."""

from collections.abc import Callable, Iterable
from functools import wraps
from pathlib import Path
from typing import Any, Final, ParamSpec

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.backends.backend_pdf import FigureCanvasPdf
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from linepose.tables import atomic_write

HALF_PAGE_IN: Final = 3.5
WIDE_IN: Final = 4.6  # for several panels: still read when printed at half a page
LEAST_PT: Final = 5.5  # of any text, printed at half a page
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

# One colour and shape for one pose in all figures, by its name in the legend.
POSE_MARKS: Final = {"optimum": (BLUE, "s"), "hand measured": (RED, "D"), "truth": (GREEN, "o")}

ON_A_CLOUD: Final[Any] = {"markersize": 5, "markeredgecolor": "white", "markeredgewidth": 0.6}

_STYLE: Final[Any] = {
    "font.family": "DejaVu Sans",
    "font.size": 8,
    "axes.titlesize": 8,
    "axes.labelsize": 8,
    "xtick.labelsize": 7.5,
    "ytick.labelsize": 7.5,
    "legend.fontsize": 7.5,
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


def pose_handles(names: Iterable[str]) -> list[Line2D]:
    """Legend entries of marked poses."""
    return [
        Line2D([], [], color=POSE_MARKS[name][0], marker=POSE_MARKS[name][1], linewidth=1.0, label=name)
        for name in names
    ]


def few_ticks(axes: Axes, most: int = 5) -> None:
    """At most so many intervals on both axes, so that labels do not touch."""
    axes.xaxis.set_major_locator(MaxNLocator(most))
    axes.yaxis.set_major_locator(MaxNLocator(most))


def save(figure: Figure, stem: Path) -> None:
    """Write `stem`.png and `stem`.pdf, the same bytes for the same figure."""
    undated = {"CreationDate": None, "ModDate": None, "Producer": None, "Creator": None}
    with mpl.rc_context(_STYLE):
        with atomic_write(stem.with_suffix(".png")) as path:
            figure.savefig(path, metadata={"Software": None})
        figure.set_layout_engine("none")  # it is laid out; text is as large in both
        with atomic_write(stem.with_suffix(".pdf")) as path:
            canvas: Any = FigureCanvasPdf(figure)
            canvas.print_pdf(path, metadata=undated)  # savefig would go through the figure twice

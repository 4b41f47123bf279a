"""The last page: where each point is, how the print is mounted, and how large its details must be."""

from typing import TYPE_CHECKING, Final

import numpy as np

from linepose.output.printing.board import OVERLAP_MM, title_of
from linepose.output.printing.page import blank_page, paint, window
from linepose.output.printing.paper import MARGIN_MM, paper_of
from linepose.survey.targets.artwork import Artwork, Disc, Rectangle, Shape
from linepose.survey.targets.base import GridSection

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_PAPER: Final = "A4"
_MOST_IDS: Final = 60  # that are written beside their points; of more, every second or third
_SKETCH_MM: Final = (170.0, 110.0)
_RANGES_M: Final = (1.0, 2.0, 4.0, 8.0)
_PIXELS_MRAD: Final = (0.25, 0.5, 1.0, 2.0)
_LINE_MM: Final = 5.2


def notes(target: GridSection, artwork: Artwork, is_tiled: bool) -> "Figure":
    """A page in A4 for the person who prints and mounts the target."""
    paper = paper_of(_PAPER)
    page = blank_page(paper)
    axes = window(page, paper, MARGIN_MM, MARGIN_MM, *paper.inner_mm)
    width, height = paper.inner_mm
    axes.text(0, height - 4, title_of(target), fontsize=13, va="top")
    _sketch(axes, target, artwork, width / 2, height - 20 - _SKETCH_MM[1] / 2)
    top = height - 20 - _SKETCH_MM[1] - 10
    for number, line in enumerate(_words(artwork, is_tiled)):
        axes.text(0, top - _LINE_MM * number, line, fontsize=9, va="top")
    _sizes(axes, target, top - _LINE_MM * (len(_words(artwork, is_tiled)) + 1))
    return page


def _words(artwork: Artwork, is_tiled: bool) -> list[str]:
    lines = [
        f"The print is {artwork.width_m * 1e3:.1f} mm wide and {artwork.height_m * 1e3:.1f} mm high.",
        "Print it at 100 %, without fitting it to the page, matt rather than glossy.",
        "Measure the bar at the lower edge of each sheet: a print that is off is off in all its spacings.",
        "Glue it without bubbles onto a plate that stays flat: aluminium composite, glass, 10 mm plywood.",
        "It must not move or bend between the first scan and the last; fix it, and shade no part of it.",
        "The sketch shows it from its front; a scan may mirror it, which does no harm.",
    ]
    if is_tiled:
        lines.insert(
            3,
            f"Sheets overlap by {OVERLAP_MM:g} mm: cut each at its solid marks, lay it on the dotted ones of the one "
            "before, glue.",
        )
    return lines


def _sizes(axes: "Axes", target: GridSection, top_mm: float) -> None:
    """How large the most demanding detail must be, for some ranges and fields of view of a pixel."""
    detail = max(target.details(), key=lambda one: one.n_pixels / one.size_m)
    plural = "" if detail.n_pixels == 1 else "s"
    size_mm = detail.size_m * 1e3
    head = f"{detail.name} is {size_mm:.1f} mm. It must be as large as {detail.n_pixels:g} pixel{plural}, in mm:"
    axes.text(0, top_mm, head, fontsize=9, va="top")
    columns = [0.0, *(60.0 + 25.0 * np.arange(len(_RANGES_M)))]
    rows = [["a pixel sees", *(f"from {one:g} m" for one in _RANGES_M)]]
    rows += [
        [f"{mrad:g} mrad", *(f"{detail.n_pixels * mrad * range_m:.1f}" for range_m in _RANGES_M)]
        for mrad in _PIXELS_MRAD
    ]
    for number, row in enumerate(rows, start=1):
        for x, text in zip(columns, row, strict=True):
            axes.text(x, top_mm - _LINE_MM * number, text, fontsize=9, va="top")


def _sketch(axes: "Axes", target: GridSection, artwork: Artwork, x_mm: float, y_mm: float) -> None:
    """The print made small, with ids beside its points."""
    scale = min(_SKETCH_MM[0] / artwork.width_m, _SKETCH_MM[1] / artwork.height_m) / 1e3
    small = Artwork(
        artwork.width_m * scale, artwork.height_m * scale, tuple(_scaled(shape, scale) for shape in artwork.shapes)
    )
    paint(axes, small, x_mm, y_mm)
    points, step = target.points(), -(-len(target.points()) // _MOST_IDS)
    for name, (x, y) in list(zip(target.ids(), 1e3 * scale * points[:, :2], strict=True))[::step]:
        box = {"boxstyle": "round,pad=0.15", "facecolor": "white", "edgecolor": "0.6", "linewidth": 0.3}
        axes.text(x_mm + x, y_mm - y, str(name), fontsize=6, ha="center", va="center", color="#dc267f", bbox=box)


def _scaled(shape: Shape, scale: float) -> Shape:
    if isinstance(shape, Disc):
        return Disc(shape.x_m * scale, shape.y_m * scale, shape.diameter_m * scale, shape.white)
    return Rectangle(shape.x_m * scale, shape.y_m * scale, shape.width_m * scale, shape.height_m * scale, shape.white)

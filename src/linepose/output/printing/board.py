"""The print of a target: on one sheet, or over several with an overlap and marks where to cut."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from linepose.output.printing.page import bar, blank_page, paint, window
from linepose.output.printing.paper import MARGIN_MM, Paper
from linepose.survey.targets.artwork import Artwork
from linepose.survey.targets.base import GridSection

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

OVERLAP_MM: Final = 10.0
_MARK_MM: Final = 5.0
_ID_PT: Final = 9.0
_ID_GREY: Final = "0.4"
_PLACE_OF_ID: Final = 0.36  # of the spacing, from a point to its id


@dataclass(frozen=True)
class Tiles:
    """How a field is spread over sheets: columns and rows of them, and how much each one shows (mm)."""

    n_columns: int
    n_rows: int
    width_mm: float
    height_mm: float


def sheet(target: GridSection, artwork: Artwork, paper: Paper) -> "Figure":
    """The whole print on one sheet, with the bar and the ids."""
    laid = paper.laid_for(artwork.width_m, artwork.height_m)
    page = blank_page(laid)
    axes = window(page, laid, 0, 0, laid.width_mm, laid.height_mm)
    centre = laid.width_mm / 2, laid.height_mm / 2
    paint(axes, artwork, *centre)
    _ids(axes, target, *centre)
    bar(axes, MARGIN_MM, laid.inner_mm[0], title_of(target))
    return page


def tiles_of(artwork: Artwork, paper: Paper) -> Tiles:
    """The fewest sheets that hold the field, each overlapping the next; the paper is laid as it needs fewer."""

    def count(length_mm: float, side_mm: float) -> int:
        return max(1, math.ceil((length_mm - OVERLAP_MM) / (side_mm - OVERLAP_MM) - 1e-9))

    width, height = paper.inner_mm
    return Tiles(count(artwork.width_m * 1e3, width), count(artwork.height_m * 1e3, height), width, height)


def laid_for_tiles(artwork: Artwork, paper: Paper) -> Paper:
    """The paper upright or on its side, whichever takes fewer sheets."""
    turned = Paper(paper.name, paper.height_mm, paper.width_mm)

    def n_sheets(one: Paper) -> int:
        tiles = tiles_of(artwork, one)
        return tiles.n_columns * tiles.n_rows

    return min((paper, turned), key=n_sheets)


def tiled(target: GridSection, artwork: Artwork, paper: Paper) -> list["Figure"]:
    """The print over several sheets, row by row from top left."""
    laid = laid_for_tiles(artwork, paper)
    tiles = tiles_of(artwork, laid)
    whole_x = tiles.n_columns * (tiles.width_mm - OVERLAP_MM) + OVERLAP_MM
    whole_y = tiles.n_rows * (tiles.height_mm - OVERLAP_MM) + OVERLAP_MM
    pages = []
    for row in range(tiles.n_rows):
        for column in range(tiles.n_columns):
            page = blank_page(laid)
            axes = window(page, laid, MARGIN_MM, MARGIN_MM, tiles.width_mm, tiles.height_mm)
            centre_x = whole_x / 2 - column * (tiles.width_mm - OVERLAP_MM)
            centre_y = tiles.height_mm - (whole_y / 2 - row * (tiles.height_mm - OVERLAP_MM))
            paint(axes, artwork, centre_x, centre_y)
            _ids(axes, target, centre_x, centre_y)
            around = window(page, laid, 0, 0, laid.width_mm, laid.height_mm)
            _crop_marks(around, laid, column < tiles.n_columns - 1, row < tiles.n_rows - 1)
            name = f"sheet {row + 1}.{column + 1} of {tiles.n_rows} rows, {tiles.n_columns} columns"
            bar(around, MARGIN_MM + _MARK_MM, laid.inner_mm[0], f"{name}. {title_of(target)}")
            pages.append(page)
    return pages


def title_of(target: GridSection) -> str:
    """The print in a few words."""
    return f"linepose {target.kind}, {target.rows} x {target.columns}, spacing {target.spacing * 1e3:g} mm"


def _crop_marks(axes: "Axes", paper: Paper, has_right: bool, has_below: bool) -> None:
    """Marks in the margin at the edges of what a sheet shows, and where the next sheet's edge comes to lie."""
    left, bottom = MARGIN_MM, MARGIN_MM
    right, top = paper.width_mm - MARGIN_MM, paper.height_mm - MARGIN_MM
    across = [(left, "-"), (right, "-"), *([(right - OVERLAP_MM, ":")] if has_right else [])]
    along = [(bottom, "-"), (top, "-"), *([(bottom + OVERLAP_MM, ":")] if has_below else [])]
    for x, style in across:
        for y in (bottom, top):
            beyond = -_MARK_MM if y == bottom else _MARK_MM
            axes.plot([x, x], [y, y + beyond], color="black", linewidth=0.3, linestyle=style)
    for y, style in along:
        for x in (left, right):
            beyond = -_MARK_MM if x == left else _MARK_MM
            axes.plot([x, x + beyond], [y, y], color="black", linewidth=0.3, linestyle=style)


def _ids(axes: "Axes", target: GridSection, centre_x_mm: float, centre_y_mm: float) -> None:
    """The ids on a dark field between the dots, in a grey that no scan shows; prints on white have them aside."""
    if target.kind != "rings":
        return
    away = _PLACE_OF_ID * target.spacing * 1e3 * np.sqrt(2)
    for name, (x, y) in zip(target.ids(), 1e3 * target.points()[:, :2], strict=True):
        axes.text(
            centre_x_mm + x + away,
            centre_y_mm - y - away,
            str(name),
            fontsize=_ID_PT,
            color=_ID_GREY,
            ha="center",
            va="center",
            clip_on=True,
        )

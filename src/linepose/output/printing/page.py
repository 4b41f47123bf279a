"""Pages on which a millimetre is a millimetre."""

from itertools import groupby
from typing import TYPE_CHECKING, Final

import numpy as np

from linepose.arrays import Floats
from linepose.output.printing.paper import Paper
from linepose.survey.targets.artwork import Artwork, Rectangle, Shape

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.path import Path as Outline

MM_PER_INCH: Final = 25.4
_BAR_MM: Final = 100.0
_BAR_OF_SMALL_MM: Final = 50.0
_BAR_HEIGHT_MM: Final = 6.5  # above the sheet's edge
_TICK_MM: Final = 1.5
_TEXT_PT: Final = 6.0


def blank_page(paper: Paper) -> "Figure":
    """An empty page of the paper's size."""
    from matplotlib.figure import Figure

    return Figure(figsize=(paper.width_mm / MM_PER_INCH, paper.height_mm / MM_PER_INCH))


def window(page: "Figure", paper: Paper, left_mm: float, bottom_mm: float, width_mm: float, height_mm: float) -> "Axes":
    """Axes over a part of the page in which a unit is a millimetre; what is beyond them is cut off."""
    axes = page.add_axes(
        (
            left_mm / paper.width_mm,
            bottom_mm / paper.height_mm,
            width_mm / paper.width_mm,
            height_mm / paper.height_mm,
        )
    )
    axes.set_xlim(0, width_mm)
    axes.set_ylim(0, height_mm)
    axes.axis("off")
    return axes


def paint(axes: "Axes", artwork: Artwork, centre_x_mm: float, centre_y_mm: float) -> None:
    """Paint what the axes show of an artwork whose origin is at a place of theirs; its y runs down the page.

    Neighbours of one colour in the order of painting are one path, which keeps seams and time away.
    """
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path as Outline

    centre = np.array([centre_x_mm, centre_y_mm])
    room = np.array([axes.get_xlim(), axes.get_ylim()])
    shown = [(shape, bounds) for shape in artwork.shapes if _overlaps(bounds := _bounds_mm(shape, centre), room)]
    for white, group in groupby(shown, key=lambda one: one[0].white):
        outline = Outline.make_compound_path(*(_outline(shape, bounds) for shape, bounds in group))
        colour = "white" if white else "black"
        axes.add_patch(PathPatch(outline, facecolor=colour, edgecolor="none", linewidth=0, snap=False))


def _bounds_mm(shape: Shape, centre_mm: Floats) -> Floats:
    """Least and greatest x and y of a shape on the page; (2, 2) in mm."""
    if isinstance(shape, Rectangle):
        x, y, size = shape.x_m + shape.width_m / 2, shape.y_m + shape.height_m / 2, (shape.width_m, shape.height_m)
    else:
        x, y, size = shape.x_m, shape.y_m, (shape.diameter_m, shape.diameter_m)
    middle, half = centre_mm + np.array([1e3 * x, -1e3 * y]), 500 * np.asarray(size)
    return np.stack([middle - half, middle + half], axis=-1)


def _overlaps(bounds_mm: Floats, room_mm: Floats) -> bool:
    return bool(np.all((bounds_mm[:, 0] < room_mm[:, 1]) & (bounds_mm[:, 1] > room_mm[:, 0])))


def _outline(shape: Shape, bounds_mm: Floats) -> "Outline":
    from matplotlib.path import Path as Outline

    (left, right), (bottom, top) = bounds_mm
    if isinstance(shape, Rectangle):
        return Outline([(left, bottom), (right, bottom), (right, top), (left, top), (left, bottom)], closed=True)
    return Outline.circle(((left + right) / 2, (bottom + top) / 2), (right - left) / 2)


def bar(axes: "Axes", left_mm: float, room_mm: float, text: str) -> None:
    """A line of a known length at the sheet's lower edge, to measure the print with, and a text behind it."""
    length = _BAR_MM if room_mm >= 2 * _BAR_MM else _BAR_OF_SMALL_MM
    y = _BAR_HEIGHT_MM
    axes.plot([left_mm, left_mm + length], [y, y], color="black", linewidth=0.5, solid_capstyle="butt")
    for x in (left_mm, left_mm + length):
        axes.plot([x, x], [y - _TICK_MM, y + _TICK_MM], color="black", linewidth=0.3)
    axes.text(
        left_mm + length + 2,
        y,
        f"{length:g} mm: measure it. {text}",
        fontsize=_TEXT_PT,
        va="center",
        color="black",
    )

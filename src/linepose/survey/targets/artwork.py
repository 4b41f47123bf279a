"""What is printed of a target: rectangles and discs, in black and white, painted one over the other.

Board frame: origin at the centre, x along the columns to the right, y from one row down to the next, z away from the
viewer; metres.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Rectangle:
    """A filled rectangle by its smallest x and y (m), its size (m), and whether it is white."""

    x_m: float
    y_m: float
    width_m: float
    height_m: float
    white: bool


@dataclass(frozen=True)
class Disc:
    """A filled circle by its centre (m) and diameter (m), and whether it is white."""

    x_m: float
    y_m: float
    diameter_m: float
    white: bool


Shape = Rectangle | Disc


@dataclass(frozen=True)
class Artwork:
    """Shapes in the order in which they are painted on white paper, and the size of the field that holds them (m).

    The field is centred on the board's origin.
    """

    width_m: float
    height_m: float
    shapes: tuple[Shape, ...]

    def picture(self, resolution_m: float, margin_m: float = 0.0) -> NDArray[np.bool_]:
        """Which cells of a grid (H, W) over the field and a margin around it are white; row 0 has the smallest y."""
        n_columns = round((self.width_m + 2 * margin_m) / resolution_m)
        n_rows = round((self.height_m + 2 * margin_m) / resolution_m)
        x = (np.arange(n_columns) - (n_columns - 1) / 2) * resolution_m
        y = (np.arange(n_rows) - (n_rows - 1) / 2) * resolution_m
        white = np.ones((n_rows, n_columns), dtype=np.bool_)
        for shape in self.shapes:
            columns, rows = _within(shape, x, y)
            part = white[rows, columns]
            if isinstance(shape, Rectangle):
                part[:] = shape.white
            else:
                squared = (x[columns] - shape.x_m) ** 2 + (y[rows, None] - shape.y_m) ** 2
                part[squared <= shape.diameter_m**2 / 4] = shape.white
        return white


def _within(shape: Shape, x: NDArray[np.floating], y: NDArray[np.floating]) -> tuple[slice, slice]:
    """Columns and rows of the grid's centres x (W,), y (H,) that a shape's bounds hold."""
    if isinstance(shape, Rectangle):
        bounds = (shape.x_m, shape.x_m + shape.width_m), (shape.y_m, shape.y_m + shape.height_m)
    else:
        half = shape.diameter_m / 2
        bounds = (shape.x_m - half, shape.x_m + half), (shape.y_m - half, shape.y_m + half)
    columns, rows = (slice(*np.searchsorted(axis, bound)) for axis, bound in zip((x, y), bounds, strict=True))
    return columns, rows

"""Which pixel of a scan lies in which cell of a map, and where between its pixels a cell's centre lies; compiled.

Neighbouring pixels span triangles, in which lines and pixels are linear. Of all that fit a cell the nearest to its
centre counts, of equally near ones the first.
"""

from typing import Any, Final

import numpy as np
from numba import njit

from linepose.arrays import Floats
from linepose.compiling.kernels import FUSED_ARITHMETIC, kernel_part

_SLACK: Final = 1e-9  # of a triangle's weights, so that no centre falls between two triangles


@njit(cache=True, error_model="numpy", fastmath=FUSED_ARITHMETIC, nogil=True)
def pixels_in_cells(
    place: Any, lines: int, pixels: int, at: Any, cell_m: float, corner: Any, apart: Any, line: Any, pixel: Any
) -> None:
    """Enter the first lines and pixels of place (L, 2, P), easting and northing, into the cells that they lie in.

    at (2,): number of the first line and pixel; corner (2,): row and column of the first cell. apart, line, pixel (H,
    W): squared distance (cells) of the nearest pixel so far, and its numbers.
    """
    n_rows, n_columns = apart.shape
    for i in range(lines):
        for j in range(pixels):
            x, y = place[i, 0, j] / cell_m, -place[i, 1, j] / cell_m
            if x != x:
                continue
            x, y = x - corner[1], y - corner[0]
            row, column = int(np.floor(y)), int(np.floor(x))
            if row < 0 or column < 0 or row >= n_rows or column >= n_columns:
                continue
            off = (x - column - 0.5) ** 2 + (y - row - 0.5) ** 2
            if off < apart[row, column]:
                apart[row, column], line[row, column], pixel[row, column] = off, at[0] + i, at[1] + j


@kernel_part
def _fill(a: Floats, b: Floats, c: Floats, apart: Floats, line: Any, pixel: Any, between: Floats, skip: Any) -> None:
    """Enter the cells whose centres lie in a triangle of corners (4,): column, row, line and pixel."""
    n_rows, n_columns = apart.shape
    top, bottom = max(int(np.ceil(min(a[1], b[1], c[1]))), 0), min(int(np.floor(max(a[1], b[1], c[1]))), n_rows - 1)
    left, right = max(int(np.ceil(min(a[0], b[0], c[0]))), 0), min(int(np.floor(max(a[0], b[0], c[0]))), n_columns - 1)
    whole = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])
    if whole == 0.0:
        return
    for row in range(top, bottom + 1):
        for column in range(left, right + 1):
            if skip[row, column] >= 0:
                continue
            x, y = column - a[0], row - a[1]
            of_b = (x * (c[1] - a[1]) - (c[0] - a[0]) * y) / whole
            of_c = ((b[0] - a[0]) * y - x * (b[1] - a[1])) / whole
            of_a = 1.0 - of_b - of_c
            if of_a < -_SLACK or of_b < -_SLACK or of_c < -_SLACK:
                continue
            nearest, off = a, (a[0] - column) ** 2 + (a[1] - row) ** 2
            for one in (b, c):
                its = (one[0] - column) ** 2 + (one[1] - row) ** 2
                if its < off:
                    nearest, off = one, its
            if off < apart[row, column]:
                apart[row, column], line[row, column], pixel[row, column] = off, int(nearest[2]), int(nearest[3])
                between[0, row, column] = of_a * a[2] + of_b * b[2] + of_c * c[2]
                between[1, row, column] = of_a * a[3] + of_b * b[3] + of_c * c[3]


@njit(cache=True, error_model="numpy", fastmath=FUSED_ARITHMETIC, nogil=True)
def cells_in_mesh(
    place: Any,
    at: Any,
    cell_m: float,
    corner: Any,
    longest: float,
    apart: Any,
    line: Any,
    pixel: Any,
    between: Any,
    skip: Any,
) -> None:
    """Enter the cells whose centres lie between neighbouring pixels of place (L, 2, P), at most `longest` cells apart.

    As in `pixels_in_cells`; line, pixel: those of the triangle's nearest corner. between (2, H, W): line and pixel of
    the centre itself. Cells of which skip (H, W) is not negative are passed over.
    """
    n_rows, n_columns = apart.shape
    corners = np.empty((4, 4))
    for i in range(place.shape[0] - 1):
        for j in range(place.shape[2] - 1):
            for k in range(4):
                m, n = i + k // 2, j + k % 2
                corners[k, 0] = place[m, 0, n] / cell_m - corner[1] - 0.5
                corners[k, 1] = -place[m, 1, n] / cell_m - corner[0] - 0.5
                corners[k, 2], corners[k, 3] = at[0] + m, at[1] + n
            x, y = corners[:, 0], corners[:, 1]
            if np.isfinite(x[0] + x[1] + x[2] + x[3]) and (
                max(x[0], x[1], x[2], x[3]) < 0.0
                or max(y[0], y[1], y[2], y[3]) < 0.0
                or min(x[0], x[1], x[2], x[3]) > n_columns - 1
                or min(y[0], y[1], y[2], y[3]) > n_rows - 1
            ):
                continue
            for first, second, third in ((0, 1, 2), (3, 2, 1)):
                a, b, c = corners[first], corners[second], corners[third]
                if not np.isfinite(a[0] + b[0] + c[0]):
                    continue
                along = (a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2
                across = (a[0] - c[0]) ** 2 + (a[1] - c[1]) ** 2
                if max(along, across) <= longest * longest:
                    _fill(a, b, c, apart, line, pixel, between, skip)

"""What the camera looks at: the reflectance of the printed sheet and of the textured ground around it (compiled).

The print is black with white dots and rings, a white square beside point 0, and a white edge of bare paper.
"""

import numba
import numpy as np
from numpy.typing import NDArray

from linepose.survey import pattern

_HALF_X, _HALF_Y = pattern.SHEET_M[0] / 2, pattern.SHEET_M[1] / 2
_PRINT_X, _PRINT_Y = _HALF_X - pattern.PRINT_MARGIN_M, _HALF_Y - pattern.PRINT_MARGIN_M
_DOT, _INNER, _OUTER = (
    (diameter / 2) ** 2
    for diameter in (pattern.DOT_DIAMETER_M, pattern.RING_INNER_DIAMETER_M, pattern.RING_OUTER_DIAMETER_M)
)
_DX, _DY = pattern.COLUMN_SPACING_M, pattern.ROW_SPACING_M
_COLUMNS, _ROWS = pattern.N_COLUMNS, pattern.N_ROWS
_MARK_X, _MARK_Y, _MARK_HALF = *pattern.CORNER_MARK_CENTRE_M, pattern.CORNER_MARK_SIDE_M / 2


@numba.njit(cache=True, inline="always")
def on_sheet(x: float, y: float) -> bool:
    """Whether a point of the board's plane (m) is on the sheet."""
    return abs(x) <= _HALF_X and abs(y) <= _HALF_Y


@numba.njit(cache=True)
def sheet_reflectance(x: float, y: float, dark: float, bright: float) -> float:
    """Reflectance of the sheet at x, y (m) in the board frame."""
    if abs(x) > _PRINT_X or abs(y) > _PRINT_Y:
        return bright
    if abs(x - _MARK_X) <= _MARK_HALF and abs(y - _MARK_Y) <= _MARK_HALF:
        return bright
    squared = squared_distance_to_target(x, y)
    if squared <= _DOT or _INNER <= squared <= _OUTER:
        return bright
    return dark


@numba.njit(cache=True)
def squared_distance_to_target(x: float, y: float) -> float:
    """Squared distance (m^2) to the centre of the nearest target."""
    dx, dy = x - _DX * _column(x), y - _DY * _row(y)
    return dx * dx + dy * dy


@numba.njit(cache=True)
def covered(x: float, y: float, missing: NDArray[np.bool_]) -> bool:
    """Whether something lies over the nearest target, out to its ring; missing (M,) by point id."""
    if squared_distance_to_target(x, y) > _OUTER:
        return False
    row = _row(y) + (_ROWS - 1) // 2
    column = _column(x) + (_COLUMNS - 1) // 2
    if row % 2 == 1:
        column = _COLUMNS - 1 - column
    return missing[row * _COLUMNS + column]


@numba.njit(cache=True, inline="always")
def _column(x: float) -> int:
    """Nearest column, 0 in the middle."""
    half = (_COLUMNS - 1) // 2
    return max(-half, min(half, int(np.rint(x / _DX))))


@numba.njit(cache=True, inline="always")
def _row(y: float) -> int:
    """Nearest row, 0 in the middle."""
    half = (_ROWS - 1) // 2
    return max(-half, min(half, int(np.rint(y / _DY))))


@numba.njit(cache=True)
def ground_reflectance(x: float, y: float, mean: float, contrast: float, grain_m: float, seed: int) -> float:
    """Reflectance of the ground at x, y (m): two octaves of smooth noise, `mean (1 +- contrast)`."""
    coarse = smooth_noise(x / (4 * grain_m), y / (4 * grain_m), seed)
    fine = smooth_noise(x / grain_m, y / grain_m, seed + 1)
    return mean * (1.0 + contrast * (coarse + fine - 1.0))


@numba.njit(cache=True)
def smooth_noise(x: float, y: float, seed: int) -> float:
    """Random values (0 to 1) on the whole numbers, blended in between."""
    i, j = int(np.floor(x)), int(np.floor(y))
    a, b = x - i, y - j
    a, b = a * a * (3 - 2 * a), b * b * (3 - 2 * b)
    low = _hashed(i, j, seed) * (1 - a) + _hashed(i + 1, j, seed) * a
    high = _hashed(i, j + 1, seed) * (1 - a) + _hashed(i + 1, j + 1, seed) * a
    return low * (1 - b) + high * b


@numba.njit(cache=True)
def _hashed(i: int, j: int, seed: int) -> float:
    """A number from 0 to 1 that looks random in i, j and seed (finaliser of MurmurHash3)."""
    h = np.uint32(i * 73856093) ^ np.uint32(j * 19349663) ^ np.uint32(seed * 83492791)
    h = np.uint32((h ^ (h >> np.uint32(16))) * np.uint32(0x85EBCA6B))
    h = np.uint32((h ^ (h >> np.uint32(13))) * np.uint32(0xC2B2AE35))
    return (h ^ (h >> np.uint32(16))) / 4294967296.0

"""Patches of one rectified strip found in another by correlation of their light: how far two maps lie apart."""

from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from linepose.arrays import Floats
from linepose.inputs.rectified.rectify import Rectified
from linepose.inputs.tie_points.pairs import in_consensus

HALF: Final = 16  # cells from a patch's centre to its rim
SEARCH: Final = 16  # cells by which a patch may lie elsewhere in the other strip
MOST_PATCHES: Final = 64  # of two strips
_LEAST_CORRELATION: Final = 0.6
_CONTRAST: Final = 1e-6  # of a patch's light beside its mean, below which it shows nothing


@dataclass(frozen=True)
class Patches:
    """Patches (K,) that two strips show: raw line and pixel in each (K, 2), and how well they correlate (K,).

    n_tried, of which n_uncorrelated were not found again, and n_contradicted are not borne out by the others.
    """

    first: Floats
    second: Floats
    correlation: Floats
    n_tried: int
    n_uncorrelated: int
    n_contradicted: int


def patches_of(first: Rectified, second: Rectified) -> Patches:
    """Patches of the first strip that are found in the second; both rectified on one surface, with cells of one size.

    Raises no error: strips without ground in common have none.
    """
    centres = _centres(first, second)
    rows, at, correlation = [], [], []
    for row, centre in enumerate(centres):
        found = _found(first, second, centre)
        if found is not None:
            rows.append(row)
            at.append(found[0])
            correlation.append(found[1])
    here, there = centres[rows].astype(float), np.array(at).reshape(-1, 2)
    cell_m = first.cell_m
    kept = in_consensus(first.first_m + cell_m * here, second.first_m + cell_m * there, 0.5 * SEARCH * cell_m, cell_m)
    return Patches(
        _raw(first, here[kept]),
        _raw(second, there[kept]),
        np.array(correlation, dtype=float)[kept],
        len(centres),
        len(centres) - len(rows),
        int(len(rows) - kept.sum()),
    )


def _centres(first: Rectified, second: Rectified) -> NDArray[np.int64]:
    """Cells (K, 2), column and row, of the first strip around which both have seen all that is compared."""
    import cv2

    shift = np.rint((first.first_m - second.first_m) / first.cell_m).astype(int)  # to the second's cells
    usable = [
        cv2.erode(np.isfinite(one.intensity).astype(np.uint8), np.ones((2 * half + 1,) * 2, np.uint8), borderValue=0)
        for one, half in ((first, HALF), (second, HALF + SEARCH + 1))
    ]
    step = HALF  # patches overlap by half
    n_rows, n_columns = (size // step for size in first.intensity.shape)
    row, column = (one.ravel() for one in np.indices((n_rows, n_columns)))
    centres = np.stack([column, row], axis=1) * step + HALF
    there = centres + shift
    sizes = (np.array(one.intensity.shape[::-1]) for one in (first, second))
    inside = np.logical_and.reduce(
        [np.all((one >= 0) & (one < size), axis=1) for one, size in zip((centres, there), sizes, strict=True)]
    )
    centres, there = centres[inside], there[inside]
    seen = (usable[0][centres[:, 1], centres[:, 0]] > 0) & (usable[1][there[:, 1], there[:, 0]] > 0)
    centres = centres[seen]
    if len(centres) <= MOST_PATCHES:
        return centres
    return centres[np.linspace(0, len(centres) - 1, MOST_PATCHES).round().astype(int)]


def _found(first: Rectified, second: Rectified, centre: NDArray[np.int64]) -> tuple[Floats, float] | None:
    """Column and row (2,) in the second strip of what the first shows around a cell, and their correlation."""
    import cv2

    place = (first.first_m + first.cell_m * centre - second.first_m) / second.cell_m
    middle = np.rint(place).astype(int)
    template, window = _around(first, centre, HALF), _around(second, middle, HALF + SEARCH)
    if not template.std() > _CONTRAST * abs(template.mean()):
        return None
    score = cv2.matchTemplate(window, template, cv2.TM_CCOEFF_NORMED)
    row, column = np.unravel_index(int(np.argmax(score)), score.shape)
    rim = 2 * SEARCH
    if not score[row, column] >= _LEAST_CORRELATION or not (0 < row < rim and 0 < column < rim):
        return None
    along = _top(score[row, column - 1 : column + 2]), _top(score[row - 1 : row + 2, column])
    return middle + np.array([column, row]) - SEARCH + np.array(along), float(score[row, column])


def _around(strip: Rectified, cell: NDArray[np.int64], half: int) -> NDArray[np.float32]:
    column, row = cell
    return np.ascontiguousarray(strip.intensity[row - half : row + half + 1, column - half : column + half + 1])


def _top(three: NDArray[Any]) -> float:
    """Where the parabola through three scores has its top, from the middle one."""
    bend = float(three[0] - 2 * three[1] + three[2])
    return 0.5 * float(three[0] - three[2]) / bend if bend < 0 else 0.0


def _raw(strip: Rectified, at: Floats) -> Floats:
    """Raw line and pixel (K, 2) at fractional cells (K, 2), column and row, of a strip that has seen all around."""
    column, row = np.floor(at).astype(int).T
    right, below = (at - np.floor(at)).T
    values = []
    for grid in (strip.line, strip.u_px):
        above = grid[row, column] * (1 - right) + grid[row, column + 1] * right
        under = grid[row + 1, column] * (1 - right) + grid[row + 1, column + 1] * right
        values.append(above * (1 - below) + under * below)
    return np.stack(values, axis=1).astype(float)

"""Points of a board beside those that a detector found: where its map into the scan has them and the print fits.

A detector of pictures leaves out markers and corners at the limit of resolution. Where a part of the board is found,
the places of the rest are known to a fraction of the spacing.
"""

from typing import Final

import numpy as np

from linepose.arrays import Floats
from linepose.inputs.scans.scan_files import Intensity
from linepose.inputs.targets.board_in_scan import BoardInScan, fit_board
from linepose.inputs.targets.match_print import match_print
from linepose.survey.targets.base import RectifiedSection

_FEWEST: Final = 4  # points through which the map is told with one to spare
_NEAR: Final = 1.5  # spacings from a point that is found: its neighbours, across too
_FAR_OFF: Final = 5.0  # times the median misfit of points that are found
_LEAST_FAR_OFF: Final = 0.05  # of the spacing


def completed(
    intensity: Intensity, target: RectifiedSection, row: np.ndarray, position: Floats
) -> tuple[np.ndarray, Floats]:
    """Rows (m,) of the target's points and their refined places (m, 2), from places (n, 2) of rows (n,) found.

    Places are refined first and left out where the print does not fit. Then neighbours are looked for about the places
    that the map through all has for them, and neighbours of these in turn, as long as the map through both holds.
    """
    position = _matched(intensity, target, row, position, row, position)
    row, position = row[np.isfinite(position[:, 0])], position[np.isfinite(position[:, 0])]
    while len(row) >= _FEWEST:
        beside, place = _beside(intensity, target, row, position)
        if not len(beside):
            break
        row, position = np.concatenate([row, beside]), np.concatenate([position, place])
    return row, position


def _beside(
    intensity: Intensity, target: RectifiedSection, row: np.ndarray, position: Floats
) -> tuple[np.ndarray, Floats]:
    """Rows (m,) and places (m, 2) of further points beside those found (n,), where print and map fit."""
    board_m = target.points()[:, :2]
    apart = np.linalg.norm(board_m[:, None] - board_m[row], axis=-1).min(axis=1)
    beside = np.setdiff1d(np.flatnonzero(apart < _NEAR * target.spacing), row)
    expected = fit_board(board_m[row], position).position(board_m[beside])
    inside = np.all((expected >= 0) & (expected <= np.array(intensity.shape[::-1]) - 1), axis=1)
    beside, expected = beside[inside], expected[inside]
    if not len(beside):
        return beside, expected
    place = _matched(intensity, target, beside, expected, row, position)
    seen = np.isfinite(place[:, 0])
    beside, place = beside[seen], place[seen]
    both = np.concatenate([row, beside])
    through_both = fit_board(board_m[both], np.concatenate([position, place]))
    off_m = _off_m(through_both, board_m[both], np.concatenate([position, place]))
    limit_m = max(_FAR_OFF * np.median(off_m[: len(row)]), _LEAST_FAR_OFF * target.spacing)
    fits = off_m[len(row) :] < limit_m
    return beside[fits], place[fits]


def _off_m(board: BoardInScan, board_m: Floats, position: Floats) -> Floats:
    """How far positions (n, 2) lie from where the map has board points (n, 2), on the board (m); (n,)."""
    off = np.linalg.solve(board.jacobian(board_m), (position - board.position(board_m))[..., None])[..., 0]
    return np.asarray(np.linalg.norm(off, axis=-1), dtype=float)


def _matched(
    intensity: Intensity,
    target: RectifiedSection,
    row: np.ndarray,
    position: Floats,
    found_row: np.ndarray,
    found: Floats,
) -> Floats:
    """Refined places (n, 2) of rows (n,) near positions (n, 2); the local map is that of what is found."""
    board_m = target.points()[:, :2]
    jacobian = fit_board(board_m[found_row], found).jacobian(board_m[row])
    return match_print(intensity, target, board_m[row], position, jacobian)

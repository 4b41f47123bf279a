"""Points of a board beside those that a detector found: where its map into the scan has them and the print fits.

A detector of pictures leaves out markers and corners at the limit of resolution. Where a part of the board is found,
the places of the rest are known to a fraction of the spacing.
"""

from typing import Final

import numpy as np

from linepose.arrays import Floats
from linepose.inputs.scans.scan_files import Intensity
from linepose.inputs.targets.board_in_scan import fit_board
from linepose.inputs.targets.match_print import match_print
from linepose.survey.targets.base import RectifiedSection

_NEAR: Final = 1.5  # spacings from a point that is found: its neighbours, across too


def completed(
    intensity: Intensity, target: RectifiedSection, row: np.ndarray, position: Floats
) -> tuple[np.ndarray, Floats]:
    """Rows (m,) of the target's points and their refined places (m, 2), from places (n, 2) of rows (n,) found.

    Places are refined first and left out where the print does not fit; then neighbours are looked for about the places
    that the map through all has for them, and neighbours of these in turn.
    """
    board_m = target.points()[:, :2]
    tried = np.zeros(len(board_m), dtype=bool)
    tried[row] = True
    position = _matched(intensity, target, row, position, row, position)
    row, position = row[np.isfinite(position[:, 0])], position[np.isfinite(position[:, 0])]
    while len(row):
        apart = np.linalg.norm(board_m[:, None] - board_m[row], axis=-1).min(axis=1)
        beside = np.flatnonzero(~tried & (apart < _NEAR * target.spacing))
        if not len(beside):
            break
        tried[beside] = True
        expected = fit_board(board_m[row], position).position(board_m[beside])
        inside = np.all((expected >= 0) & (expected <= np.array(intensity.shape[::-1]) - 1), axis=1)
        beside, expected = beside[inside], expected[inside]
        if not len(beside):
            continue
        place = _matched(intensity, target, beside, expected, row, position)
        seen = np.isfinite(place[:, 0])
        row, position = np.concatenate([row, beside[seen]]), np.concatenate([position, place[seen]])
    return row, position


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

"""Which target is which: of all ways to lay the board over a lattice, those that put its corner mark on a bright spot.

Without the mark the board looks the same turned by half a turn or mirrored, and a reverse pass mirrors it.
"""

from collections.abc import Callable, Iterator
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from linepose.arrays import Floats
from linepose.inputs.scans.scan_files import Intensity
from linepose.inputs.targets.board_in_scan import BoardInScan, fit_board, fit_swinging_board
from linepose.inputs.targets.ring_board import RingBoard

_BRIGHT_MARK: Final = 0.6  # of the way from the holes to the rings
_DARK_CORNER: Final = 0.4
_PRINT: Final = 0.2  # darker than what may cover a mark
_MARK_CORE: Final = 0.3  # of the mark's side, each way from its centre: clear of the edge
_MAP_ERROR: Final = 0.32  # hole radii that the map may be off beyond the outermost targets
_IN_PLACE: Final = 4  # of the nine shifts: none
_ENOUGH_OF_MARK: Final = 0.5  # of its core, to be seen at the scan's edge
_TOWARDS_TARGET: Final = 0.45  # of the way from the mark to the target beside it: dark print

Oriented = list[tuple[NDArray[np.int64], BoardInScan]]
Orientations = Callable[[Intensity, Floats, NDArray[np.int64], RingBoard], Oriented]


def orientations(intensity: Intensity, centre: Floats, cell: NDArray[np.int64], board: RingBoard) -> Oriented:
    """Ids (n,) and the board's map for every way in which the corner mark shows; centres (n, 2) in cells (n, 2).

    One way is an answer; none, or several, leave the ids open.
    """
    found = []
    for ids in _ways(cell, board):
        in_scan = fit_board(board.points_m[ids], centre)
        if _mark_shows(intensity, in_scan, ids, board):
            found.append((ids, in_scan))
    return found


def doubtful_orientations(intensity: Intensity, centre: Floats, cell: NDArray[np.int64], board: RingBoard) -> Oriented:
    """The same for a mark that the map misses where the vehicle swings, and for one at the scan's edge or beyond.

    Of a whole board half a mark is enough, and none where the three other corners show and are dark.
    """
    whole = sorted((np.ptp(cell, axis=0) + 1).tolist()) == sorted([board.n_rows, board.n_columns])
    found = []
    for ids in _ways(cell, board):
        maps = fit_board(board.points_m[ids], centre), fit_swinging_board(board.points_m[ids], centre)
        for in_scan in filter(None, maps):
            shows = _mark_shows(intensity, in_scan, ids, board)
            if shows or (whole and _mark_at_edge(intensity, in_scan, ids, board)):
                found.append((ids, in_scan))
                break
    return found


def _ways(cell: NDArray[np.int64], board: RingBoard) -> Iterator[NDArray[np.int64]]:
    """Ids of the cells under each of eight turns and mirrors, at each place within the board."""
    for swapped in (False, True):
        for flip_across in (False, True):
            for flip_along in (False, True):
                turned = cell[:, ::-1] if swapped else cell
                extent = turned.max(axis=0)
                turned = np.where([flip_across, flip_along], extent - turned, turned)
                for i in range(board.n_columns - int(extent[0])):
                    for j in range(board.n_rows - int(extent[1])):
                        yield np.array([board.id_of_cell[a + i, b + j] for a, b in turned.tolist()])


def _mark_shows(intensity: Intensity, in_scan: BoardInScan, ids: NDArray[np.int64], board: RingBoard) -> bool:
    """Whether the mark is bright, the print beside it dark, and the other corners dark or beyond the scan.

    Each is looked for a little around its place: the map extrapolates here.
    """
    corners, beside = _levels(intensity, in_scan, ids, board)
    level = corners.mean(axis=2)
    elsewhere = level[1:].min(axis=1)
    return bool(level[0].max() > _BRIGHT_MARK and beside.min() < _DARK_CORNER and not np.any(elsewhere >= _DARK_CORNER))


def _mark_at_edge(intensity: Intensity, in_scan: BoardInScan, ids: NDArray[np.int64], board: RingBoard) -> bool:
    """Whether half of the mark or more shows and is bright, or none of it can and all other corners are dark."""
    corners, beside = _levels(intensity, in_scan, ids, board)
    n_seen = np.isfinite(corners).sum(axis=2)
    level = np.nansum(corners, axis=2) / np.maximum(n_seen, 1)
    whole = n_seen[1:, _IN_PLACE] == corners.shape[2]
    shown = n_seen[0] >= _ENOUGH_OF_MARK * corners.shape[2]
    print_is_dark = np.nanmin(beside, initial=np.inf) < _DARK_CORNER
    another = whole & (level[1:].min(axis=1) >= _DARK_CORNER)
    if level[0].max(where=shown, initial=0.0) > _BRIGHT_MARK and print_is_dark and not np.any(another):
        return True
    return bool(not shown[_IN_PLACE] and np.all(whole & (level[1:].max(axis=1) < _PRINT)))


def _levels(
    intensity: Intensity, in_scan: BoardInScan, ids: NDArray[np.int64], board: RingBoard
) -> tuple[Floats, Floats]:
    """Brightness between hole, 0, and ring, 1: of four corners, the mark's first, at nine shifts and nine places of the
    mark's core (4, 9, 9), and of the print beside the mark at those shifts (9,); NaN beyond the scan.
    """
    angle = np.linspace(0, 2 * np.pi, 16, endpoint=False)
    circle = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    ring_m = board.bright_radius * board.hole_radius_m
    dark = np.nanmedian(_sampled(intensity, in_scan, board.points_m[ids, None] + 0.6 * board.hole_radius_m * circle))
    bright = np.nanmedian(_sampled(intensity, in_scan, board.points_m[ids, None] + ring_m * circle))
    mark = np.array(board.corner_mark_centre_m)
    corners = mark * np.array([[1, 1], [1, -1], [-1, 1], [-1, -1]])
    grid = np.stack(np.meshgrid([-1, 0, 1], [-1, 0, 1]), axis=-1).reshape(-1, 2)
    core, shift = board.corner_mark_side_m * _MARK_CORE * grid, _MAP_ERROR * board.hole_radius_m * grid
    beside = mark + _TOWARDS_TARGET * (board.points_m[0] - mark)
    at_corners = _sampled(intensity, in_scan, corners[:, None, None] + shift[:, None] + core)
    at_print = _sampled(intensity, in_scan, beside + shift)
    return (at_corners - dark) / (bright - dark), (at_print - dark) / (bright - dark)


def _sampled(intensity: Intensity, in_scan: BoardInScan, board_m: Floats) -> Floats:
    """Intensities at board points (..., 2), NaN beyond the scan; (...)."""
    position = in_scan.position(board_m)
    sampled = ndimage.map_coordinates(
        intensity.astype(float), [position[..., 1], position[..., 0]], order=1, mode="constant", cval=np.nan
    )
    return np.asarray(sampled)

"""Which target is which: of all ways to lay the board over a lattice, those that put its corner mark on a bright spot.

Without the mark the board looks the same turned by half a turn or mirrored, and a reverse pass mirrors it.
"""

from collections.abc import Iterator
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from linepose.arrays import Floats
from linepose.inputs.scans.scan_files import Intensity
from linepose.inputs.targets.board_in_scan import BoardInScan, fit_board
from linepose.inputs.targets.ring_board import RingBoard

_BRIGHT_MARK: Final = 0.6  # of the way from the holes to the rings
_DARK_CORNER: Final = 0.4
_MARK_CORE: Final = 0.3  # of the mark's side, each way from its centre: clear of the edge
_MAP_ERROR: Final = 0.32  # hole radii that the map may be off beyond the outermost targets
_TOWARDS_TARGET: Final = 0.45  # of the way from the mark to the target beside it: dark print


def orientations(
    intensity: Intensity, centre: Floats, cell: NDArray[np.int64], board: RingBoard
) -> list[tuple[NDArray[np.int64], BoardInScan]]:
    """Ids (n,) and the board's map for every way in which the corner mark shows; centres (n, 2) in cells (n, 2).

    One way is an answer; none, or several, leave the ids open.
    """
    found = []
    for ids in _ways(cell, board):
        in_scan = fit_board(board.points_m[ids], centre)
        if _mark_shows(intensity, in_scan, ids, board):
            found.append((ids, in_scan))
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
    angle = np.linspace(0, 2 * np.pi, 16, endpoint=False)
    circle = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    ring_m = board.bright_radius * board.hole_radius_m
    dark = np.nanmedian(_sampled(intensity, in_scan, board.points_m[ids, None] + 0.6 * board.hole_radius_m * circle))
    bright = np.nanmedian(_sampled(intensity, in_scan, board.points_m[ids, None] + ring_m * circle))
    mark = np.array(board.corner_mark_centre_m)
    corners = mark * np.array([[1, 1], [1, -1], [-1, 1], [-1, -1]])
    grid = np.stack(np.meshgrid([-1, 0, 1], [-1, 0, 1]), axis=-1).reshape(-1, 2)
    core, shift = board.corner_mark_side_m * _MARK_CORE * grid, _MAP_ERROR * board.hole_radius_m * grid
    level = _sampled(intensity, in_scan, corners[:, None, None] + shift[:, None] + core).mean(axis=2)
    level = (level - dark) / (bright - dark)  # (4 corners, 9 shifts)
    beside = mark + _TOWARDS_TARGET * (board.points_m[0] - mark)
    print_level = (_sampled(intensity, in_scan, beside + shift).min() - dark) / (bright - dark)
    elsewhere = level[1:].min(axis=1)
    return bool(level[0].max() > _BRIGHT_MARK and print_level < _DARK_CORNER and not np.any(elsewhere >= _DARK_CORNER))


def _sampled(intensity: Intensity, in_scan: BoardInScan, board_m: Floats) -> Floats:
    """Intensities at board points (..., 2), NaN beyond the scan; (...)."""
    position = in_scan.position(board_m)
    sampled = ndimage.map_coordinates(
        intensity.astype(float), [position[..., 1], position[..., 0]], order=1, mode="constant", cval=np.nan
    )
    return np.asarray(sampled)

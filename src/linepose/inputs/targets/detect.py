"""Finding the board in a whole scan, its points and their ids, without labels.

Rings are sought in the scan with lines averaged in blocks, coarse ones first, because slow passes stretch the board
over thousands of lines. What remains doubtful is said, not guessed: such an observation has a reason and no ids.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Final

import numpy as np
from numpy.typing import NDArray

from linepose.arrays import Floats
from linepose.inputs.scans.scan_files import Intensity, Scan
from linepose.inputs.targets.board_in_scan import BoardInScan, fit_board
from linepose.inputs.targets.dot_alone import dot_alone
from linepose.inputs.targets.lattice import grow_lattice
from linepose.inputs.targets.orientation import Orientations, doubtful_orientations, orientations
from linepose.inputs.targets.refine import Refine, refine_points
from linepose.inputs.targets.ring_board import RingBoard, ring_board
from linepose.inputs.targets.targets import find_targets, ring_score
from linepose.survey.targets.rings import RingsSection

_BLOCKS: Final = (32, 16, 8, 4, 2, 1)  # lines averaged into one
_FEWEST_TARGETS: Final = 6
_FEWEST_LINES: Final = 20
_RING_SCORE: Final = 0.7
_FARTHEST_DOT: Final = 0.32  # hole radii from where the map expects it


@dataclass(frozen=True)
class Detection:
    """Points found in one scan: ids (n,), u (n,) and fractional lines (n,).

    `doubt` says why there are none, or "", and `remedy` what helps, where it is known.
    """

    point: NDArray[np.int64]
    u_px: Floats
    line: Floats
    doubt: str = ""
    board_found: bool = True
    remedy: str = ""

    @property
    def position(self) -> Floats:
        """Positions (n, 2) of u and line."""
        return np.stack([self.u_px, self.line], axis=-1)


Detector = Callable[[Scan], Detection]


@dataclass(frozen=True)
class _View:
    """The best lattice of some averaging: how many targets, the ways to read it, the map to the full scan."""

    n_targets: int
    boards: list[BoardInScan]


def ring_detector(section: RingsSection, refine: Refine) -> Detector:
    """What finds this board of rings in a scan."""
    return partial(detect, refine=refine, section=section)


def detect(scan: Scan, refine: Refine, section: RingsSection | None = None) -> Detection:
    """The board's points in a scan, their dots' centres by `refine`, ordered by id; of the paper's board by default."""
    board = ring_board(section or RingsSection())
    best = _View(0, [])
    for block in _BLOCKS:
        if len(scan.intensity) // block < _FEWEST_LINES:
            continue
        view = _view(scan.intensity, block, board)
        if (len(view.boards) == 1, view.n_targets) > (len(best.boards) == 1, best.n_targets):
            best = view
        if best.n_targets == board.n_points and len(best.boards) == 1:
            break
    if best.n_targets >= _FEWEST_TARGETS and not best.boards:
        best = _looked_for_again(scan.intensity, board, best)
    if best.n_targets < _FEWEST_TARGETS:
        found = f"no board: {best.n_targets} rings in a lattice where at least {_FEWEST_TARGETS} are needed"
        return _nothing(found, board_found=False)
    if len(best.boards) != 1:
        kind = "not seen" if not best.boards else "seen in several corners"
        return _nothing(f"{best.n_targets} rings, but the corner mark is {kind}: the ids are open", board_found=True)
    return _points(scan.intensity, best.boards[0], refine, board)


def _looked_for_again(intensity: Intensity, board: RingBoard, best: _View) -> _View:
    """The coarsest view of as many targets that leaves one way for a mark that was not seen at first."""
    for block in _BLOCKS:
        if len(intensity) // block < _FEWEST_LINES:
            continue
        view = _view(intensity, block, board, doubtful_orientations)
        if len(view.boards) == 1 and view.n_targets == best.n_targets:
            return view
    return best


def _nothing(doubt: str, board_found: bool) -> Detection:
    return Detection(np.zeros(0, dtype=np.int64), np.zeros(0), np.zeros(0), doubt, board_found)


def _view(intensity: Intensity, block: int, board: RingBoard, oriented: Orientations = orientations) -> _View:
    """What the scan shows with so many lines averaged into one."""
    n_lines = len(intensity) // block
    averaged = intensity[: n_lines * block].reshape(n_lines, block, -1).mean(axis=1)
    targets = find_targets(averaged, board)
    index, cell = grow_lattice(targets, board)
    if len(index) < _FEWEST_TARGETS:
        return _View(len(index), [])
    boards = []
    for ids, _ in oriented(averaged, targets.centre[index], cell, board):
        centre = targets.centre[index] * [1, block] + [0, (block - 1) / 2]
        boards.append(fit_board(board.points_m[ids], centre))
    return _View(len(index), boards)


def _points(intensity: Intensity, in_scan: BoardInScan, refine: Refine, board: RingBoard) -> Detection:
    """Dots where the map expects them, kept where a ring surrounds them and they are in its middle."""
    expected, jacobian = in_scan.position(board.points_m), in_scan.jacobian(board.points_m)
    hole = (board.hole_radius_m / 2) ** 2 * jacobian @ np.swapaxes(jacobian, -1, -2)
    inside = np.all((expected >= -0.5) & (expected <= np.array(intensity.shape[::-1]) - 0.5), axis=1)
    ringed = ring_score(intensity, expected, hole, board) >= _RING_SCORE
    candidates = np.flatnonzero(inside & ringed)
    found = refine_points(refine, intensity, expected[candidates])

    def in_middle() -> NDArray[np.bool_]:
        offset_m = np.linalg.solve(jacobian[candidates], (found - expected[candidates])[..., None])[..., 0]
        return np.asarray(np.linalg.norm(offset_m, axis=1) < _FARTHEST_DOT * board.hole_radius_m)  # false where no dot

    for row in np.flatnonzero(~in_middle()):
        found[row] = dot_alone(intensity, expected[candidates[row]], jacobian[candidates[row]], refine, board)
    kept = in_middle()
    return Detection(candidates[kept], found[kept, 0], found[kept, 1])

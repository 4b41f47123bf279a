"""Points whose places are known in a board's own frame, while the board's pose, of six parameters, is free.

With b the points as they were measured, T the pose of the board that fits the points P best, and r = P - T b what is
left, the board adds `|r|^2 / s^2` to chi squared, s the sigma of each coordinate: of the measurement and of a bend.
With J the derivatives of T b by the pose, the pose is eliminated where it stands: a step d of the points adds

    |r + Q d|^2 / s^2,     Q = 1 - J (J^T J)^-1 J^T.

The rest of its elimination, log|J^T J / s^2|, is one number for a rigid board, which no estimate depends on.
"""

from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from linepose.arrays import Floats
from linepose.geometry import rotations

N_BOARD_POSE: Final = 6
_OPEN: Final = 1e-9  # singular value of J, in units of its largest, below which a motion moves no point


class Placed(NamedTuple):
    """Points (n, 3) of a board where its best pose puts them, what is left of the points (n, 3), and the rotation."""

    points_m: Floats
    left_m: Floats
    rotation: Floats


def placed(board_m: Floats, points_m: Floats) -> Placed:
    """A board, measured as (n, 3) in its own frame, where it fits points (n, 3) best by a rigid motion."""
    middle, board_middle = points_m.mean(axis=0), board_m.mean(axis=0)
    left, _, right = np.linalg.svd((points_m - middle).T @ (board_m - board_middle))
    rotation = left @ np.diag([1.0, 1.0, np.linalg.det(left @ right)]) @ right
    there = (board_m - board_middle) @ rotation.T + middle
    return Placed(there, points_m - there, rotation)


def rigid_motions(points_m: Floats) -> Floats:
    """Orthonormal displacements (3 n, at most 6) of points (n, 3) that move as one body."""
    off = points_m - points_m.mean(axis=0)
    turned = [np.cross(axis, off).ravel() for axis in np.eye(3)]
    moved = [np.tile(axis, len(points_m)) for axis in np.eye(3)]
    columns = np.array([*turned, *moved]).T
    vectors, values, _ = np.linalg.svd(
        columns / np.maximum(np.linalg.norm(columns, axis=0), 1e-300), full_matrices=False
    )
    return np.asarray(vectors[:, values > _OPEN * values[0]])


class BoardKnowledge(NamedTuple):
    """What a board says of n points: information (3 n, 3 n), its product (3 n,) with the step there, chi_squared."""

    information: Floats
    vector: Floats
    chi_squared: float


def knowledge_of_board(board_m: Floats, sigma_m: float, points_m: Floats) -> BoardKnowledge:
    """What a board (n, 3), measured to a sigma, says of points (n, 3), linear about them."""
    there, left_m, _ = placed(board_m, points_m)
    motions = rigid_motions(there)
    information = (np.eye(len(motions)) - motions @ motions.T) / sigma_m**2
    return BoardKnowledge(information, -left_m.ravel() / sigma_m**2, float(np.sum(left_m**2)) / sigma_m**2)


def moved_with_board(board_m: Floats, points_m: Floats, step_m: Floats) -> Floats:
    """Points (n, 3) after a step (n, 3): its motion of the board as one body made exactly, the rest added.

    A turn of some degrees, added to each point as it is linear, would stretch the board by more than it is known to.
    """
    there, left_m, _ = placed(board_m, points_m)
    middle = there.mean(axis=0)
    off = there - middle
    shift, turn = _motion_of(off, step_m)
    turned = off @ rotations.matrix_from_rotation_vector(turn).T
    return middle + shift + turned + left_m + step_m - shift - np.cross(turn, off)


def _motion_of(off_m: Floats, step_m: Floats) -> tuple[Floats, Floats]:
    """Shift (3,) and turn (3,) that fit steps (n, 3) of points (n, 3) about their middle best."""
    shift = step_m.mean(axis=0)
    inertia = np.sum(off_m**2) * np.eye(3) - off_m.T @ off_m
    return shift, np.linalg.pinv(inertia, rcond=_OPEN, hermitian=True) @ np.cross(off_m, step_m).sum(axis=0)


def spreads(board_m: Floats, which: NDArray[np.bool_]) -> bool:
    """Whether these points (n,) of a board (n, 3) hold its pose: three that lie on no line."""
    if which.sum() < 3:
        return False
    off = board_m[which] - board_m[which].mean(axis=0)
    return bool(np.linalg.matrix_rank(off, tol=_OPEN * np.abs(off).max()) >= 2)

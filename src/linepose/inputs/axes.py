"""Axes of navigation systems: from east, north, up to north, east, down, and from forward, left, up to our body's.

Roll, pitch and yaw here are always those of the body (x forward, y right, z down) in north, east, down.
"""

from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from linepose.arrays import Floats
from linepose.geometry import rotations

NED_FROM_ENU: Final[Floats] = np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]])
FRD_FROM_FLU: Final[Floats] = np.diag([1.0, -1.0, -1.0])


def ned_from_enu(vectors: ArrayLike) -> Floats:
    """Vectors in north, east, down of vectors in east, north, up; (..., 3) to (..., 3)."""
    return np.asarray(vectors, dtype=float) @ NED_FROM_ENU.T


def matrix_from_enu_flu(matrices: ArrayLike) -> Floats:
    """Body to north, east, down, of attitudes that map forward, left, up to east, north, up (REP-103)."""
    return np.asarray(NED_FROM_ENU @ np.asarray(matrices, dtype=float) @ FRD_FROM_FLU.T)


def enu_covariance(covariance: ArrayLike) -> Floats:
    """Covariances in north, east, down of covariances in east, north, up; (..., 3, 3) to (..., 3, 3)."""
    return np.asarray(NED_FROM_ENU @ np.asarray(covariance, dtype=float) @ NED_FROM_ENU.T)


def euler_by_small_rotation(euler_rad: ArrayLike) -> Floats:
    """Jacobian of (roll, pitch, yaw) by a small rotation about north, east, down; (..., 3) to (..., 3, 3).

    Singular where the body points straight up or down.
    """
    return np.asarray(np.linalg.inv(rotations.small_rotation_by_euler(euler_rad)))


def turned_angles(turn: ArrayLike, euler_rad: ArrayLike) -> Floats:
    """Euler angles (K, 3) of bodies whose old angles are `euler_rad` (K, 3), seen from axes that `turn` (K, 3, 3)."""
    matrices = np.asarray(turn, dtype=float) @ rotations.matrix_from_euler(np.asarray(euler_rad, dtype=float))
    return rotations.euler_from_matrix(matrices)


def turned(covariance: ArrayLike, turn: ArrayLike, euler_rad: ArrayLike) -> tuple[Floats, Floats]:
    """Euler angles (K, 3) and covariances (K, 6, 6) of position and angles, seen from axes that are turned.

    `turn` (K, 3, 3) takes vectors from the old axes to the new; `euler_rad` (K, 3) are the old angles.
    """
    old, matrix = np.asarray(euler_rad, dtype=float), np.asarray(turn, dtype=float)
    new = turned_angles(matrix, old)
    both = np.zeros((*matrix.shape[:-2], 6, 6))
    both[..., :3, :3] = matrix
    both[..., 3:, 3:] = euler_by_small_rotation(new) @ matrix @ rotations.small_rotation_by_euler(old)
    return new, np.asarray(both @ np.asarray(covariance, dtype=float) @ np.swapaxes(both, -1, -2))


def diagonal_covariance(sigma: ArrayLike) -> Floats:
    """Covariances of independent quantities from standard deviations; (..., N) to (..., N, N).

    A negative deviation gives a negative variance, which no record is joined with.
    """
    deviations = np.asarray(sigma, dtype=float)
    return np.asarray((deviations * np.abs(deviations))[..., :, None] * np.eye(deviations.shape[-1]))


def joined_covariance(position: ArrayLike, angles: ArrayLike) -> Floats:
    """Covariances (K, 6, 6) of independent position (K, 3, 3) and angles (K, 3, 3)."""
    first, second = np.asarray(position, dtype=float), np.asarray(angles, dtype=float)
    both = np.zeros((len(first), 6, 6))
    both[:, :3, :3], both[:, 3:, 3:] = first, second
    return both

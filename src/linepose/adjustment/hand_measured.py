"""The hand-measured pose as a prior: a position, and a rotation known about every axis of the body.

With `eps = log(R_hand R^T)` and a small step `R' = exp(delta) R`, the hand measurement is the linear observation
`eps = J_r(eps)^-1 delta + noise`, J_r the right Jacobian of SO(3): a sigma about each body axis whatever the attitude
is, where sigmas of Euler angles shrink to nothing as pitch nears a right angle.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from linepose.arrays import Floats
from linepose.compiling.kernels import kernel
from linepose.errors import InputError
from linepose.geometry import rotations
from linepose.geometry.pose import check_pose

_SMALL_ANGLE_RAD: Final = 1e-4  # below this the series is exact to double precision
FARTHEST_SIGMAS: Final = 20.0  # of the hand measurement ...
FARTHEST_M: Final = 2.0  # ... but no nearer than this


@dataclass(frozen=True)
class HandMeasuredPrior:
    """A pose (6,) with a rotation vector, and the covariance (6, 6) of position (m) and turn about body axes (rad)."""

    pose: Floats
    covariance: Floats

    def information(self, position_m: Floats, rotation: Floats) -> tuple[Floats, Floats, float]:
        """Information (6, 6) of a step of position and small rotation, the vector (6,) of it, chi squared with no step.

        At a position (3,) and rotation (3, 3) of the camera in the body.
        """
        error, by_step = _error_of_step(self.pose[:3] - position_m, self._rotation, rotation)
        weighted = by_step.T @ self._information
        return weighted @ by_step, weighted @ error, float(error @ self._information @ error)

    @cached_property
    def _rotation(self) -> Floats:
        return rotations.matrix_from_rotation_vector(self.pose[3:])

    @cached_property
    def _information(self) -> Floats:
        return np.asarray(np.linalg.inv(self.covariance))


@kernel
def _error_of_step(offset_m: Floats, hand: Floats, rotation: Floats) -> tuple[Floats, Floats]:
    """The error (6,) of an offset (3,) and of rotations (3, 3), and its Jacobian (6, 6) by a step."""
    relative = hand @ rotation.T
    turn = _rotation_vector(relative)
    squared = turn[0] ** 2 + turn[1] ** 2 + turn[2] ** 2
    angle = np.sqrt(squared)
    of_square = 1 / 12 if angle < _SMALL_ANGLE_RAD else (1 - 0.5 * angle / np.tan(0.5 * angle)) / squared
    error, by_step = np.empty(6), np.eye(6)
    for i in range(3):
        error[i], error[3 + i] = offset_m[i], turn[i]
        j, k = (i + 1) % 3, (i + 2) % 3
        by_step[3 + i, 3 + j] -= 0.5 * turn[k]
        by_step[3 + i, 3 + k] += 0.5 * turn[j]
        by_step[3 + i, 3 + i] -= of_square * squared
        for other in range(3):
            by_step[3 + i, 3 + other] += of_square * turn[i] * turn[other]
    return error, by_step


@kernel
def _rotation_vector(matrix: Floats) -> Floats:
    """The rotation vector (3,), at most pi long, of a rotation matrix (3, 3), by its quaternion (Shepperd 1978)."""
    trace = matrix[0, 0] + matrix[1, 1] + matrix[2, 2]
    largest = int(np.array([matrix[0, 0], matrix[1, 1], matrix[2, 2], trace]).argmax())
    vector = np.empty(3)
    if largest == 3:
        scalar = 1.0 + trace
        for i in range(3):
            j, k = (i + 1) % 3, (i + 2) % 3
            vector[i] = matrix[k, j] - matrix[j, k]
    else:
        i = largest
        j, k = (i + 1) % 3, (i + 2) % 3
        vector[i] = 1.0 - trace + 2.0 * matrix[i, i]
        vector[j], vector[k] = matrix[j, i] + matrix[i, j], matrix[k, i] + matrix[i, k]
        scalar = matrix[k, j] - matrix[j, k]
    if scalar < 0.0:
        scalar, vector = -scalar, -vector
    length = np.sqrt(vector[0] ** 2 + vector[1] ** 2 + vector[2] ** 2)
    if length == 0.0:
        return vector
    return vector * (2.0 * np.arctan2(length, scalar) / length)


def hand_measured(pose: Floats, covariance: Floats) -> HandMeasuredPrior:
    """The prior of a pose (6,) and covariance (6, 6); raises InputError for one that is not positive definite."""
    matrix = np.asarray(covariance, dtype=float)
    if matrix.shape != (6, 6):
        raise InputError("hand measurement", f"covariance of shape {matrix.shape}", "shape (6, 6)", "give one a pose")
    sigma = np.sqrt(np.maximum(np.diag(matrix), 0.0))
    good = bool(np.all(np.isfinite(matrix)) and np.all(sigma > 0) and np.allclose(matrix, matrix.T, rtol=1e-9, atol=0))
    if not good or np.linalg.eigvalsh(matrix / np.outer(sigma, sigma))[0] <= 0:
        raise InputError(
            "hand measurement",
            f"a covariance with sigmas {sigma.tolist()} that is not positive definite",
            "a symmetric positive definite one",
            "give positive sigmas",
        )
    return HandMeasuredPrior(check_pose(pose, "hand-measured pose"), matrix)


def ran_off(hand: HandMeasuredPrior | None, position_m: Floats) -> bool:
    """Whether a position (3,) is so far from the hand-measured one that no tape measure explains it."""
    if hand is None:
        return False
    sigma_m = np.sqrt(np.diag(hand.covariance)[:3])
    return bool(np.any(np.abs(position_m - hand.pose[:3]) > np.maximum(FARTHEST_SIGMAS * sigma_m, FARTHEST_M)))

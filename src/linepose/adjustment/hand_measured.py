"""The hand-measured pose as a prior: a position, and a rotation known about every axis of the body.

With `eps = log(R_hand R^T)` and a small step `R' = exp(delta) R`, the hand measurement is the linear observation
`eps = J_r(eps)^-1 delta + noise`, J_r the right Jacobian of SO(3): a sigma about each body axis whatever the attitude
is, where sigmas of Euler angles shrink to nothing as pitch nears a right angle.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.geometry import rotations
from linepose.geometry.pose import check_pose

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
        turn = rotations.rotation_vector_from_matrix(rotations.matrix_from_rotation_vector(self.pose[3:]) @ rotation.T)
        error = np.concatenate([self.pose[:3] - position_m, turn])
        by_step = np.eye(6)
        by_step[3:, 3:] = np.linalg.inv(rotations.left_jacobian_so3(-turn))
        inverse = np.linalg.inv(self.covariance)
        weighted = by_step.T @ inverse
        return weighted @ by_step, weighted @ error, float(error @ inverse @ error)


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


def covariance_of_sigmas(position_m: float, rotation_rad: float) -> Floats:
    """Covariance (6, 6) of one sigma of position on every axis (m) and one of turn about every body axis (rad)."""
    return np.diag([position_m**2] * 3 + [rotation_rad**2] * 3)

"""How far two poses lie apart: in metres, in angle, and in sigmas (Eq. 30-32).

Rotations are compared by the rotation between them, never by the difference of their vectors: near an angle of pi
two almost equal rotations have almost opposite vectors.
"""

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation

from linepose.arrays import Floats
from linepose.errors import EstimationError
from linepose.geometry.pose import N_PARAMETERS
from linepose.geometry.rotations import left_jacobian_so3

_SINGULAR = 1e-12  # smallest eigenvalue of a correlation matrix that double precision can still invert usefully


def euclidean_distance_m(first: ArrayLike, second: ArrayLike) -> Floats:
    """Distance between the positions of two poses (Eq. 30); (..., 6) each to (...)."""
    a, b = np.asarray(first, dtype=float), np.asarray(second, dtype=float)
    return np.asarray(np.linalg.norm(a[..., :3] - b[..., :3], axis=-1))


def geodesic_angle_rad(first: ArrayLike, second: ArrayLike) -> Floats:
    """Angle of the rotation between two poses, 0 to pi (Eq. 31); (..., 6) each to (...)."""
    return np.asarray(np.linalg.norm(pose_difference(first, second)[..., 3:], axis=-1))


def pose_difference(pose: ArrayLike, reference: ArrayLike) -> Floats:
    """What leads from a reference to a pose; (..., 6) each to (..., 6).

    Position difference (m), then the rotation vector (rad, at most pi long) of `R_pose R_reference^T`, in the
    body frame.
    """
    a, b = np.asarray(pose, dtype=float), np.asarray(reference, dtype=float)
    between = Rotation.from_rotvec(a[..., 3:]) * Rotation.from_rotvec(b[..., 3:]).inv()
    return np.concatenate([a[..., :3] - b[..., :3], between.as_rotvec()], axis=-1)


def difference_covariance(pose: ArrayLike, covariance: ArrayLike) -> Floats:
    """Covariance of `pose_difference` from a pose, given that of its parameters; (6,), (6, 6) to (6, 6)."""
    jacobian = np.eye(N_PARAMETERS)
    jacobian[3:, 3:] = left_jacobian_so3(np.asarray(pose, dtype=float)[3:])
    return jacobian @ np.asarray(covariance, dtype=float) @ jacobian.T


def mahalanobis_distance(pose: ArrayLike, estimate: ArrayLike, covariance: ArrayLike) -> Floats:
    """Distance of poses (..., 6) from an estimate (6,) in units of its covariance (6, 6) (Eq. 32); (...).

    Raises EstimationError for a covariance that is singular.
    """
    difference = pose_difference(pose, estimate)
    return _norm(difference, difference_covariance(estimate, covariance))


def mahalanobis_between(
    first: ArrayLike, first_covariance: ArrayLike, second: ArrayLike, second_covariance: ArrayLike
) -> float:
    """Distance of two independent estimates (6,) in units of the sum of their covariances (6, 6).

    Raises EstimationError for a sum that is singular.
    """
    total = difference_covariance(first, first_covariance) + difference_covariance(second, second_covariance)
    return float(_norm(pose_difference(first, second), total))


def p_value(distance: ArrayLike, degrees_of_freedom: int = N_PARAMETERS) -> Floats:
    """Chance of a Mahalanobis distance at least as large where only noise separates the poses; (...) to (...)."""
    from scipy.special import chdtrc  # chi2.sf, without what scipy.stats takes to import

    return np.asarray(chdtrc(degrees_of_freedom, np.asarray(distance, dtype=float) ** 2))


def check_covariance(covariance: ArrayLike, name: str = "pose covariance") -> Floats:
    """The covariance as a float array (6, 6); raises EstimationError where it is not positive definite."""
    matrix = np.asarray(covariance, dtype=float)
    sigma = np.sqrt(np.maximum(np.diag(matrix), 0.0))
    smallest = -np.inf
    if np.all(np.isfinite(matrix)) and np.all(sigma > 0):
        smallest = float(np.linalg.eigvalsh(matrix / np.outer(sigma, sigma))[0])
    if smallest < _SINGULAR:
        raise EstimationError(
            f"{name}: found a singular covariance (sigmas {', '.join(f'{s:.3g}' for s in sigma)}), expected a positive "
            "definite one; use more observations, or a longer chain if the samples have not spread"
        )
    return matrix


def _norm(difference: Floats, covariance: Floats) -> Floats:
    factor = np.linalg.cholesky(check_covariance(covariance))
    whitened = np.linalg.solve(factor, difference.reshape(-1, N_PARAMETERS).T)
    return np.asarray(np.linalg.norm(whitened, axis=0)).reshape(difference.shape[:-1])

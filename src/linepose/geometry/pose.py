"""The camera's pose on the vehicle: six numbers, their names, and their covariance in two representations.

A pose is an array of shape (6,): position of the camera in the body frame (m), then either the rotation vector
(the parameters that are estimated) or Euler angles roll, pitch, yaw (what people measure), both camera to body, rad.
Body axes: x forward, y right, z down. Camera axes: x along the scan line, z the optical axis.
"""

from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.geometry import rotations

POSE_COLUMNS: Final = ("r_x_m", "r_y_m", "r_z_m", "theta_x_rad", "theta_y_rad", "theta_z_rad")
SIGMA_COLUMNS: Final = tuple(f"sigma_{name}" for name in POSE_COLUMNS)
N_PARAMETERS: Final = 6
TURN_WORDS: Final = {"roll": "turn about forward", "pitch": "turn about right", "yaw": "turn about down"}
"""Small turns of the camera about the body's axes in words; they are no changes of Euler angles."""


def check_pose(pose: ArrayLike, name: str = "pose") -> Floats:
    """The pose as a float array of shape (6,); raises InputError where a number is missing or not finite."""
    array = np.asarray(pose, dtype=float)
    if array.shape != (N_PARAMETERS,):
        raise InputError(name, f"shape {array.shape}", "shape (6,)", "give r_x, r_y, r_z (m) and theta (rad)")
    if not np.all(np.isfinite(array)):
        raise InputError(name, f"{array.tolist()}", "six finite numbers", "replace what is not a number")
    return array


def rotation_vector_pose(euler_pose: ArrayLike) -> Floats:
    """Pose with a rotation vector from one with Euler angles; (6,) to (6,)."""
    pose = check_pose(euler_pose)
    return np.concatenate([pose[:3], rotations.rotation_vector_from_euler(pose[3:])])


def euler_pose(rotation_vector_pose: ArrayLike) -> Floats:
    """Pose with Euler angles from one with a rotation vector; (6,) to (6,)."""
    pose = check_pose(rotation_vector_pose)
    return np.concatenate([pose[:3], rotations.euler_from_rotation_vector(pose[3:])])


def rotation_vector_covariance(euler_pose: ArrayLike, covariance: ArrayLike) -> Floats:
    """Covariance of the rotation-vector pose from that of the Euler pose, to first order; (6,), (6, 6) to (6, 6)."""
    return _propagate(rotations.rotation_vector_by_euler(np.asarray(euler_pose, dtype=float)[3:]), covariance)


def euler_covariance(rotation_vector_pose: ArrayLike, covariance: ArrayLike) -> Floats:
    """Covariance of the Euler pose from that of the rotation-vector pose, to first order; (6,), (6, 6) to (6, 6)."""
    return _propagate(rotations.euler_by_rotation_vector(np.asarray(rotation_vector_pose, dtype=float)[3:]), covariance)


def _propagate(angles_jacobian: Floats, covariance: ArrayLike) -> Floats:
    jacobian = np.eye(N_PARAMETERS)
    jacobian[3:, 3:] = angles_jacobian
    return jacobian @ np.asarray(covariance, dtype=float) @ jacobian.T

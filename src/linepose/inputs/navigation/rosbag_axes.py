"""Attitudes and covariances of ROS messages in our axes, whichever the driver wrote them in."""

import logging
from typing import Any, Final, Literal

import numpy as np
from scipy.spatial.transform import Rotation

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.geometry import rotations
from linepose.inputs import axes

AttitudeAxes = Literal["enu", "ned"]
OrientationCovariance = Literal["fixed_axes", "roll_pitch_yaw"]

_NOT_UNIT: Final = 1e-3

log = logging.getLogger(__name__)


def quaternion_of(orientation: Any) -> tuple[float, float, float, float]:
    """The quaternion x, y, z, w of a message."""
    return orientation.x, orientation.y, orientation.z, orientation.w


def known_orientations(quaternions: Floats, place: str) -> np.ndarray:
    """Which of the quaternions (K, 4) are not zero or NaN, as drivers send them before the attitude is known; counted.

    Raises InputError where none is known, or one has another length than 1.
    """
    length = np.linalg.norm(quaternions, axis=1)
    known = np.isfinite(length) & (length != 0)
    wrong = np.flatnonzero(~(np.abs(length - 1) < _NOT_UNIT) & (known | ~known.any()))
    for row in wrong[:1]:
        found = f"orientation {', '.join(f'{one:g}' for one in quaternions[row])}"
        remedy = "record after the attitude is known, or cut the bag"
        raise InputError(f"{place}, message {row + 1}", found, "a quaternion of length 1", remedy)
    if not known.all():
        told = "%s: %d of %d messages with an orientation of zeros or no numbers are left out"
        log.warning(told, place, np.count_nonzero(~known), len(known))
    return np.asarray(known)


def euler_of(quaternions: Floats, axes_of_bag: AttitudeAxes) -> Floats:
    """Our roll, pitch, yaw (K, 3) of quaternions (K, 4)."""
    if not len(quaternions):
        return np.empty((0, 3))
    matrices = Rotation.from_quat(quaternions).as_matrix()
    return rotations.euler_from_matrix(matrices if axes_of_bag == "ned" else axes.matrix_from_enu_flu(matrices))


def position_jacobian(axes_of_bag: AttitudeAxes) -> Floats:
    """From the world's axes of a bag to north, east, down; (3, 3)."""
    return np.eye(3) if axes_of_bag == "ned" else axes.NED_FROM_ENU


def angle_jacobians(euler_rad: Floats, axes_of_bag: AttitudeAxes, of: OrientationCovariance) -> Floats:
    """Jacobians (K, 3, 3) of our roll, pitch, yaw by what the bag's covariance of the orientation is of."""
    if of == "fixed_axes":
        return np.asarray(axes.euler_by_small_rotation(euler_rad) @ position_jacobian(axes_of_bag))
    signs = [1.0, 1.0, 1.0] if axes_of_bag == "ned" else [1.0, -1.0, -1.0]
    return np.broadcast_to(np.diag(signs), (len(euler_rad), 3, 3))

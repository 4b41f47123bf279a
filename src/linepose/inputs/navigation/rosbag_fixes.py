"""Poses of a bag from NavSatFix, which has the position, and Imu, which has the attitude."""

from pathlib import Path
from typing import Any, Final

import numpy as np

from linepose.errors import InputError
from linepose.inputs import axes
from linepose.inputs.navigation.positions_between import positions_between
from linepose.inputs.navigation.record import Covariances, Poses, check_increasing, nearest_rows
from linepose.inputs.navigation.rosbag_axes import (
    AttitudeAxes,
    OrientationCovariance,
    angle_jacobians,
    euler_of,
    known_orientations,
    quaternion_of,
)
from linepose.inputs.navigation.rosbag_messages import messages
from linepose.inputs.navigation.usable_rows import usable_rows

FIX: Final = "sensor_msgs/msg/NavSatFix"
IMU: Final = "sensor_msgs/msg/Imu"
_NO_FIX: Final = -1
_UNKNOWN_COVARIANCE: Final = 0


def fixes_and_imu(
    bag: Any,
    path: Path,
    topics: tuple[str | None, str | None],
    maximum_gap_s: float,
    attitude_axes: AttitudeAxes,
    covariance_of: OrientationCovariance,
) -> tuple[Poses, Covariances]:
    """Poses at the times of the IMU between the first and last fix; covariances at those of the fixes.

    `topics` are those of the fixes and of the IMU, None for the bag's only one.
    """
    fixes, geodetic, position_covariance, is_known = _fixes(bag, path, topics[0])
    imu, quaternion, turns = _attitudes(bag, path, topics[1])
    place = f"{path}, {IMU}"
    between = positions_between(imu, fixes, geodetic, maximum_gap_s, place)
    near = between.near
    euler = euler_of(quaternion[near], attitude_axes)
    poses = Poses(imu[near], between.position, euler, place, between.gap_key)
    if not is_known or not turns.any():
        return poses, Covariances(np.empty(0, dtype=np.int64), np.empty((0, 6, 6)), place)
    row = nearest_rows(imu[near], fixes)
    jacobian = angle_jacobians(euler[row], attitude_axes, covariance_of)
    angles = jacobian @ turns[near][row] @ np.swapaxes(jacobian, -1, -2)
    at_fixes = axes.joined_covariance(axes.enu_covariance(position_covariance), angles)
    return poses, Covariances(fixes, at_fixes, place)


def _fixes(bag: Any, path: Path, topic: str | None) -> tuple[np.ndarray, np.ndarray, np.ndarray, bool]:
    """Times (F,), positions (F, 3) and covariances (F, 3, 3) of the fixes, and whether the covariances are known."""
    place = f"{path}, {FIX}"
    fix_us, geodetic, covariance, known = [], [], [], True
    for stamp, message in messages(bag, path, [FIX], topic, "fix_topic"):
        if message.status.status == _NO_FIX:
            continue
        fix_us.append(stamp)
        geodetic.append((message.latitude, message.longitude, message.altitude))
        covariance.append(message.position_covariance)
        known &= message.position_covariance_type != _UNKNOWN_COVARIANCE
    times, places = np.array(fix_us, dtype=np.int64), np.array(geodetic, dtype=float).reshape(-1, 3)
    rows = usable_rows(times, places, place)
    if len(rows) < 2:
        raise InputError(place, f"{len(rows)} messages with a fix", "two or more", "record the whole drive")
    check_increasing(times[rows], place)
    return times[rows], places[rows], np.array(covariance, dtype=float).reshape(-1, 3, 3)[rows], known


def _attitudes(bag: Any, path: Path, topic: str | None) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Times (A,), quaternions (A, 4) and covariances (A, 3, 3) of the IMU's messages."""
    place = f"{path}, {IMU}"
    imu_us, quaternion, covariance = [], [], []
    for stamp, message in messages(bag, path, [IMU], topic, "imu_topic"):
        imu_us.append(stamp)
        quaternion.append(quaternion_of(message.orientation))
        covariance.append(message.orientation_covariance)
    turns = np.array(covariance, dtype=float).reshape(-1, 3, 3)
    if len(turns) and turns[0, 0, 0] < 0:
        found, expected = "messages without orientation (orientation_covariance[0] is -1)", "an attitude"
        raise InputError(place, found, expected, "record the navigation system's own Imu topic, and name it")
    times, turned = np.array(imu_us, dtype=np.int64), np.array(quaternion, dtype=float).reshape(-1, 4)
    known = np.flatnonzero(known_orientations(turned, place))
    rows = known[usable_rows(times[known], turned[known], place)]
    return times[rows], turned[rows], turns[rows]

"""Poses of a bag from messages that hold whole poses: Odometry, PoseStamped, and those of NovAtel's drivers."""

import logging
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np

from linepose.inputs import axes
from linepose.inputs.navigation.poses import Poses
from linepose.inputs.navigation.record import Covariances
from linepose.inputs.navigation.rosbag_axes import (
    AttitudeAxes,
    OrientationCovariance,
    angle_jacobians,
    euler_of,
    known_orientations,
    position_jacobian,
    quaternion_of,
)
from linepose.inputs.navigation.rosbag_messages import messages

ODOMETRY: Final = "nav_msgs/msg/Odometry"
POSES: Final = ("geometry_msgs/msg/PoseWithCovarianceStamped", "geometry_msgs/msg/PoseStamped")
NOVATEL: Final = tuple(
    f"{package}/msg/{name}"
    for package in ("novatel_oem7_msgs", "novatel_gps_msgs", "novatel_msgs")
    for name in ("INSPVA", "INSPVAX", "Inspva", "Inspvax")
)
APPLANIX: Final = ("applanix_msgs/msg/NavigationSolutionGsof49",)
_USABLE: Final = (2, 3, 6, 7, "INS_HIGH_VARIANCE", "INS_SOLUTION_GOOD", "INS_SOLUTION_FREE", "INS_ALIGNMENT_COMPLETE")
_SIGMAS: Final = ("latitude", "longitude", "height", "roll", "pitch", "azimuth")

log = logging.getLogger(__name__)


def whole_poses(
    bag: Any,
    path: Path,
    kinds: Sequence[str],
    topic: tuple[str | None, str],
    attitude_axes: AttitudeAxes,
    covariance_of: OrientationCovariance,
) -> tuple[Poses, Covariances]:
    """Poses of Odometry, PoseStamped or PoseWithCovarianceStamped; `topic` is its name, if given, and its key."""
    time_us, position, quaternion, covariance = [], [], [], []
    for stamp, message in messages(bag, path, kinds, *topic):
        held = message.pose if hasattr(message.pose, "covariance") else None
        pose = message.pose if held is None else held.pose
        time_us.append(stamp)
        position.append((pose.position.x, pose.position.y, pose.position.z))
        quaternion.append(quaternion_of(pose.orientation))
        covariance.append(np.zeros(36) if held is None else held.covariance)
    place = f"{path}, {' or '.join(kinds)}"
    turned = np.array(quaternion, dtype=float).reshape(-1, 4)
    known = known_orientations(turned, place)
    times, euler = np.array(time_us, dtype=np.int64)[known], euler_of(turned[known], attitude_axes)
    world = position_jacobian(attitude_axes)
    positions = np.array(position, dtype=float).reshape(-1, 3)[known] @ world.T
    poses = Poses(times, positions, euler, place, records=np.flatnonzero(known) + 1)
    matrices = np.array(covariance, dtype=float).reshape(-1, 6, 6)[known]
    if not np.diagonal(matrices, axis1=1, axis2=2).any():
        return poses, Covariances(times[:0], matrices[:0], place)
    both = np.zeros((len(times), 6, 6))
    both[:, :3, :3] = world
    both[:, 3:, 3:] = angle_jacobians(euler, attitude_axes, covariance_of)
    return poses, Covariances(times, both @ matrices @ np.swapaxes(both, -1, -2), place)


def applanix_poses(bag: Any, path: Path, topic: str | None) -> tuple[Poses, Covariances]:
    """Poses of an Applanix receiver's GSOF 49: latitude, longitude, height, and angles (deg) that are ours."""
    time_us, rows = [], []
    for stamp, message in messages(bag, path, APPLANIX, topic, "applanix_topic"):
        time_us.append(stamp)
        place = message.lla
        rows.append((place.latitude, place.longitude, place.altitude, message.roll, message.pitch, message.heading))
    times, table = np.array(time_us, dtype=np.int64), np.array(rows, dtype=float).reshape(-1, 6)
    poses = Poses(times, table[:, :3], np.deg2rad(table[:, 3:]), f"{path}, GSOF 49")
    return poses, Covariances(times[:0], np.empty((0, 6, 6)), poses.place)


def novatel_poses(bag: Any, path: Path, topic: str | None) -> tuple[Poses, Covariances]:
    """Poses of INSPVA or INSPVAX: latitude, longitude, height, and angles (deg) that are ours."""
    time_us, rows, sigmas, unusable = [], [], [], 0
    for stamp, message in messages(bag, path, NOVATEL, topic, "inspva_topic"):
        if _status(message) not in _USABLE:
            unusable += 1
            continue
        time_us.append(stamp)
        height = message.height + getattr(message, "undulation", 0.0)
        rows.append((message.latitude, message.longitude, height, message.roll, message.pitch, message.azimuth))
        sigmas.append([_sigma(message, name) for name in _SIGMAS])
    place = f"{path}, INSPVA"
    if unusable:
        log.warning("%s: %d poses without an INS solution are left out", place, unusable)
    times, table = np.array(time_us, dtype=np.int64), np.array(rows, dtype=float).reshape(-1, 6)
    poses = Poses(times, table[:, :3], np.deg2rad(table[:, 3:]), place)
    sigma = np.array(sigmas, dtype=float).reshape(-1, 6) * [1, 1, 1, *[np.pi / 180] * 3]
    if not np.all(sigma > 0):
        return poses, Covariances(times[:0], np.empty((0, 6, 6)), place)
    return poses, Covariances(times, axes.diagonal_covariance(sigma), place)


def _status(message: Any) -> Any:
    """Number or name of the solution's status, wherever the driver keeps it."""
    status = getattr(message, "ins_status", getattr(message, "status", None))
    return getattr(status, "status", status)


def _sigma(message: Any, name: str) -> float:
    """A standard deviation, 0 where the message has none."""
    ours = (f"{name}_stdev", f"{name}_std", f"{name}_std_dev")
    return float(next((getattr(message, one) for one in ours if hasattr(message, one)), 0.0))

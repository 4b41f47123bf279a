"""Poses of a bag from messages of the position (NavSatFix and the like) and of the attitude (Imu and the like)."""

import logging
from pathlib import Path
from typing import Any

import numpy as np

from linepose.errors import InputError
from linepose.inputs import axes
from linepose.inputs.navigation.poses import Poses, check_increasing
from linepose.inputs.navigation.positions_between import positions_between
from linepose.inputs.navigation.record import Covariances, nearest_rows
from linepose.inputs.navigation.rosbag_axes import (
    AttitudeAxes,
    OrientationCovariance,
    angle_jacobians,
    euler_of,
    known_orientations,
)
from linepose.inputs.navigation.rosbag_messages import messages
from linepose.inputs.navigation.rosbag_vendors import FIX_KINDS, IMU_KINDS, SBG, attitude_of, fix_of, kinds_of
from linepose.inputs.navigation.usable_rows import placed, usable_rows

log = logging.getLogger(__name__)


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
    fix_kinds, imu_kinds = kinds_of(bag, FIX_KINDS, topics[0]), kinds_of(bag, IMU_KINDS, topics[1])
    fixes, geodetic, position_covariance, is_known = _fixes(bag, path, fix_kinds, topics[0])
    imu, quaternion, turns = _attitudes(bag, path, imu_kinds, topics[1])
    place = f"{path}, {imu_kinds[0]}"
    between = positions_between(imu, fixes, geodetic, maximum_gap_s, place)
    near = between.near
    euler = euler_of(quaternion[near], attitude_axes)
    poses = Poses(imu[near], between.position, euler, place, between.gap_key)
    if not is_known or not turns.any():
        return poses, Covariances(np.empty(0, dtype=np.int64), np.empty((0, 6, 6)), place)
    row = nearest_rows(imu[near], fixes)
    of = "roll_pitch_yaw" if imu_kinds[0].startswith(SBG) else covariance_of
    jacobian = angle_jacobians(euler[row], attitude_axes, of)
    angles = jacobian @ turns[near][row] @ np.swapaxes(jacobian, -1, -2)
    in_ned = fix_kinds[0].startswith(SBG) and attitude_axes == "ned"
    positions = position_covariance if in_ned else axes.enu_covariance(position_covariance)
    at_fixes = axes.joined_covariance(positions, angles)
    return poses, Covariances(fixes, at_fixes, place)


def _fixes(
    bag: Any, path: Path, kinds: list[str], topic: str | None
) -> tuple[np.ndarray, np.ndarray, np.ndarray, bool]:
    """Times (F,), positions (F, 3) and covariances (F, 3, 3) of the fixes, and whether the covariances are known."""
    place = f"{path}, {kinds[0]}"
    fix_us, geodetic, covariance, known, without = [], [], [], True, 0
    for stamp, message in messages(bag, path, kinds, topic, "fix_topic"):
        fix = fix_of(message)
        if fix is None:
            without += 1
            continue
        fix_us.append(stamp)
        geodetic.append(fix.geodetic)
        covariance.append(np.zeros((3, 3)) if fix.covariance is None else fix.covariance)
        known &= fix.covariance is not None
    if without:
        log.warning("%s: %d messages without a fix are left out", place, without)
    times, places = np.array(fix_us, dtype=np.int64), np.array(geodetic, dtype=float).reshape(-1, 3)
    rows = usable_rows(times, places, place)
    rows = rows[placed(places[rows], place)]
    if len(rows) < 2:
        raise InputError(place, f"{len(rows)} messages with a fix", "two or more", "record the whole drive")
    check_increasing(times[rows], place, rows + 1)
    return times[rows], places[rows], np.array(covariance, dtype=float).reshape(-1, 3, 3)[rows], known


def _attitudes(bag: Any, path: Path, kinds: list[str], topic: str | None) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Times (A,), quaternions (A, 4) and covariances (A, 3, 3) of the attitudes."""
    place = f"{path}, {kinds[0]}"
    imu_us, quaternion, covariance, invalid = [], [], [], 0
    for stamp, message in messages(bag, path, kinds, topic, "imu_topic"):
        attitude = attitude_of(message)
        if attitude is None:
            invalid += 1
            continue
        imu_us.append(stamp)
        quaternion.append(attitude.quaternion)
        covariance.append(attitude.covariance)
    if invalid:
        log.warning("%s: %d messages without a valid attitude are left out", place, invalid)
    turns = np.array(covariance, dtype=float).reshape(-1, 3, 3)
    if len(turns) and turns[0, 0, 0] < 0:
        found, expected = "messages without orientation (orientation_covariance[0] is -1)", "an attitude"
        raise InputError(place, found, expected, "record the navigation system's own Imu topic, and name it")
    times, turned = np.array(imu_us, dtype=np.int64), np.array(quaternion, dtype=float).reshape(-1, 4)
    known = np.flatnonzero(known_orientations(turned, place))
    rows = known[usable_rows(times[known], turned[known], place)]
    return times[rows], turned[rows], turns[rows]

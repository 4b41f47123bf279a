"""Navigation format `rosbag`: bags of ROS 1 (.bag) and ROS 2 (a folder, or .db3 and .mcap files).

Either nav_msgs/Odometry, or sensor_msgs/NavSatFix for the position and sensor_msgs/Imu for the attitude. After REP-103
the world is east, north, up and the body x forward, y left, z up. Times are the headers' (Unix).
"""

import struct
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Final, Literal

import numpy as np
from pydantic import Field, PositiveFloat
from scipy.spatial.transform import Rotation

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.geometry import rotations
from linepose.inputs import axes
from linepose.inputs.navigation.format import GeodeticSection, NavigationFormat
from linepose.inputs.navigation.record import (
    Covariances,
    NavigationRecord,
    Poses,
    check_increasing,
    geodetic_record,
    local_record,
    nearest_rows,
)

ODOMETRY: Final = "nav_msgs/msg/Odometry"
FIX: Final = "sensor_msgs/msg/NavSatFix"
IMU: Final = "sensor_msgs/msg/Imu"
_KEYS: Final = {ODOMETRY: "odometry_topic", FIX: "fix_topic", IMU: "imu_topic"}
_NO_FIX: Final = -1
_UNKNOWN_COVARIANCE: Final = 0
_NOT_UNIT: Final = 1e-3


class RosbagSection(GeodeticSection):
    """Keys of the format `rosbag`."""

    format: Literal["rosbag"] = Field(description="`rosbag`: a ROS 1 or ROS 2 bag.")
    odometry_topic: str | None = Field(
        None, description="Topic of nav_msgs/Odometry; if not given, the bag's only one, if it has one."
    )
    fix_topic: str | None = Field(
        None, description="Topic of sensor_msgs/NavSatFix, where there is no odometry; if not given, the only one."
    )
    imu_topic: str | None = Field(
        None, description="Topic of sensor_msgs/Imu with orientation, for NavSatFix; if not given, the only one."
    )
    orientation_covariance: Literal["fixed_axes", "roll_pitch_yaw"] = Field(
        "fixed_axes",
        description="What a bag's covariance of the orientation is of: small turns about east, north, up (REP-103), or "
        "roll, pitch, yaw, as the NovAtel driver fills it in.",
    )
    maximum_fix_gap_s: PositiveFloat = Field(
        1.0, description="Longest time between two NavSatFix over which the position is interpolated (s)."
    )


def read(section: RosbagSection, folder: Path) -> NavigationRecord:
    """The record of the bags; raises InputError where they have no such topic, or more than one and none is named."""
    poses, covariances = [], []
    odometry = True
    for path in section.paths(folder):
        with _opened(path) as bag:
            odometry = section.fix_topic is None and bool(section.odometry_topic or _topics(bag, ODOMETRY))
            part = _odometry(bag, path, section) if odometry else _fixes_and_imu(bag, path, section)
        poses.append(part[0])
        covariances.append(part[1])
    return local_record(poses, covariances) if odometry else geodetic_record(poses, covariances, section)


def _is_bag(path: Path) -> dict[str, Any] | None:
    return {} if path.suffix in {".bag", ".db3", ".mcap"} or (path / "metadata.yaml").is_file() else None


FORMAT: Final = NavigationFormat("rosbag", RosbagSection, read, recognise=_is_bag)


@contextmanager
def _opened(path: Path) -> Iterator[Any]:
    """The bag, whatever its kind; faults of its format, also those met while reading, become one line."""
    from rosbags.highlevel import AnyReader, AnyReaderError
    from rosbags.rosbag1 import ReaderError as Ros1Error
    from rosbags.rosbag2 import ReaderError as Ros2Error
    from rosbags.typesys import Stores, get_typestore

    in_folder = path.suffix in {".db3", ".mcap"} and (path.parent / "metadata.yaml").is_file()
    try:
        with AnyReader(
            [path.parent if in_folder else path], default_typestore=get_typestore(Stores.ROS2_HUMBLE)
        ) as bag:
            yield bag
    except (AnyReaderError, Ros1Error, Ros2Error, struct.error, AssertionError) as error:
        found = " ".join(str(error).split()) or type(error).__name__
        remedy = "restore the bag, or repair its index (rosbag reindex, ros2 bag reindex)"
        raise InputError(str(path), found, "a whole ROS 1 or ROS 2 bag", remedy) from None


def _topics(bag: Any, kind: str) -> list[str]:
    return sorted({one.topic for one in bag.connections if one.msgtype == kind})


def _messages(bag: Any, path: Path, kind: str, topic: str | None) -> Iterator[tuple[int, Any]]:
    """Time (us) and content of a topic's messages, in the order of the bag."""
    topics = _topics(bag, kind)
    if topic is None and len(topics) != 1:
        found = f"{len(topics)} topics of {kind}" + (f" ({', '.join(topics)})" if topics else "")
        held = ", ".join(sorted({f"{one.topic} ({one.msgtype})" for one in bag.connections})) or "nothing"
        remedy = f"set source.navigation.{_KEYS[kind]}; the bag holds {held}"
        raise InputError(str(path), found, "one, or its name in the platform file", remedy)
    if topic is not None and topic not in topics:
        found, expected = f"no topic {topic} of {kind}", f"one of {', '.join(topics) or 'none'}"
        raise InputError(str(path), found, expected, f"correct source.navigation.{_KEYS[kind]}")
    chosen = [one for one in bag.connections if one.msgtype == kind and one.topic == (topic or topics[0])]
    for connection, _, raw in bag.messages(connections=chosen):
        message = bag.deserialize(raw, connection.msgtype)
        yield message.header.stamp.sec * 1_000_000 + (message.header.stamp.nanosec + 500) // 1000, message


def _odometry(bag: Any, path: Path, section: RosbagSection) -> tuple[Poses, Covariances]:
    time_us, position, quaternion, covariance = [], [], [], []
    for stamp, message in _messages(bag, path, ODOMETRY, section.odometry_topic):
        pose = message.pose.pose
        time_us.append(stamp)
        position.append((pose.position.x, pose.position.y, pose.position.z))
        quaternion.append(_quaternion(pose.orientation))
        covariance.append(message.pose.covariance)
    times, place = np.array(time_us, dtype=np.int64), f"{path}, {ODOMETRY}"
    euler = _euler(np.array(quaternion).reshape(-1, 4), place)
    poses = Poses(times, axes.ned_from_enu(np.array(position).reshape(-1, 3)), euler, place)
    matrices = np.array(covariance, dtype=float).reshape(-1, 6, 6)
    if not matrices[:, [0, 1, 2, 3, 4, 5], [0, 1, 2, 3, 4, 5]].any():
        return poses, _none(place)
    both = np.zeros((len(times), 6, 6))
    both[:, :3, :3] = axes.NED_FROM_ENU
    both[:, 3:, 3:] = _by_orientation(euler, section)
    return poses, Covariances(times, both @ matrices @ np.swapaxes(both, -1, -2), place)


def _fixes_and_imu(bag: Any, path: Path, section: RosbagSection) -> tuple[Poses, Covariances]:
    """Poses at the times of the IMU between the first and last fix; covariances at those of the fixes."""
    fix_us, geodetic, position_covariance, known = [], [], [], True
    for stamp, message in _messages(bag, path, FIX, section.fix_topic):
        if message.status.status == _NO_FIX:
            continue
        fix_us.append(stamp)
        geodetic.append((message.latitude, message.longitude, message.altitude))
        position_covariance.append(message.position_covariance)
        known &= message.position_covariance_type != _UNKNOWN_COVARIANCE
    imu_us, quaternion, turn_covariance = [], [], []
    for stamp, message in _messages(bag, path, IMU, section.imu_topic):
        imu_us.append(stamp)
        quaternion.append(_quaternion(message.orientation))
        turn_covariance.append(message.orientation_covariance)
    fixes, imu, place = np.array(fix_us, dtype=np.int64), np.array(imu_us, dtype=np.int64), f"{path}, {IMU}"
    if len(fixes) < 2:
        raise InputError(f"{path}, {FIX}", f"{len(fixes)} messages with a fix", "two or more", "record the whole drive")
    check_increasing(fixes, f"{path}, {FIX}")
    turns = np.array(turn_covariance, dtype=float).reshape(-1, 3, 3)
    if len(turns) and turns[0, 0, 0] < 0:
        found, expected = "messages without orientation (orientation_covariance[0] is -1)", "an attitude"
        raise InputError(place, found, expected, "record the navigation system's own Imu topic, and name it")
    after = np.searchsorted(fixes, imu).clip(1, len(fixes) - 1)
    near = (fixes[after] - fixes[after - 1] <= section.maximum_fix_gap_s * 1e6) & (imu >= fixes[0]) & (imu <= fixes[-1])
    if not near.any():
        found = f"no message between two fixes at most {section.maximum_fix_gap_s:g} s apart"
        expected, remedy = (
            "fixes around the attitudes",
            "raise source.navigation.maximum_fix_gap_s, or check the stamps",
        )
        raise InputError(place, found, expected, remedy)
    euler, place_of_fix = _euler(np.array(quaternion).reshape(-1, 4)[near], place), np.array(geodetic)
    at = np.stack([np.interp(imu[near], fixes, place_of_fix[:, axis]) for axis in range(3)], axis=-1)
    poses = Poses(imu[near], at, euler, place)
    if not known or not turns.any():
        return poses, _none(place)
    row = nearest_rows(imu[near], fixes)
    jacobian = _by_orientation(euler[row], section)
    angles = jacobian @ turns[near][row] @ np.swapaxes(jacobian, -1, -2)
    position = axes.enu_covariance(np.array(position_covariance, dtype=float).reshape(-1, 3, 3))
    return poses, Covariances(fixes, axes.joined_covariance(position, angles), place)


def _by_orientation(euler_rad: Floats, section: RosbagSection) -> Floats:
    """Jacobians (K, 3, 3) of our roll, pitch, yaw by what the bag's covariance of the orientation is of."""
    if section.orientation_covariance == "fixed_axes":
        return np.asarray(axes.euler_by_small_rotation(euler_rad) @ axes.NED_FROM_ENU)
    return np.broadcast_to(np.diag([1.0, -1.0, -1.0]), (len(euler_rad), 3, 3))


def _quaternion(orientation: Any) -> tuple[float, float, float, float]:
    return orientation.x, orientation.y, orientation.z, orientation.w


def _euler(quaternion: Floats, place: str) -> Floats:
    for row in np.flatnonzero(~(np.abs(np.linalg.norm(quaternion, axis=1) - 1) < _NOT_UNIT))[:1]:
        found = f"orientation {', '.join(f'{one:g}' for one in quaternion[row])}"
        remedy = "record after the attitude is known, or cut the bag"
        raise InputError(f"{place}, message {row + 1}", found, "a quaternion of length 1", remedy)
    if not len(quaternion):
        return np.empty((0, 3))
    return rotations.euler_from_matrix(axes.matrix_from_enu_flu(Rotation.from_quat(quaternion).as_matrix()))


def _none(place: str) -> Covariances:
    return Covariances(np.empty(0, dtype=np.int64), np.empty((0, 6, 6)), place)

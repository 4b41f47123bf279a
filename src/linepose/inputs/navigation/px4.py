"""Navigation format `px4`: logs of PX4 autopilots (.ulg), read by pyulog.

Attitudes are of vehicle_attitude (quaternion from forward, right, down to north, east, down), positions of
vehicle_global_position, and the start of the clock is that of vehicle_gps_position or sensor_gps. No covariances.
"""

import logging
from functools import partial
from pathlib import Path
from typing import Final, Literal

import numpy as np
from pydantic import Field

from linepose.errors import InputError
from linepose.inputs.navigation.autopilot_poses import (
    AutopilotSection,
    FlightLog,
    autopilot_poses,
    begins_with,
    package,
    told_in_one_line,
)
from linepose.inputs.navigation.format import NavigationFormat
from linepose.inputs.navigation.record import NavigationRecord, geodetic_record
from linepose.inputs.navigation.rosbag_axes import euler_of, known_orientations

_MAGIC: Final = b"ULog\x01\x12\x35"
_ATTITUDE, _POSITION, _GPS = "vehicle_attitude", "vehicle_global_position", ("vehicle_gps_position", "sensor_gps")
_FIX_3D: Final = 3

log = logging.getLogger(__name__)

Columns = dict[str, np.ndarray]


class Px4Section(AutopilotSection):
    """Keys of the format `px4`."""

    format: Literal["px4"] = Field(description="`px4`: logs of a PX4 autopilot (.ulg), with linepose[autopilot].")


def read(section: Px4Section, folder: Path) -> NavigationRecord:
    """The record of the logs; raises InputError where pyulog is not installed or a message is missing."""
    poses = [autopilot_poses(_flight(path), path, section.maximum_fix_gap_s) for path in section.paths(folder)]
    return geodetic_record(poses, [], section)


FORMAT: Final = NavigationFormat(
    "px4", Px4Section, read, has_covariances=False, recognise=partial(begins_with, start=_MAGIC)
)


def _flight(path: Path) -> FlightLog:
    pyulog = package("pyulog", path)
    try:
        with told_in_one_line(path, "pyulog") as remarks:
            content = pyulog.ULog(str(path), [_ATTITUDE, _POSITION, *_GPS], disable_str_exceptions=True)
            if content.file_corruption:
                remarks.append("a broken message")
    except Exception as error:  # pyulog has no kind of its own
        found = " ".join(str(error).split()) or type(error).__name__
        raise InputError(str(path), found[:200], "a whole PX4 log (.ulg)", "restore the log") from None
    tables: dict[str, Columns] = {one.name: one.data for one in reversed(content.data_list)}  # the first instance
    attitude, position = tables.get(_ATTITUDE, {}), tables.get(_POSITION, {})
    gps_name = next((name for name in _GPS if name in tables), _GPS[0])
    gps = tables.get(gps_name, {})
    fields = {
        _ATTITUDE: ["timestamp", "q[0]", "q[1]", "q[2]", "q[3]"],
        _POSITION: ["timestamp", "lat", "lon"],
        gps_name: ["timestamp", "time_utc_usec", "fix_type"],
    }
    for message, columns in ((attitude, _ATTITUDE), (position, _POSITION), (gps, gps_name)):
        for field in (one for one in fields[columns] if message and one not in message):
            raise InputError(str(path), f"{columns} without {field}", "messages of a PX4 autopilot", "restore the log")
    quaternion = np.stack([_column(attitude, f"q[{at}]") for at in (1, 2, 3, 0)], axis=-1)
    usable = _column(gps, "time_utc_usec") > 0
    usable &= _column(gps, "fix_type") >= _FIX_3D
    if not usable.all():
        log.warning("%s: %d GPS messages without a fix are left out", path, np.sum(~usable))
    known = known_orientations(quaternion, f"{path}, {_ATTITUDE}")
    return FlightLog(
        _times(attitude, "timestamp_sample")[known],
        euler_of(quaternion[known], "ned"),
        _times(position, "timestamp_sample"),
        np.stack([_column(position, "lat"), _column(position, "lon"), _height(position)], axis=-1),
        _times(gps, "timestamp")[usable],
        _column(gps, "time_utc_usec")[usable].astype(np.int64),
        (_ATTITUDE, _POSITION, gps_name),
    )


def _column(table: Columns, name: str) -> np.ndarray:
    return np.asarray(table.get(name, np.empty(0)))


def _times(table: Columns, name: str) -> np.ndarray:
    """Times (us): those of the sample where the log has them, else those of the message."""
    sampled = table.get(name)
    known = sampled is not None and len(sampled) and np.all(sampled > 0)
    return _column(table, name if known else "timestamp").astype(np.int64)


def _height(position: Columns) -> np.ndarray:
    """Heights (m) above the ellipsoid where the log has them, else above the sea."""
    return _column(position, "alt_ellipsoid" if "alt_ellipsoid" in position else "alt").astype(float)

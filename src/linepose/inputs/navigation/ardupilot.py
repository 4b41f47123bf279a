"""Navigation format `ardupilot`: onboard logs of ArduPilot (.bin), read by pymavlink.

Attitudes are of ATT (roll, pitch, heading), positions of POS, and the start of the clock is that of GPS. Heights are
above the sea, all by the same amount off the ellipsoid's. No covariances.
"""

import logging
from functools import partial
from pathlib import Path
from typing import Final, Literal

import numpy as np
from pydantic import Field

from linepose.errors import InputError
from linepose.inputs import gps_time
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

_WHAT: Final = "a whole ArduPilot log (.bin)"
_FORMAT_MESSAGE: Final = b"\xa3\x95\x80"  # every log begins with the description of its messages
_HEAD_BYTES: Final = 1_000_000  # more would be searched for it byte by byte
_FIX_3D: Final = 3
_FIELDS: Final = {
    "ATT": ("TimeUS", "Roll", "Pitch", "Yaw"),
    "POS": ("TimeUS", "Lat", "Lng", "Alt"),
    "GPS": ("TimeUS", "GWk", "GMS", "Status"),
}

log = logging.getLogger(__name__)


class ArdupilotSection(AutopilotSection):
    """Keys of the format `ardupilot`."""

    format: Literal["ardupilot"] = Field(
        description="`ardupilot`: onboard logs of ArduPilot (.bin), with linepose[autopilot]."
    )


def read(section: ArdupilotSection, folder: Path) -> NavigationRecord:
    """The record of the logs; raises InputError where pymavlink is not installed or a message is missing."""
    poses = [autopilot_poses(_flight(path), path, section.maximum_fix_gap_s) for path in section.paths(folder)]
    return geodetic_record(poses, [], section)


FORMAT: Final = NavigationFormat(
    "ardupilot", ArdupilotSection, read, has_covariances=False, recognise=partial(begins_with, start=_FORMAT_MESSAGE)
)


def _flight(path: Path) -> FlightLog:
    rows = _rows(path)
    attitude, position, gps = (np.array(rows[name], dtype=float).reshape(-1, 4) for name in _FIELDS)
    fixed = (gps[:, 3] >= _FIX_3D) & (gps[:, 1] > 0)
    if not fixed.all():
        log.warning("%s: %d GPS messages without a fix are left out", path, np.sum(~fixed))
    gps = gps[fixed]
    unix_us = gps_time.unix_from_week(gps[:, 1].astype(np.int64), gps[:, 2] / 1e3, f"{path}, GPS")
    return FlightLog(
        attitude[:, 0].astype(np.int64),
        np.deg2rad(attitude[:, 1:]),
        position[:, 0].astype(np.int64),
        position[:, 1:],
        gps[:, 0].astype(np.int64),
        unix_us,
        ("ATT", "POS", "GPS"),
    )


def _rows(path: Path) -> dict[str, list[list[float]]]:
    """The fields of the messages of each kind; of several receivers the first."""
    reader = package("pymavlink.DFReader", path)
    with path.open("rb") as file:
        if _FORMAT_MESSAGE not in file.read(_HEAD_BYTES):
            raise InputError(str(path), "no description of messages", _WHAT, "give the log itself, or restore it")
    rows: dict[str, list[list[float]]] = {name: [] for name in _FIELDS}
    try:
        with told_in_one_line(path, "pymavlink"):
            messages = reader.DFReader_binary(str(path))
            while (message := messages.recv_match(type=list(_FIELDS))) is not None:
                if getattr(message, "I", 0) == 0:
                    name = message.get_type()
                    rows[name].append([float(getattr(message, one)) for one in _FIELDS[name]])
    except Exception as error:  # pymavlink has no kind of its own
        found = " ".join(str(error).split()) or type(error).__name__
        raise InputError(str(path), found[:200], _WHAT, "restore the log") from None
    return rows

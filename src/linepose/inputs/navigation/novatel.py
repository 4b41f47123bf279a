"""Navigation format `novatel`: ASCII and binary logs of NovAtel receivers, mixed as they come.

Poses are of INSPVA, INSPVAS or INSPVAX messages (of the kind that there are most of), covariances of INSCOV or INSCOVS,
else of INSSTDEV or INSSTDEVS, else of INSPVAX. NovAtel's vehicle axes are x right, y forward, z up; its azimuth is
clockwise from north, its pitch right-handed about the right axis, its roll right-handed about the forward axis, turned
in this order. About our axes (x forward, y right, z down) these are the same turns with the same signs, so that roll,
pitch and azimuth are our roll, pitch and yaw. INSPVA's height is ellipsoidal; INSPVAX's is above the geoid, and its
undulation is added.
"""

import logging
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final, Literal

import numpy as np
from pydantic import Field

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.inputs import axes, gps_time
from linepose.inputs.navigation.format import GeodeticSection, NavigationFormat
from linepose.inputs.navigation.poses import Poses
from linepose.inputs.navigation.record import Covariances, NavigationRecord, geodetic_record, nearest_rows
from linepose.inputs.novatel_file import UnknownBytes, messages

Row = tuple[float, ...]

_SHORT_NAMES: Final = {"INSPVAS": "INSPVA", "INSSTDEVS": "INSSTDEV", "INSCOVS": "INSCOV"}
_HEAD_BYTES: Final = 4096
_USABLE: Final = {2, 3, 6, 7}  # high variance, good, free (without GNSS), alignment complete
_SIGMAS: Final = ("latitude", "longitude", "height", "roll", "pitch", "azimuth")
_KINDS_OF_COVARIANCES: Final = ("INSCOV", "INSSTDEV", "INSPVAX")  # the fullest first

log = logging.getLogger(__name__)


@dataclass(frozen=True)
class Messages:
    """The rows of one file by message: week, seconds, then values; and how many bytes were no message."""

    path: Path
    rows: dict[str, list[Row]] = field(default_factory=dict)
    unusable: int = 0
    unknown_bytes: int = 0


class NovatelSection(GeodeticSection):
    """Keys of the format `novatel`."""

    format: Literal["novatel"] = Field(description="`novatel`: ASCII or binary logs of a NovAtel receiver.")
    poses: Literal["INSPVA", "INSPVAX"] | None = Field(
        None, description="Messages that the poses are taken from; if not given, the kind that the log has most of."
    )


def read(section: NovatelSection, folder: Path) -> NavigationRecord:
    """The record of the receiver's logs; raises InputError where they hold no usable pose."""
    files = [read_messages(path) for path in section.paths(folder)]
    kind = section.poses or _most_numerous(files)
    poses = [_poses(one, kind) for one in files]
    source = next((name for name in _KINDS_OF_COVARIANCES if _count(files, name)), None)
    covariances = [] if source is None else [_covariances(*one, source) for one in zip(files, poses, strict=True)]
    return geodetic_record(poses, covariances, section)


def _is_log(path: Path) -> dict[str, Any] | None:
    """A file that has the beginning of a message near its own."""
    if path.is_dir():
        return None
    with path.open("rb") as file:
        head = file.read(_HEAD_BYTES)
    return {} if re.search(rb"[#%]\w+A,|\xaaD[\x12\x13]", head) else None


FORMAT: Final = NavigationFormat("novatel", NovatelSection, read, recognise=_is_log)


def read_messages(path: Path) -> Messages:
    """Every message of a log that a pose or its covariance is read from, short and long forms alike."""
    rows, read, unusable, unknown = _parsed(path)
    if not read:
        remedy = "give a log of INSPVA or INSPVAX messages, or correct source.navigation.format"
        raise InputError(str(path), "no NovAtel message", "an ASCII or binary log", remedy)
    if unusable:
        log.warning("%s: %d poses without an INS solution are left out", path, unusable)
    if unknown:
        log.warning("%s: %d bytes are no whole message; restore the log if it was cut", path, unknown)
    return Messages(path, rows, unusable, unknown)


def _parsed(path: Path) -> tuple[dict[str, list[Row]], int, int, int]:
    """Rows by message, and the numbers of messages, of poses without a solution, and of bytes that are no message."""
    rows: dict[str, list[Row]] = {}
    unusable = unknown = read = 0
    for message in messages(path):
        if isinstance(message, UnknownBytes):
            unknown += message.count
            continue
        read += 1
        name = getattr(message, "name", "")
        name = _SHORT_NAMES.get(name, name)
        if name not in _ROW_OF:
            continue
        status = getattr(message, "ins_solution_status", None)
        if status is not None and getattr(status, "value", status) not in _USABLE:
            unusable += 1
            continue
        rows.setdefault(name, []).append(_ROW_OF[name](message))
    return rows, read, unusable, unknown


def _most_numerous(files: Sequence[Messages]) -> str:
    return "INSPVAX" if _count(files, "INSPVAX") > _count(files, "INSPVA") else "INSPVA"


def _count(files: Sequence[Messages], name: str) -> int:
    return sum(len(one.rows.get(name, ())) for one in files)


def _pva(message: Any) -> Row:
    place = (message.latitude, message.longitude, message.height)
    return (message.week, message.seconds, *place, message.roll, message.pitch, message.azimuth)


def _header_time(message: Any) -> Row:
    return (message.header.week, message.header.milliseconds / 1e3)


def _pvax(message: Any) -> Row:
    height = getattr(message, "height", None)
    above_geoid = message.orthometric_height if height is None else height  # as the firmware names it
    place = (message.latitude, message.longitude, above_geoid + message.undulation)
    return (*_header_time(message), *place, message.roll, message.pitch, message.azimuth, *_sigmas(message))


def _stdev(message: Any) -> Row:
    return (*_header_time(message), *_sigmas(message))


def _sigmas(message: Any) -> Row:
    return tuple(getattr(message, f"{name}_std_dev") for name in _SIGMAS)


def _cov(message: Any) -> Row:
    return (message.week, message.seconds, *message.elements, *message.elements_1)  # position, attitude; then velocity


_ROW_OF: Final[dict[str, Callable[[Any], Row]]] = {"INSPVA": _pva, "INSPVAX": _pvax, "INSSTDEV": _stdev, "INSCOV": _cov}


def _poses(messages: Messages, kind: str) -> Poses:
    rows = messages.rows.get(kind)
    if not rows:
        found = f"{messages.unusable} {kind} messages without an INS solution" if messages.unusable else f"no {kind}"
        remedy = f"log {kind} messages after the INS has aligned"
        raise InputError(str(messages.path), found, "INSPVA, INSPVAS or INSPVAX messages with a solution", remedy)
    table = _in_turn(rows, messages.path)
    time_us = gps_time.unix_from_week(table[:, 0], table[:, 1], str(messages.path))
    return Poses(time_us, table[:, 2:5], np.deg2rad(table[:, 5:8]), str(messages.path))


def _covariances(messages: Messages, poses: Poses, kind: str) -> Covariances:
    rows = messages.rows.get(kind, [])
    if not rows:
        return Covariances(poses.time_us[:0], np.empty((0, 6, 6)), str(messages.path))
    table = _in_turn(rows, messages.path)
    time_us = gps_time.unix_from_week(table[:, 0], table[:, 1], str(messages.path))
    if kind == "INSCOV":
        euler = poses.euler_rad[nearest_rows(poses.time_us, time_us)]
        return Covariances(time_us, _from_local_level(table[:, 2:], euler), str(messages.path))
    sigma = table[:, -6:] * [1, 1, 1, *[np.pi / 180] * 3]
    return Covariances(time_us, axes.diagonal_covariance(sigma), str(messages.path))


def _from_local_level(values: Floats, euler_rad: Floats) -> Floats:
    """Covariances (C, 6, 6) of INSCOV's two matrices (C, 18): m^2, and deg^2 of turns about east, north, up."""
    position, turns = (axes.enu_covariance(part.reshape(-1, 3, 3)) for part in (values[:, :9], values[:, 9:]))
    jacobian = axes.euler_by_small_rotation(euler_rad)
    angles = jacobian @ (turns * (np.pi / 180) ** 2) @ np.swapaxes(jacobian, -1, -2)
    return axes.joined_covariance(position, angles)


def _in_turn(rows: list[Row], path: Path) -> Floats:
    """The rows as a table, without those of the time before: a log may hold the short and the long form of each."""
    table = np.array(rows, dtype=float)
    repeated = np.all(np.diff(table[:, :2], axis=0) == 0, axis=1)
    if repeated.any():
        log.info("%s: %d messages at the time of the one before are passed over", path, np.count_nonzero(repeated))
    return table[np.concatenate([[True], ~repeated])]

"""Layouts of tables that known programs write: one entry each, with its keys and how a file of it is recognised."""

import difflib
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import pairwise
from math import hypot
from pathlib import Path
from typing import Any, Final

from linepose.errors import InputError
from linepose.settings import Settings

_HEAD_CHARACTERS: Final = 20_000
_EULER: Final = ("Roll", "Pitch", "Heading")
_NUMBER: Final = r"[-+]?\d+(?:\.\d*)?(?:[eE][-+]?\d+)?"
_OF_HYSPEX: Final = re.compile(rf"\s*\d{{1,7}}(?:[\s,;]+{_NUMBER}){{7}}\s*")
_OF_KITTI: Final = re.compile(rf"\s*{_NUMBER}(?:\s+{_NUMBER}){{29}}\s*")
_OF_TUM: Final = re.compile(rf"\s*(?:\d{{9,10}}(?:\.\d*)?|\d\.\d+[eE]\+0?9)(?:[\s,;]+{_NUMBER}){{7}}\s*")
_WEEK_S: Final = 604_800
_NOT_UNIT: Final = 0.01


@dataclass(frozen=True)
class Preset:
    """A layout: its name, the program for people, keys of the format `table`, and whether a file's head is of it.

    Where files have no attitude, the platform file must name a second log, or columns that were joined to them.
    """

    name: str
    program: str
    keys: Mapping[str, Any]
    recognises: Callable[[str], bool]
    has_attitude: bool = True


def _words(*words: str) -> Callable[[str], bool]:
    """Whether one line of a head has all of these words."""
    return lambda head: any(all(word in line for word in words) for line in head.splitlines())


def _rows(head: str, pattern: re.Pattern[str]) -> list[list[float]]:
    """The numbers of the lines that are no comment, but for the last, which may be cut; none if the first is no row."""
    lines = [line for line in head.splitlines() if line.strip()[:1] not in "#"]
    whole = lines if len(head) < _HEAD_CHARACTERS else lines[:-1]
    if not whole or not pattern.fullmatch(whole[0]):
        return []
    return [[float(cell) for cell in re.split(r"[\s,;]+", line.strip())] for line in whole if pattern.fullmatch(line)]


def _is_kitti(head: str) -> bool:
    """Whether a head is of 30 numbers a row."""
    return bool(_rows(head, _OF_KITTI))


def _is_hyspex(head: str) -> bool:
    """Whether a head is of frames, more than one a second, whose eighth numbers are seconds of the GPS week."""
    rows = _rows(head, _OF_HYSPEX)
    frames, seconds = [row[0] for row in rows], [row[7] for row in rows]
    if any(after < before for before, after in pairwise(seconds)) or any(not 0 <= one < _WEEK_S for one in seconds):
        return False
    return len(rows) > 1 and 0 < seconds[-1] - seconds[0] < frames[-1] - frames[0]


def _is_tum(head: str) -> bool:
    """Whether a head is of Unix times, places and quaternions, of which some may be zeros."""
    lengths = [hypot(*row[4:]) for row in _rows(head, _OF_TUM)]
    return any(lengths) and all(abs(one - 1) < _NOT_UNIT for one in lengths if one)


_GEODETIC: Final = {"coordinates": "geodetic", "angle_unit": "degrees", "time_unit": "s"}

_ALL: Final = (
    Preset(
        "inertial_explorer",
        "text exports of NovAtel's Inertial Explorer",
        _GEODETIC
        | {
            "heading_words": ("Latitude", "Longitude", "H-Ell"),
            "unit_rows": 1,
            "delimiter": " ",
            "time_scale": "gps_week",
            "latitude_unit": "dms",
            "columns": {
                "time": "GPSTime",
                "week": "Week",
                "position": ("Latitude", "Longitude", "H-Ell"),
                "attitude": _EULER,
            },
        },
        _words("Latitude", "Longitude", "H-Ell", "Roll"),
    ),
    Preset(
        "pospac",
        "text of Applanix POSPac's export utility",
        _GEODETIC
        | {
            "heading_words": ("TIME", "LATITUDE", "ROLL"),
            "unit_rows": 1,
            "delimiter": " ",
            "time_scale": "gps_week",
            "columns": {
                "time": "TIME",
                "position": ("LATITUDE", "LONGITUDE", "ELLIPSOID HEIGHT"),
                "attitude": ("ROLL", "PITCH", "HEADING"),
                "sigma_position": ("NORTH SD", "EAST SD", "HEIGHT SD"),
                "sigma_attitude": ("ROLL SD", "PITCH SD", "HEADING SD"),
            },
        },
        _words("TIME,", "LATITUDE,", "ROLL,"),
    ),
    Preset(
        "hyspex",
        "NAV text of HySpex systems: frame, longitude, latitude, height, roll, pitch, heading, seconds of the GPS week",
        _GEODETIC
        | {
            "heading": False,
            "delimiter": " ",
            "time_scale": "gps_week",
            "columns": {"time": "8", "position": ("3", "2", "4"), "attitude": ("5", "6", "7")},
        },
        _is_hyspex,
    ),
    Preset(
        "headwall",
        "imu_gps.txt of Headwall's recorders",
        _GEODETIC
        | {
            "delimiter": "\t",
            "time_unit": "us",
            "columns": {
                "time": "Timestamp",
                "position": ("Lat", "Lon", "Alt"),
                "attitude": ("Roll", "Pitch", "Yaw"),
            },
        },
        _words("Roll\tPitch\tYaw\tLat\tLon\tAlt"),
    ),
    Preset(
        "oxts",
        "CSV exports of OxTS NAVsuite",
        _GEODETIC
        | {
            "time_scale": "gps",
            "columns": {
                "time": "Time (GPS s)",
                "position": ("Latitude (deg)", "Longitude (deg)", "Altitude (m)"),
                "attitude": ("Roll (deg)", "Pitch (deg)", "Heading (deg)"),
            },
        },
        _words("Time (GPS s)", "Latitude (deg)", "Roll (deg)"),
    ),
    Preset(
        "kitti",
        "KITTI's oxts/data/*.txt, one row a file, with their timestamps.txt",
        {
            "heading": False,
            "delimiter": " ",
            "times": "oxts/timestamps.txt",
            "time_scale": "iso",
            "coordinates": "geodetic",
            "angle_unit": "radians",
            "attitude_axes": "enu",
            "columns": {"time": "time", "position": ("1", "2", "3"), "attitude": ("4", "5", "6")},
        },
        _is_kitti,
    ),
    Preset(
        "tum",
        "TUM trajectories: Unix time, x, y, z (east, north, up), quaternion x, y, z, w",
        {
            "heading": False,
            "delimiter": " ",
            "comment": "#",
            "time_unit": "s",
            "coordinates": "enu",
            "attitude_axes": "enu",
            "columns": {"time": "1", "position": ("2", "3", "4"), "attitude": ("5", "6", "7", "8")},
        },
        _is_tum,
    ),
    Preset(
        "rtklib",
        "RTKLIB solutions (.pos), with the attitudes of a second log",
        _GEODETIC
        | {
            "heading": False,
            "delimiter": " ",
            "comment": "%",
            "time_scale": "gps_iso",
            "columns": {"time": ("1", "2"), "position": ("3", "4", "5")},
        },
        _words("%", "latitude(deg)", "longitude(deg)", "height(m)"),
        has_attitude=False,
    ),
)
_ATTITUDE_LOG: Final = {  # to be changed by the user
    "file": "attitude.csv",
    "time_unit": "s",
    "angle_unit": "degrees",
    "columns": {"time": "time", "attitude": ["roll", "pitch", "heading"]},
}
PRESETS: Final = {one.name: one for one in _ALL}
NAMES: Final = ", ".join(f"`{name}`" for name in PRESETS)


def overlaid(values: Any) -> Any:
    """The keys of a table with those of its preset below them; raises InputError for a preset that is not there."""
    if not isinstance(values, Mapping) or values.get("preset") is None:
        return values
    name = values["preset"]
    if name not in PRESETS:
        near = difflib.get_close_matches(str(name), PRESETS, n=1)
        remedy = f"did you mean {near[0]}?" if near else "remove the key, and give the columns"
        raise InputError("source.navigation.preset", repr(name), f"one of {', '.join(PRESETS)}", remedy)
    below = PRESETS[name].keys
    columns = values.get("columns", {})
    columns = columns.model_dump(exclude_unset=True) if isinstance(columns, Settings) else columns
    if not isinstance(columns, Mapping):
        return {**below, **values}
    if not PRESETS[name].has_attitude and "attitude" not in columns and values.get("attitude_log") is None:
        found, expected = f"{name}, whose files hold positions alone", "an attitude"
        remedy = "name the log of the attitudes in source.navigation.attitude_log, or columns joined to the rows in "
        remedy += "source.navigation.columns.attitude"
        raise InputError("source.navigation.preset", found, expected, remedy)
    return {**below, **values, "columns": {**below["columns"], **columns}}


def recognised(path: Path) -> dict[str, Any] | None:
    """The keys of the preset that a file is of; None where it is of none."""
    try:
        with path.open(encoding="utf-8-sig", errors="replace") as file:
            head = file.read(_HEAD_CHARACTERS)
    except OSError:
        return None
    found = next((one for one in _ALL if one.recognises(head)), None)
    if found is None:
        return None
    return {"preset": found.name} | ({} if found.has_attitude else {"attitude_log": _ATTITUDE_LOG})

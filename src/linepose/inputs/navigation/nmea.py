"""Navigation format `nmea`: NMEA 0183 logs of receivers with attitude, and Specim's .nav.

Positions are of GGA, whose height above the geoid gets its separation, attitudes of PASHR: roll, pitch and true heading
(where it has none, that of the HDT before it). Positions at the times of the attitudes are linear between two GGA.
Covariances are those of GST (position) and PASHR (angles). RMC or ZDA say the day. VTG's course is no heading and is
not used. PTNL,AVR of a Trimble receiver with two antennas has a yaw and one tilt alone: it is no attitude, and is told
where there is no other.
"""

import datetime
import logging
import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final, Literal

import numpy as np
from pydantic import Field, PositiveFloat

from linepose.errors import InputError
from linepose.inputs import axes
from linepose.inputs.navigation.format import GeodeticSection, NavigationFormat
from linepose.inputs.navigation.poses import Poses, check_increasing
from linepose.inputs.navigation.positions_between import DEFAULT_GAP_S, positions_between
from linepose.inputs.navigation.record import Covariances, NavigationRecord, geodetic_record
from linepose.inputs.navigation.usable_rows import placed, usable_rows
from linepose.inputs.nmea import Sentence, sentences
from linepose.inputs.nmea_dates import has_date

_HEAD_BYTES: Final = 4096
_ANGLES: Final = ("roll", "pitch", "true_heading")
_ACCURACIES: Final = ("roll_accuracy", "pitch_accuracy", "heading_accuracy")
_SIGMAS: Final = ("std_dev_latitude", "std_dev_longitude", "std_dev_altitude")

log = logging.getLogger(__name__)


class NmeaSection(GeodeticSection):
    """Keys of the format `nmea`."""

    format: Literal["nmea"] = Field(description="`nmea`: NMEA 0183 sentences GGA and PASHR; Specim's .nav.")
    date: datetime.date | None = Field(
        None,
        description="The day of the first sentence, where no RMC or ZDA of a receiver with a fix says it, or those of "
        "one log disagree; if not given, that of the scans.",
    )
    maximum_fix_gap_s: PositiveFloat = Field(
        DEFAULT_GAP_S, description="Longest time between two GGA over which the position is interpolated (s)."
    )

    def lacking(self, folder: Path) -> Literal["date"] | None:
        """The day, where neither the key nor the logs say it."""
        return None if self.date or all(has_date(path) for path in self.paths(folder)) else "date"


@dataclass
class _Rows:
    """What the sentences of a file say: times (us) and values of fixes, attitudes, and sigmas of the attitudes."""

    fix_us: list[int] = field(default_factory=list)
    fixes: list[tuple[float, float, float]] = field(default_factory=list)
    attitude_us: list[int] = field(default_factory=list)
    attitudes: list[list[float]] = field(default_factory=list)
    sigmas: list[list[float]] = field(default_factory=list)
    without_fix: int = 0
    without_height: int = 0
    nowhere: int = 0
    of_two_antennas: int = 0
    position_sigma: list[float] = field(default_factory=lambda: [np.nan] * 3)
    heading: float = np.nan


def read(section: NmeaSection, folder: Path) -> NavigationRecord:
    """The record of the logs; raises InputError where they hold no positions or no attitudes."""
    parts = [_read_file(path, section) for path in section.paths(folder)]
    return geodetic_record([part[0] for part in parts], [part[1] for part in parts], section)


def _is_log(path: Path) -> dict[str, Any] | None:
    if path.is_dir():
        return None
    with path.open("rb") as file:
        return {} if re.search(rb"\$(..GGA|PASHR),", file.read(_HEAD_BYTES)) else None


FORMAT: Final = NavigationFormat("nmea", NmeaSection, read, recognise=_is_log)


def _read_file(path: Path, section: NmeaSection) -> tuple[Poses, Covariances]:
    rows = _Rows()
    for sentence in sentences(path, section.date, "source.navigation.date"):
        _add(rows, sentence)
    if rows.without_fix:
        log.warning("%s: %d GGA without a fix are left out", path, rows.without_fix)
    if rows.without_height:
        told = "%s: %d GGA without a height or the geoid's separation, which is added to it, are left out"
        log.warning(told, path, rows.without_height)
    if rows.nowhere:
        log.warning("%s: %d GGA whose latitude or longitude is none are left out", path, rows.nowhere)
    fix_us, fixes, _ = _used(rows.fix_us, _table(rows.fixes), f"{path}, GGA")
    kept = placed(fixes, f"{path}, GGA")
    fix_us, fixes = fix_us[kept], fixes[kept]
    angles = np.hstack([_table(rows.attitudes), _table(rows.sigmas, 6)])
    attitude_us, attitudes, numbers = _used(rows.attitude_us, angles, f"{path}, PASHR")
    if len(fix_us) < 2:
        found, remedy = f"{len(fix_us)} GGA with a fix", "log GGA throughout the drive"
        if rows.without_height:
            found += " and a height above the ellipsoid"
            remedy = "let the receiver write the height and the geoid's separation (words 9 and 11 of GGA)"
        raise InputError(str(path), found, "two or more", remedy)
    if not len(attitude_us):
        raise _no_attitude(path, rows)
    place = f"{path}, PASHR"
    between = positions_between(attitude_us, fix_us, fixes, section.maximum_fix_gap_s, place)
    times, values = attitude_us[between.near], attitudes[between.near]
    poses = Poses(times, between.position, np.deg2rad(values[:, :3]), place, between.gap_key, numbers[between.near])
    known = np.all(values[:, 3:] > 0, axis=1)
    sigma = values[known, 3:] * [1, 1, 1, *[np.pi / 180] * 3]
    return poses, Covariances(times[known], axes.diagonal_covariance(sigma), place)


def _no_attitude(path: Path, rows: _Rows) -> InputError:
    found, expected = "no PASHR with roll, pitch and heading", "an attitude"
    if not rows.of_two_antennas:
        return InputError(str(path), found, expected, "log PASHR too, or read another log of the navigation system")
    found += f", but {rows.of_two_antennas} PTNL,AVR: yaw and one tilt of the line between two antennas"
    remedy = "log PASHR too, or read the log of an IMU: two antennas cannot tell all three angles"
    return InputError(str(path), found, expected, remedy)


def _table(rows: list[Any], width: int = 3) -> np.ndarray:
    return np.array(rows, dtype=float).reshape(-1, width)


def _used(times: list[int], values: np.ndarray, place: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Times (K,) and values (K, N) that can be used, in order, and their numbers among all, from 1.

    The first three values must be numbers.
    """
    time_us = np.array(times, dtype=np.int64)
    rows = usable_rows(time_us, values[:, :3], place)
    check_increasing(time_us[rows], place, rows + 1)
    return time_us[rows], values[rows], rows + 1


def _add(rows: _Rows, sentence: Sentence) -> None:
    content, kind = sentence.content, type(sentence.content).__name__
    if kind == "HDT" and content.heading is not None:
        rows.heading = float(content.heading)
    elif kind == "GST":
        rows.position_sigma = [_number(getattr(content, name)) for name in _SIGMAS]
    elif sentence.time_us is None:
        return
    elif kind == "GGA":
        _add_fix(rows, sentence.time_us, content)
    elif sentence.words[:2] == ("PTNL", "AVR"):
        rows.of_two_antennas += 1
    elif kind == "ASHRATT":
        angles = [_number(getattr(content, name)) for name in _ANGLES]
        angles[2] = rows.heading if np.isnan(angles[2]) else angles[2]
        rows.attitude_us.append(sentence.time_us)
        rows.attitudes.append(angles)
        rows.sigmas.append([*rows.position_sigma, *(_number(getattr(content, name)) for name in _ACCURACIES)])


def _add_fix(rows: _Rows, time_us: int, content: Any) -> None:
    if not content.gps_qual or not content.lat or not content.lon:
        rows.without_fix += 1
        return
    latitude, longitude = _degrees(content.lat, content.lat_dir, "NS"), _degrees(content.lon, content.lon_dir, "EW")
    if latitude is None or longitude is None:
        rows.nowhere += 1
        return
    height = _number(content.altitude) + _number(content.geo_sep)
    if np.isnan(height):
        rows.without_height += 1
        return
    rows.fix_us.append(time_us)
    rows.fixes.append((latitude, longitude, height))


def _degrees(text: str, direction: str, directions: str) -> float | None:
    """Degrees of DDDMM.MMM and its direction, which is minus for the second; None of another text."""
    match = re.fullmatch(r"(\d{1,3})([0-5]\d(?:\.\d*)?)", text, re.ASCII)
    if match is None or direction not in tuple(directions):
        return None
    degrees = float(match[1]) + float(match[2]) / 60
    return degrees if direction == directions[0] else -degrees


def _number(value: Any) -> float:
    try:
        return float(value)
    except (TypeError, ValueError):
        return np.nan

"""Poses of one navigation log: which of them can be used, and what they are checked for."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.inputs.local_frame import check_geodetic
from linepose.inputs.navigation.format import NavigationFormatSection, correct_keys
from linepose.inputs.navigation.usable_rows import placed, usable_rows

_EARLIEST_US, _LATEST_US = 315_964_800_000_000, 4_102_444_800_000_000  # 1980 to 2100
_TIME_KEYS = ("time_unit", "time_scale", "gps_week", "date")


@dataclass(frozen=True)
class Poses:
    """Poses of one file: time_us (K,), position (K, 3), euler_rad (K, 3) in north, east, down; `place` names the file.

    `position` is north, east, down (m), or latitude, longitude (deg), ellipsoidal height (m). `gap_key` is the key by
    which poses were left out that would fill a gap, where some were. `records` (K,): their numbers in the file, from 1,
    where it holds others too.
    """

    time_us: NDArray[np.int64]
    position: Floats
    euler_rad: Floats
    place: str
    gap_key: str | None = None
    records: NDArray[np.int64] | None = None

    @property
    def numbers(self) -> NDArray[np.int64]:
        """The numbers of the poses in the file (K,), from 1."""
        return np.arange(1, len(self.time_us) + 1) if self.records is None else self.records

    def place_of(self, row: int) -> str:
        """Where the pose of a row (from 0) stands."""
        return f"{self.place}, record {self.numbers[row]}"


def usable_poses(part: Poses) -> Poses:
    """The poses of numbers in the order of time, each once; what is left out is told."""
    rows = usable_rows(part.time_us, np.hstack([part.position, part.euler_rad]), part.place)
    return part if np.array_equal(rows, np.arange(len(part.time_us))) else _of(part, rows)


def placed_poses(part: Poses) -> Poses:
    """The poses without those of a device that had no fix yet; how many is told."""
    kept = placed(part.position, part.place)
    return part if np.all(kept) else _of(part, kept)


def _of(part: Poses, rows: NDArray[np.bool_] | NDArray[np.int64]) -> Poses:
    """These of the poses."""
    return replace(
        part,
        time_us=part.time_us[rows],
        position=part.position[rows],
        euler_rad=part.euler_rad[rows],
        records=part.numbers[rows],
    )


def check_numbers(part: Poses) -> None:
    """Raise InputError naming the first pose with a value that is no number."""
    values = np.hstack([part.position, part.euler_rad])
    for row in np.flatnonzero(~np.all(np.isfinite(values), axis=1))[:1]:
        raise InputError(part.place_of(row), "a value that is no number", "a pose", "remove the record")


def check_places(part: Poses) -> None:
    """Raise InputError naming the first pose whose position is no latitude, longitude (deg) and height (m)."""
    if len(part.time_us):
        by_number = np.zeros((part.numbers.max(), 3))
        by_number[part.numbers - 1] = part.position
        check_geodetic(by_number, part.place)


def check_poses(part: Poses, section: NavigationFormatSection | None) -> None:
    """Raise InputError where there is no pose, or naming the first of no possible time or angle, or out of order.

    `section`: the keys of the log's format, which may mend it.
    """
    if not len(part.time_us):
        raise InputError(part.place, "no pose", "a log of poses", "restore the log")
    for row in np.flatnonzero((part.time_us < _EARLIEST_US) | (part.time_us > _LATEST_US))[:1]:
        raise InputError(
            part.place_of(row),
            f"time {part.time_us[row]} us since 1970",
            "a time between 1980 and 2100",
            correct_keys(section, _TIME_KEYS, "restore the log"),
        )
    for row in np.flatnonzero(np.any(np.abs(part.euler_rad) > 2 * np.pi + 1e-9, axis=1))[:1]:
        remedy = correct_keys(section, ["angle_unit"], "restore the log")
        found = f"roll, pitch, yaw {', '.join(f'{one:g}' for one in part.euler_rad[row])} rad"
        raise InputError(part.place_of(row), found, "at most a full turn", remedy)
    check_increasing(part.time_us, part.place, part.numbers)


def check_increasing(time_us: NDArray[np.int64], place: str, records: NDArray[np.int64] | None = None) -> None:
    """Raise InputError naming the first of times (K,) that is not after the one before it.

    `records` (K,): their numbers in the file, from 1, where it holds others too.
    """
    for row in np.flatnonzero(np.diff(time_us) <= 0)[:1]:
        raise InputError(
            f"{place}, record {row + 2 if records is None else records[row + 1]}",
            f"time {time_us[row + 1]} us",
            f"a time after the record before it ({time_us[row]} us)",
            "sort the records by time and remove repeated ones",
        )

"""Navigation format `resonon`: location files (.lcf) of Resonon's airborne systems, one beside each scan.

Columns apart by spaces: time (s), roll, pitch, heading (rad), longitude, latitude (deg), height (m, WGS 84 ellipsoid),
two of no use, 5 where the row may be used and 0 where not, and more that depend on the receiver. Resonon's roll is
positive with the right wing up, the opposite of ours. The files hold no covariances.
"""

from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from linepose.config.navigation_formats import NavigationFormat, ResononSection, TimeScale
from linepose.errors import InputError
from linepose.formats import gps_time
from linepose.formats.navigation.record import NavigationRecord, Poses, geodetic_record
from linepose.rotations import Floats

_FEWEST_COLUMNS: Final = 7
_USE_COLUMN: Final = 9


def read(section: ResononSection, folder: Path) -> NavigationRecord:
    """The record of all location files; raises InputError naming a row that is none."""
    return geodetic_record([_poses(path, section.time_scale) for path in section.paths(folder)], [], section)


FORMAT: Final = NavigationFormat("resonon", ResononSection, read)


def location_times(path: Path, time_scale: TimeScale) -> NDArray[np.int64]:
    """Unix times (us) of the rows of a location file."""
    return _unix(_rows(path)[:, 0], time_scale)


def _poses(path: Path, time_scale: TimeScale) -> Poses:
    rows = _rows(path)
    if rows.shape[1] > _USE_COLUMN:
        rows = rows[rows[:, _USE_COLUMN] != 0]
    euler = rows[:, 1:4] * [-1.0, 1.0, 1.0]
    return Poses(_unix(rows[:, 0], time_scale), rows[:, [5, 4, 6]], euler, str(path))


def _unix(time_s: Floats, time_scale: TimeScale) -> NDArray[np.int64]:
    time_us = gps_time.microseconds(time_s, "s")
    return gps_time.unix_from_gps(time_us) if time_scale == "gps" else time_us


def _rows(path: Path) -> Floats:
    """The numbers of a location file (K, C)."""
    rows: list[list[float]] = []
    for number, line in enumerate(_lines(path), start=1):
        try:
            rows.append([float(word) for word in line.split()])
        except ValueError:
            raise InputError(f"{path}, row {number}", repr(line[:60]), "numbers apart by spaces", "mend it") from None
        if len(rows[-1]) < _FEWEST_COLUMNS or len(rows[-1]) != len(rows[0]):
            expected = (
                f"{max(len(rows[0]), _FEWEST_COLUMNS)} columns: time, roll, pitch, heading, longitude, latitude, ..."
            )
            raise InputError(
                f"{path}, row {number}", f"{len(rows[-1])} columns", expected, "remove the row if it was cut"
            )
    if not rows:
        raise InputError(str(path), "an empty file", "a location file", "restore it")
    return np.array(rows)


def _lines(path: Path) -> list[str]:
    try:
        return path.read_text(encoding="utf-8").rstrip().splitlines()
    except UnicodeDecodeError:
        expected = "a location file (.lcf)"
        raise InputError(str(path), "bytes that are no text", expected, "correct source.navigation.format") from None

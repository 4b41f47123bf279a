"""Location files (.lcf) of Resonon's airborne systems: rows of numbers apart by spaces, the time (s) first."""

from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from linepose.config.navigation_formats import TimeScale
from linepose.errors import InputError
from linepose.formats import gps_time
from linepose.rotations import Floats

_FEWEST_COLUMNS: Final = 7


def location_times(path: Path, time_scale: TimeScale) -> NDArray[np.int64]:
    """Unix times (us) of the rows of a location file; raises InputError naming a row that is none."""
    return unix_times(location_rows(path)[:, 0], time_scale)


def unix_times(time_s: Floats, time_scale: TimeScale) -> NDArray[np.int64]:
    """Unix times (us) of a location file's first column (K,)."""
    time_us = gps_time.microseconds(time_s, "s")
    return gps_time.unix_from_gps(time_us) if time_scale == "gps" else time_us


def location_rows(path: Path) -> Floats:
    """The numbers of a location file (K, C); raises InputError naming a row that is none."""
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

"""Resonon's location files (.lcf): rows of numbers, read alike for poses and for the time of a scan's first line."""

import logging
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.inputs import gps_time
from linepose.inputs.gps_time import TimeScale
from linepose.inputs.number_files import plain_float
from linepose.inputs.text_files import check_text

_FEWEST_COLUMNS: Final = 7

log = logging.getLogger(__name__)


def location_unix_us(time_s: Floats, time_scale: TimeScale, path: Path) -> NDArray[np.int64]:
    """Unix times (us) of the first column; raises InputError naming the file for what is no time."""
    time_us = gps_time.microseconds(time_s, "s", str(path))
    return gps_time.unix_from_gps(time_us) if time_scale == "gps" else time_us


def location_rows(path: Path) -> Floats:
    """The numbers of a location file (K, C); raises InputError naming the row that has others.

    A last row that was cut is passed over, and told.
    """
    lines, rows = _lines(path), list[list[float]]()
    for number, line in enumerate(lines, start=1):
        words = line.split()
        if number == len(lines) and rows and len(words) < len(rows[0]):
            log.warning("%s: the last row was cut and is passed over", path)
            break
        try:
            rows.append([plain_float(word) for word in words])
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
    expected, remedy = "a location file (.lcf)", "correct source.navigation.format"
    check_text(path, expected, remedy)
    try:
        return path.read_text(encoding="utf-8-sig").rstrip().splitlines()
    except UnicodeDecodeError:
        raise InputError(str(path), "bytes that are not text", expected, remedy) from None

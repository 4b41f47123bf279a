"""Times of the lines of HySpex's cameras: the last column of the NAV text, a row a frame (seconds of the GPS week)."""

import datetime
import re
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from linepose.errors import InputError
from linepose.inputs import gps_time
from linepose.inputs.number_files import plain_float
from linepose.inputs.scans import header_time

_COLUMNS: Final = 8  # frame, longitude, latitude, height, roll, pitch, heading, seconds of the GPS week
_BRIEFLY: Final = 60


def hyspex_times(scan: Path, path: Path, week: int | None) -> tuple[NDArray[np.int64], int]:
    """Unix times (us) of the rows of a NAV text, and how many rows stand above them.

    Without a GPS week, it is that of the day in the scan's header.
    """
    day = header_time.day_of(header_time.words_of(scan))
    if week is None and day is not None:
        midnight = datetime.datetime.combine(day, datetime.time(), datetime.UTC)
        week = gps_time.week_at(int(midnight.timestamp()) * 1_000_000)
    if week is None:
        found, expected = "seconds of the GPS week without the week", "source.gps_week, or a date in the scan's header"
        raise InputError(str(path), found, expected, "set source.gps_week")
    seconds: list[float] = []
    above = 0
    for number, line in enumerate(path.read_text(encoding="utf-8-sig", errors="replace").splitlines(), start=1):
        words = re.split(r"[\s,;]+", line.strip())
        try:
            values = [plain_float(word) for word in words]
        except ValueError:
            values = []
        if not values and not seconds:
            above = number
        elif len(values) >= _COLUMNS:
            seconds.append(values[_COLUMNS - 1])
        elif line.strip():
            expected = f"{_COLUMNS} numbers: frame, longitude, latitude, height, roll, pitch, heading, seconds"
            raise InputError(f"{path}, row {number}", repr(line[:_BRIEFLY]), expected, "mend or remove the row")
    if not seconds:
        found, expected = "no row of numbers", "rows of a frame each, whose eighth column is the second of the GPS week"
        raise InputError(str(path), found, expected, "restore the file, or correct source.time_file")
    of_week_us = gps_time.microseconds(np.array(seconds, dtype=float), "s", str(path))
    return gps_time.unix_from_week_of_first(week, of_week_us, str(path)), above

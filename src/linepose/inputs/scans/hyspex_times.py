"""Times of the lines of HySpex's cameras: the last column of the NAV text, a row a frame (seconds of the GPS week)."""

import datetime
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from linepose.errors import InputError
from linepose.inputs import gps_time
from linepose.inputs.number_files import plain_float
from linepose.inputs.scans import header_time

_COLUMNS: Final = 8  # frame, longitude, latitude, height, roll, pitch, heading, seconds of the GPS week
_SIGNS: Final = (";", "\t", ",", None)  # between the cells; None is any number of blanks and tabs
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
    seconds, above = _seconds(path)
    of_week_us = gps_time.microseconds(np.array(seconds, dtype=float), "s", str(path))
    return gps_time.unix_from_week_of_first(week, of_week_us, str(path)), above


def _seconds(path: Path) -> tuple[list[float], int]:
    """The last column, and how many rows stand above the numbers. All rows have the sign between cells of the first."""
    lines = path.read_text(encoding="utf-8-sig", errors="replace").splitlines()
    first = next((row for row, line in enumerate(lines) if any(_numbers(line, sign) for sign in _SIGNS)), None)
    if first is None:
        found, expected = "no row of numbers", "rows of a frame each, whose eighth column is the second of the GPS week"
        raise InputError(str(path), found, expected, "restore the file, or correct source.time_file")
    between = next((sign for sign in _SIGNS if len(_numbers(lines[first], sign)) == _COLUMNS), None)
    seconds = []
    for row, line in enumerate(lines[first:], start=first + 1):
        values = _numbers(line, between)
        if len(values) == _COLUMNS:
            seconds.append(values[-1])
        elif line.strip():
            expected = f"{_COLUMNS} numbers: frame, longitude, latitude, height, roll, pitch, heading, seconds"
            raise InputError(f"{path}, row {row}", repr(line[:_BRIEFLY]), expected, "mend or remove the row")
    return seconds, first


def _numbers(line: str, between: str | None) -> list[float]:
    """Numbers with points or commas as decimals, apart by a sign, which may also end the row; none where one is not."""
    cells = line.split() if between is None else line.strip().strip(between).split(between)
    try:
        return [plain_float(cell.replace(",", ".")) for cell in cells]
    except ValueError:
        return []

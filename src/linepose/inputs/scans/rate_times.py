"""Times of lines that follow each other at a constant rate from a start: of keys, else of the scan's header."""

import datetime
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from linepose.errors import InputError
from linepose.inputs.scans import header_time
from linepose.inputs.scans.scan_files import scan_size


def rate_times(
    scan: Path, starts: Mapping[str, datetime.datetime], rate_hz: float | None
) -> tuple[NDArray[np.int64], Path]:
    """Times (us since 1970, of the clock of the starts) of a scan's lines, and the file that they are of.

    `starts` are by the scans' names, without folder and ending; one without an offset is UTC.
    """
    words = header_time.words_of(scan)
    rate = rate_hz or header_time.line_rate_hz(words, scan)
    if rate is None:
        found, expected = "no rate of the lines", "source.line_rate_hz, or fps in the header"
        raise InputError(str(scan), found, expected, "set source.line_rate_hz")
    start = starts.get(scan.stem)
    first_us = header_time.start_us(words, scan) if start is None else _unix_us(start)
    if first_us is None:
        found, expected = "no time of the first line", f"source.start_times.{scan.stem}, or a start in the header"
        raise InputError(str(scan), found, expected, f"add {scan.stem} to source.start_times")
    return first_us + np.rint(np.arange(scan_size(scan)[0]) * (1e6 / rate)).astype(np.int64), scan


def _unix_us(start: datetime.datetime) -> int:
    aware = start if start.tzinfo else start.replace(tzinfo=datetime.UTC)
    return (aware - datetime.datetime(1970, 1, 1, tzinfo=datetime.UTC)) // datetime.timedelta(microseconds=1)

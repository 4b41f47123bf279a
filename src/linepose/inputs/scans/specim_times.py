"""Times of the lines of Specim's recorders: $SPTSMP in the .nav beside a scan, else start and rate of its header.

A $SPTSMP sentence names a frame (counted from 1), whose time is that of the sentence before it. Lines between two such
frames are evenly spaced, and those after the last at the rate of the header (`fps`), else that of the last two.
"""

import datetime
import logging
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from linepose.errors import InputError
from linepose.inputs.nmea import sentences
from linepose.inputs.patterns import in_any_case
from linepose.inputs.scans import header_time
from linepose.inputs.scans.scan_files import scan_size

_SYNCHRONISED: Final = "SPTSMP"
_FRAME: Final = 2  # word of the sentence that numbers the frame
_LATE: Final = 0.5  # of a line, by which stamps may miss the rate of the header before it is told

log = logging.getLogger(__name__)


def specim_times(scan: Path) -> tuple[NDArray[np.int64], Path]:
    """Unix times (us) of a scan's lines, and the file that they are of."""
    words = header_time.words_of(scan)
    n_lines, rate = scan_size(scan)[0], header_time.line_rate_hz(words, scan)
    navigation = in_any_case(scan.with_suffix(".nav"))
    if navigation.is_file():
        frames, times = _synchronised(navigation, header_time.day_of(words))
        if len(frames):
            return _between(frames, times, n_lines, rate, navigation), navigation
    start = header_time.start_us(words, scan)
    if rate is None or start is None:
        found = f"no {navigation.name} with $SPTSMP beside it, and no Start Time and fps in the header"
        raise InputError(str(scan), found, "one of them", "put the file there, or correct source.time_stamps")
    log.warning("%s: times of the lines from the header's start, which may be off by a second, and its rate", scan)
    return start + np.rint(np.arange(n_lines) * 1e6 / rate).astype(np.int64), scan


def _synchronised(path: Path, day: datetime.date | None) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Numbers of the frames that have a time (from 0), and those times (us)."""
    frames, times = [], []
    for sentence in sentences(path, day, "acquisition date in the scan's header"):
        if sentence.words[0] != _SYNCHRONISED or sentence.time_us is None:
            continue
        try:
            frames.append(int(sentence.words[_FRAME]) - 1)
        except (IndexError, ValueError):
            found = repr(",".join(sentence.words))
            expected, remedy = "the number of a frame as its second value", "remove the line"
            raise InputError(f"{path}, line {sentence.line}", found, expected, remedy) from None
        times.append(sentence.time_us)
    numbers, stamps = np.array(frames, dtype=np.int64), np.array(times, dtype=np.int64)
    repeated = np.flatnonzero((np.diff(numbers) == 0) & (np.diff(stamps) == 0)) + 1
    if repeated.size:
        log.warning("%s: %d $SPTSMP that repeat the one before are passed over", path, repeated.size)
        numbers, stamps = np.delete(numbers, repeated), np.delete(stamps, repeated)
    for row in np.flatnonzero((np.diff(numbers) <= 0) | (np.diff(stamps) <= 0))[:1]:
        found = (
            f"frame {numbers[row + 1] + 1} at {stamps[row + 1]} us after frame {numbers[row] + 1} at {stamps[row]} us"
        )
        raise InputError(str(path), found, "frames and times that increase", "remove the $SPTSMP that is wrong")
    return numbers, stamps


def _between(
    frames: NDArray[np.int64], times: NDArray[np.int64], n_lines: int, rate: float | None, path: Path
) -> NDArray[np.int64]:
    """Times (us) of all lines, of those at some frames."""
    if rate is None and len(frames) < 2:
        found, expected = "one $SPTSMP and no frame rate", "two, or fps in the scan's header"
        raise InputError(str(path), found, expected, "restore the header")
    measured_us = None if len(frames) < 2 else float(times[-1] - times[0]) / float(frames[-1] - frames[0])
    line_us = measured_us if rate is None else 1e6 / rate
    if measured_us is not None and line_us is not None:
        miss = np.abs(np.diff(times) - np.diff(frames) * line_us).max() / line_us
        if miss > _LATE:
            told = "%s: times of $SPTSMP miss the rate of %.3f lines a second by up to %.1f lines"
            log.warning(told, path, 1e6 / line_us, miss)
    lines = np.arange(n_lines)
    step_us = float(line_us or 0.0)
    inside = np.interp(lines, frames, times - times[0])
    before, after = np.minimum(lines - frames[0], 0), np.maximum(lines - frames[-1], 0)
    return times[0] + np.rint(inside + (before + after) * step_us).astype(np.int64)

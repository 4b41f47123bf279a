"""Faults of a scan's time stamps: those that the rate of the others decides are mended and told, others refused."""

import logging
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from linepose.errors import InputError
from linepose.inputs.number_files import check_microseconds

Stamps = NDArray[np.int64]

_REPEATED: Final = 0.1  # of the median step: so short a step is of a line that was stamped twice
_TWICE: Final = (1.5, 2.5)  # of the median step: the step beside a repeated stamp, in which one is missing
_JUMP: Final = 10.0  # of the median step: a step that is told
_FEWEST: Final = 4  # steps, from which a median says something

log = logging.getLogger(__name__)


def checked_line_times(times: Stamps, n_lines: int, path: Path, heading: int) -> Stamps:
    """Time stamps (n_lines,) in us; raises InputError where they are not one a line, or do not increase.

    One more than lines, of a line stamped twice, is passed over; a stamp that stands twice while the step beside it is
    twice as long is put between its neighbours; a jump is told. `heading` is the number of rows above the first stamp.
    """
    if len(times) == n_lines + 1:
        times = _without_one_too_many(times, path)
    if len(times) != n_lines:
        too_few = len(times) < n_lines
        remedy = "restore the file that is incomplete" if too_few else "remove those of no line, or restore the scan"
        raise InputError(str(path), f"{len(times)} time stamps", f"{n_lines}, one for each line of the scan", remedy)
    check_microseconds(times, path, first_row=heading + 1)
    times = _without_a_repeated_one(times, path, heading)
    backwards = np.flatnonzero(np.diff(times) <= 0)
    if backwards.size:
        row = int(backwards[0]) + 1
        place, expected = f"{path}, row {row + heading + 1}", f"a time after the line before it ({times[row - 1]})"
        raise InputError(place, f"time {times[row]}", expected, "correct the camera's clock or remove the lines")
    _tell_jumps(times, path, heading)
    return times


def _without_one_too_many(times: Stamps, path: Path) -> Stamps:
    """The times without the one that is hardly later than that before it, where there is just one such.

    Of one far off at an end nothing tells whether it, or another after a pause, is of no line.
    """
    step = np.diff(times)
    if len(step) <= _FEWEST:
        return times
    short = np.flatnonzero(np.abs(step) < _REPEATED * np.median(step))
    if len(short) != 1:
        return times
    row = int(short[0]) + 1
    log.warning("%s: one time stamp more than lines; stamp %d of a line stamped twice is passed over", path, row + 1)
    return np.delete(times, row)


def _without_a_repeated_one(times: Stamps, path: Path, heading: int) -> Stamps:
    """The times with each repeated one halfway between its neighbours, where a long step says that it belongs there."""
    step = np.diff(times)
    if len(step) <= _FEWEST:
        return times
    usual, mended = float(np.median(step)), times.copy()
    for row in np.flatnonzero(step == 0):
        after = step[row + 1] / usual if row + 1 < len(step) else 0.0
        before = step[row - 1] / usual if row else 0.0
        if _TWICE[0] < after < _TWICE[1]:
            mended[row + 1] = (times[row] + times[row + 2]) // 2
        elif _TWICE[0] < before < _TWICE[1]:
            mended[row] = (times[row - 1] + times[row + 1]) // 2
        else:
            continue
        log.warning("%s, row %d: a time that stands twice is put between its neighbours", path, row + heading + 2)
    return mended


def _tell_jumps(times: Stamps, path: Path, heading: int) -> None:
    step = np.diff(times)
    if len(step) <= _FEWEST:
        return
    usual = float(np.median(step))
    for row in np.flatnonzero(step > _JUMP * usual)[:1]:
        told = "%s, row %d: %.3f s after the line before it, where lines are %.6f s apart: lines may be missing"
        log.warning(told, path, row + heading + 2, step[row] / 1e6, usual / 1e6)

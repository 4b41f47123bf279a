"""Times of the lines of Headwall's recorders: frameIndex_N.txt beside raw_N, rows of a frame and microseconds."""

import re
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from linepose.errors import InputError
from linepose.inputs.number_files import plain_whole
from linepose.inputs.scans.files_beside import first_file, rows_of


def headwall_times(path: Path) -> tuple[NDArray[np.int64], int]:
    """Times (us, of the recorder's clock) of the rows, and how many rows (0 or 1) the heading takes."""
    rows = rows_of(path)
    heading = int(rows[0].lower().startswith("frame"))
    times = np.empty(len(rows) - heading, dtype=np.int64)
    for index, row in enumerate(rows[heading:]):
        try:
            _, times[index] = _two(row.split())
        except ValueError:
            place, expected = f"{path}, row {index + heading + 1}", "a frame number and its time stamp (us)"
            raise InputError(place, repr(row[:60]), expected, "mend the row, or remove it with its line") from None
    return times, heading


def frame_index(scan: Path) -> Path:
    """The file of the number after the scan's `raw_`; raises InputError where the name does not say just one."""
    found = set(re.findall(r"(?<![^\W_])raw_(\d+)", scan.stem, re.IGNORECASE))
    if len(found) != 1:
        told = "a name with several raw_N" if found else "a name without raw_N"
        expected = "raw_N.hdr, whose time stamps stand in frameIndex_N.txt"
        remedy = "restore the recorder's name, or name the file by source.time_file ({name}_frames.txt)"
        raise InputError(str(scan), told, expected, remedy)
    return first_file([f"frameIndex_{found.pop()}.txt"], scan)


def _two(words: list[str]) -> tuple[str, int]:
    frame, stamp = words
    return frame, plain_whole(stamp)

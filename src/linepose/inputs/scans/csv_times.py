"""Time stamps in a file of one a row: whole microseconds, seconds with decimals, or dates and times (ISO 8601, UTC)."""

import re
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from linepose.errors import InputError
from linepose.inputs import gps_time

_BRIEFLY: Final = 60
_KINDS: Final = {
    "a whole number of microseconds": re.compile(r"[+-]?\d{1,18}"),
    "seconds with decimals": re.compile(r"[+-]?\d{1,12}\.\d*"),
    "a date and time such as 2026-05-01T12:00:00.25Z": re.compile(
        r"\d{4}[-/]\d\d[-/]\d\d[T ]\d\d:\d\d:\d\d(\.\d*)?\S*"
    ),
}


def read_times(path: Path) -> tuple[NDArray[np.int64], int]:
    """Time stamps (us), one a row, and how many rows (0 or 1) the heading takes.

    All rows are of the kind of the first. Raises InputError naming the row that is not.
    """
    if not path.is_file():
        raise InputError(str(path), "no such file", "the time stamp of each line", "put it beside the scan")
    try:
        rows = [row.strip().strip('"') for row in path.read_text(encoding="utf-8-sig").splitlines() if row.strip()]
    except UnicodeDecodeError:
        raise InputError(str(path), "bytes that are not text", "a time stamp a row", "restore the file") from None
    heading = int(bool(rows) and bool(re.match(r"[A-Za-z_]", rows[0])))
    cells = rows[heading:]
    if not cells:
        return np.empty(0, dtype=np.int64), heading
    kind = next((name for name, pattern in _KINDS.items() if pattern.fullmatch(cells[0])), next(iter(_KINDS)))
    for row, cell in enumerate(cells, start=heading + 1):
        if not _KINDS[kind].fullmatch(cell):
            raise _fault(path, row, cell, kind)
    return _microseconds(cells, kind, path, heading), heading


def _microseconds(cells: list[str], kind: str, path: Path, heading: int) -> NDArray[np.int64]:
    whole, seconds, _ = _KINDS
    if kind == whole:
        return np.array(cells, dtype=np.int64)
    if kind == seconds:
        return gps_time.microseconds(np.array(cells, dtype=float), "s", str(path))
    times = pd.to_datetime(pd.Series(cells).str.replace("/", "-"), utc=True, format="ISO8601", errors="coerce")
    for row in np.flatnonzero(times.isna().to_numpy())[:1]:
        raise _fault(path, heading + int(row) + 1, cells[row], kind)
    return np.asarray(times.astype("datetime64[us, UTC]").astype("int64").to_numpy())


def _fault(path: Path, row: int, cell: str, expected: str) -> InputError:
    return InputError(f"{path}, row {row}", repr(cell[:_BRIEFLY]), expected, "mend the row")

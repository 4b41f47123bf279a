"""Time stamps in a file of one a row: microseconds, seconds with decimals or in powers of ten, or ISO 8601 (UTC)."""

import codecs
import re
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from linepose.errors import InputError
from linepose.inputs import gps_time
from linepose.inputs.text_files import check_text

_BRIEFLY: Final = 60
_WHOLE: Final = "a whole number of microseconds"
_SECONDS: Final = "seconds with decimals"
_POWERS: Final = "numbers such as 1.7e+09 (s) or 1.7e+15 (us)"
_TEXT: Final = "a date and time such as 2026-05-01T12:00:00.25Z"
_KINDS: Final = {
    _WHOLE: re.compile(r"[+-]?\d{1,19}"),
    _SECONDS: re.compile(r"[+-]?\d{1,12}(\.\d*|,\d{0,9})?"),
    _POWERS: re.compile(r"[+-]?\d(\.\d*)?[eE][+]?\d{1,2}"),
    _TEXT: re.compile(r"\d{4}[-/]\d\d[-/]\d\d[T ]\d\d:\d\d:\d\d([.,]\d*)?\S*"),
}
_MARKS: Final = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)
_SMALLEST_WHOLE_S: Final = 1000  # before a decimal comma; below, a row is a number and a time
_SMALLEST_US: Final = 1e14  # of numbers in powers of ten, which are seconds below


def read_times(path: Path) -> tuple[NDArray[np.int64], int]:
    """Time stamps (us), one a row, and how many rows (0 or 1) the heading takes.

    All rows are of one kind, the first that fits them. Raises InputError naming the row that is not.
    """
    if not path.is_file():
        raise InputError(str(path), "no such file", "the time stamp of each line", "put it beside the scan")
    check_text(path, "a time stamp a row")
    rows = [row.strip().strip('"') for row in _text(path).splitlines() if row.strip()]
    heading = int(bool(rows) and bool(re.match(r"[A-Za-z_]", rows[0])))
    cells = rows[heading:]
    if not cells:
        return np.empty(0, dtype=np.int64), heading
    kind = next((name for name in _KINDS if _misfit(cells, name) is None), None)
    if kind == _SECONDS and not _are_decimals(cells):
        raise _fault(path, heading + 1, cells[0], f"one time alone: {', '.join(_KINDS)}")
    if kind is None:
        kind = next((name for name, pattern in _KINDS.items() if pattern.fullmatch(cells[0])), None)
        row = 0 if kind is None else _misfit(cells, kind) or 0
        raise _fault(path, heading + row + 1, cells[row], kind or f"one time alone: {', '.join(_KINDS)}")
    return _microseconds(cells, kind, path, heading), heading


def _misfit(cells: list[str], kind: str) -> int | None:
    """The first row that is not of this kind; None where all are."""
    return next((row for row, cell in enumerate(cells) if not _KINDS[kind].fullmatch(cell)), None)


def _are_decimals(cells: list[str]) -> bool:
    """Whether commas stand before decimals, and not between two columns: then times are large and do not go back."""
    if not any("," in cell for cell in cells):
        return True
    seconds = np.array([cell.replace(",", ".") for cell in cells], dtype=float)
    return bool(np.all(np.abs(seconds) >= _SMALLEST_WHOLE_S) and np.all(np.diff(seconds) >= 0))


def _text(path: Path) -> str:
    content = path.read_bytes()
    try:
        return content.decode("utf-16" if content.startswith(_MARKS) else "utf-8-sig")
    except UnicodeDecodeError:
        raise InputError(str(path), "bytes that are not text", "a time stamp a row", "restore the file") from None


def _microseconds(cells: list[str], kind: str, path: Path, heading: int) -> NDArray[np.int64]:
    if kind == _WHOLE:
        for row in (row for row, cell in enumerate(cells) if abs(int(cell)) >= 2**63):
            raise _fault(path, heading + row + 1, cells[row], kind)
        return np.array([int(cell) for cell in cells], dtype=np.int64)
    cells = [cell.replace(",", ".") for cell in cells]
    if kind in {_SECONDS, _POWERS}:
        numbers = np.array(cells, dtype=float)
        unit: gps_time.TimeUnit = "us" if kind == _POWERS and numbers.min() >= _SMALLEST_US else "s"
        return gps_time.microseconds(numbers, unit, str(path))
    times = pd.to_datetime(pd.Series(cells).str.replace("/", "-"), utc=True, format="ISO8601", errors="coerce")
    for row in np.flatnonzero(times.isna().to_numpy())[:1]:
        raise _fault(path, heading + int(row) + 1, cells[row], kind)
    return np.asarray(times.astype("datetime64[us, UTC]").astype("int64").to_numpy())


def _fault(path: Path, row: int, cell: str, expected: str) -> InputError:
    return InputError(f"{path}, row {row}", repr(cell[:_BRIEFLY]), expected, "mend the row")

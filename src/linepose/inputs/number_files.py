"""Headerless CSV files of numbers, as the field data have them; a fault is named with its row."""

import re
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd

from linepose.arrays import Floats
from linepose.errors import InputError, quoted
from linepose.inputs.text_files import check_text

_OTHER_SIGNS: Final = {";": "semicolons", "\t": "tabs"}
_LONGEST_HEADING: Final = 10_000  # characters

Whole = np.ndarray[tuple[int], np.dtype[np.int64]]


def plain_float(text: str) -> float:
    """The number that a text is, in digits of ASCII without `_`; raises ValueError for any other."""
    if not text.isascii() or "_" in text:
        raise ValueError(text)
    return float(text)


def plain_whole(text: str) -> int:
    """The whole number of at most 18 digits that a text is, in digits of ASCII; raises ValueError for any other."""
    if not re.fullmatch(r"\s*[+-]?\d{1,18}\s*", text, re.ASCII):
        raise ValueError(text)
    return int(text)


def read_numbers(path: Path, n_columns: int, what: str) -> tuple[Whole, Floats]:
    """First column as whole numbers (R,) and the others as floats (R, n_columns - 1); empty cells become NaN.

    Raises InputError for a file that is missing or empty, a row of another length, or a cell that is no number.
    """
    first, _, others = _read(path, n_columns, 1, what)
    return first, others


def read_named_numbers(path: Path, n_columns: int, what: str) -> tuple[Whole, list[str], Floats]:
    """As `read_numbers`, but the second column is text: whole numbers (R,), text (R), floats (R, n_columns - 2)."""
    return _read(path, n_columns, 2, what)


def _read(path: Path, n_columns: int, n_first: int, what: str) -> tuple[Whole, list[str], Floats]:
    """First column, text of the second, and the columns after the first `n_first` as floats."""
    if not path.is_file():
        raise InputError(str(path), "no such file", what, "restore it, or correct the platform file")
    check_text(path, what)
    try:
        lines = path.read_text(encoding="utf-8").rstrip().splitlines()
    except UnicodeDecodeError:
        raise InputError(str(path), "bytes that are not UTF-8", what, "save the file as UTF-8 text") from None
    if not lines:
        raise InputError(str(path), "an empty file", what, "restore it, or leave it out")
    if n_columns > 1:
        check_commas(path)
    first, second = np.empty(len(lines), dtype=np.int64), []
    others = np.empty((len(lines), n_columns - n_first))
    for index, cells in enumerate(line.split(",") for line in lines):
        place = f"{path}, row {index + 1}"
        if len(cells) != n_columns:
            raise InputError(place, f"{len(cells)} columns", f"{n_columns} columns ({what})", "mend the row")
        try:
            first[index] = plain_whole(cells[0])
        except ValueError:
            remedy = "write the time as a whole number of microseconds"
            raise InputError(f"{place}, column 1", repr(cells[0]), "a whole number", remedy) from None
        second.append(cells[1].strip())
        for column, cell in enumerate(cells[n_first:]):
            try:
                others[index, column] = plain_float(cell) if cell.strip() else np.nan
            except ValueError:
                where = f"{place}, column {column + n_first + 1}"
                raise InputError(where, repr(cell), "a number", "mend the cell") from None
    return first, second, others


def check_commas(path: Path) -> None:
    """Raise InputError where the first row of a CSV has other signs between its cells, before its first comma.

    To be called before the rows are read: with commas in decimals they have no number of cells.
    """
    with path.open(encoding="utf-8-sig", errors="replace") as file:
        first = file.read(_LONGEST_HEADING).lstrip("\n ").partition("\n")[0].partition(",")[0]
    for sign, name in _OTHER_SIGNS.items():
        if sign in first:
            expected, remedy = "commas, and points in decimals", "save it so, or replace them"
            raise InputError(str(path), f"{name} between cells", expected, remedy)


def check_cells(table: pd.DataFrame, path: Path) -> None:
    """Raise InputError where a CSV's heading is a comment, or rows have more cells, which pandas takes for names."""
    if str(table.columns[0]).lstrip().startswith("#"):
        found, remedy = f"a heading that begins with {quoted(str(table.columns[0])[:60])}", "remove the comment"
        raise InputError(str(path), found, "the names of the columns in the first line", remedy)
    if not isinstance(table.index, pd.RangeIndex):
        found, expected = "rows of more cells than the heading", "a cell in each row for each column"
        raise InputError(str(path), found, expected, "remove the commas at the rows' ends, or name all columns")


def check_microseconds(time_us: Whole, path: Path, first_row: int = 1) -> None:
    """Raise InputError where times are not microseconds since 1970 between 1980 and 2100.

    `first_row` is the file's row that holds the first of them.
    """
    wrong = np.flatnonzero((time_us < 315_964_800_000_000) | (time_us > 4_102_444_800_000_000))
    if wrong.size:
        row, time = int(wrong[0]), int(time_us[wrong[0]])
        guess = next(
            (
                f"they look like {unit}: multiply by {factor}"
                for unit, factor, low, high in _OTHER_UNITS
                if low < time < high
            ),
            "write microseconds since 1970",
        )
        raise InputError(
            f"{path}, row {row + first_row}, column 1", f"time {time}", "microseconds since 1970-01-01", guess
        )


_OTHER_UNITS = (
    ("seconds", 1_000_000, 315_964_800, 4_102_444_800),
    ("milliseconds", 1_000, 315_964_800_000, 4_102_444_800_000),
    ("nanoseconds", "0.001", 315_964_800_000_000_000, 4_102_444_800_000_000_000),
)

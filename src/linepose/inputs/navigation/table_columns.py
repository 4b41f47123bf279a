"""Columns of a table by their names, as numbers, angles or text; a fault is told with file, row and column."""

import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd

from linepose.arrays import Floats
from linepose.errors import InputError

Name = str | tuple[str, ...]  # a column, or several whose cells are one value (a date and a time; degrees, minutes)

Names = tuple[Name, Name, Name]

_ANGLE: Final = (  # 22 18 04.3, 22:18:04.3, 22°18'04.3"N; minutes or seconds may be missing
    r"^\s*(?P<before>[NSEWnsew]?)\s*(?P<sign>[+-]?)\s*(?P<d>\d+(?:\.\d*)?)"
    r"(?:[^\d.+-]+(?P<m>\d+(?:\.\d*)?))?(?:[^\d.+-]+(?P<s>\d+(?:\.\d*)?))?[^\dNSEWnsew]*(?P<after>[NSEWnsew]?)\s*$"
)


_ROWS_AT_ONCE: Final = 50_000


def parts_of(name: Name) -> tuple[str, ...]:
    """The columns of a value."""
    return (name,) if isinstance(name, str) else name


class Columns:
    """The cells of one file, whose first row of values stands on this line (counted from 0).

    `names` are all columns of the file, where `cells` are not of all; `decimal` is the sign of the decimals in text.
    """

    def __init__(
        self, path: Path, cells: pd.DataFrame, first_line: int, names: Sequence[str] = (), decimal: str = "."
    ) -> None:
        self.path, self.cells, self.first_line, self.decimal = path, cells, first_line, decimal
        self.names = tuple(names) or tuple(map(str, cells.columns))

    def check(self, names: Sequence[Name], key: str = "source.navigation.columns") -> None:
        """Raise InputError, with the key that names them, where one of these columns is not there."""
        there = list(self.cells.columns)
        missing = [part for name in names for part in parts_of(name) if part not in there]
        if missing:
            found = f"columns {', '.join(self.names)}"
            expected = f"among them {', '.join(missing)}"
            raise InputError(str(self.path), found, expected, f"correct {key}")

    def filled(self, names: Sequence[Name]) -> np.ndarray:
        """Which rows (K,) have a value in each of these columns."""
        parts = [part for name in names for part in parts_of(name)]
        return np.asarray(self.cells[parts].notna().all(axis=1).to_numpy())

    def rows(self, kept: np.ndarray) -> "Columns":
        """The rows (K,) of these; their numbers in the file are kept."""
        return Columns(self.path, self.cells[kept], self.first_line, self.names, self.decimal)

    def pieces(self) -> Iterator["Columns"]:
        """The rows in parts, one after the other: text of all of them at once takes much memory."""
        for first in range(0, max(len(self.cells), 1), _ROWS_AT_ONCE):
            cells = self.cells.iloc[first : first + _ROWS_AT_ONCE]
            yield Columns(self.path, cells, self.first_line, self.names, self.decimal)

    def place(self, row: int, name: str) -> str:
        """Where the value in this row (counted from 0) stands in the file."""
        return f"{self.path}, row {int(self.cells.index[row]) + self.first_line + 1}, {name}"

    def text(self, name: Name) -> pd.Series:
        """Cells as text (K,), those of several columns with blanks between."""
        first, *others = (self.cells[part].astype(str) for part in parts_of(name))
        return first.str.cat(others, sep=" ") if others else first

    def numbers(self, names: Sequence[Name], of_degrees: str = "") -> Floats:
        """Columns as numbers (K, N); `of_degrees` is the remedy where cells have minutes and seconds."""
        return np.stack([self.number(name, of_degrees).astype(float) for name in names], axis=-1)

    def number(self, name: Name, of_degrees: str = "") -> np.ndarray:
        """A column as numbers (K,); whole ones stay whole."""
        column = self.cells[name] if isinstance(name, str) else self._with_points(self.text(name))
        numbers = pd.to_numeric(column, errors="coerce")
        for row in np.flatnonzero(numbers.isna().to_numpy() & column.notna().to_numpy())[:1]:
            told, cell = " ".join(parts_of(name)), str(column.iloc[row])
            angle = re.match(_ANGLE, cell)
            remedy = of_degrees if of_degrees and angle and angle["m"] else "mend or remove the row"
            raise InputError(self.place(row, told), repr(cell), "a number", remedy)
        return np.asarray(numbers.to_numpy())

    def _with_points(self, text: pd.Series) -> pd.Series:
        """Text (K,) of numbers, with a point as the sign of their decimals."""
        return text if self.decimal == "." else text.str.replace(self.decimal, ".", regex=False)

    def degrees(self, name: Name) -> Floats:
        """Angles (K,) in degrees, of text with degrees, minutes and seconds; S and W count as minus."""
        return np.concatenate([piece._degrees(name) for piece in self.pieces()])

    def _degrees(self, name: Name) -> Floats:
        text = self.text(name)
        parts = self._with_points(text).str.extract(_ANGLE)
        for row in np.flatnonzero(parts["d"].isna().to_numpy())[:1]:
            told = " ".join(parts_of(name))
            expected = "degrees, minutes, seconds such as 22 18 04.3"
            raise InputError(self.place(row, told), repr(str(text.iloc[row])), expected, "mend or remove the row")
        values = parts[["d", "m", "s"]].astype(float).fillna(0.0).to_numpy() @ [1.0, 1 / 60, 1 / 3600]
        below = (parts["sign"] == "-") ^ (parts["before"] + parts["after"]).str.upper().isin(["S", "W"])
        return np.where(below.to_numpy(), -values, values)

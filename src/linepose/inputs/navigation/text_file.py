"""Text of columns as programs write them: a heading or none, apart by a sign, by blanks, or of fixed widths.

One set of options says how such a file is laid out; pandas reads it. Cells stay text where they are asked for as text
(dates, degrees with minutes), all others become numbers.
"""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import Any, Final

import pandas as pd
from pydantic import Field, PositiveInt, field_validator

from linepose.errors import InputError
from linepose.inputs.text_files import check_text, lines_of
from linepose.settings import Settings

_LINES_ABOVE: Final = 2_000  # within which the first row of values must stand
_WHAT: Final = "a table of text"
_BRIEFLY: Final = 60
_ROWS_AT_ONCE: Final = 50_000
_BLANKS: Final = r"\s+"


class TextLayout(Settings):
    """Keys that say how a text file of columns is laid out."""

    heading: bool = Field(True, description="Whether a row of a text file names the columns.")
    heading_words: tuple[str, ...] = Field(
        (), description="Names in the heading: lines above the first that has them all are passed over."
    )
    unit_rows: int = Field(0, ge=0, description="Rows below the heading that are passed over (units, comments).")
    skipped_lines: int = Field(0, ge=0, description="Lines at the start of a text file that are passed over.")
    comment: str | None = Field(
        None, min_length=1, max_length=1, description="Sign from which on the rest of a line is passed over."
    )
    delimiter: str = Field(
        ",",
        min_length=1,
        max_length=1,
        description="What stands between the cells of a text file; a blank is any number of blanks and tabs.",
    )
    widths: tuple[PositiveInt, ...] = Field(
        (), description="Widths of the columns in characters, where no delimiter stands between them."
    )
    encoding: str = Field("utf-8", description="Encoding of a text file, as Python names it: utf-8, latin-1, cp1252.")
    decimal: str = Field(".", pattern=r"^[.,]$", description="Sign of the decimals.")

    @field_validator("encoding")
    @classmethod
    def _is_known(cls, encoding: str) -> str:
        try:
            "".encode(encoding)
        except LookupError:
            raise ValueError("an encoding that Python knows, such as utf-8 or latin-1") from None
        return encoding


@dataclass(frozen=True)
class TextTable:
    """Cells of a file; `first_line` (from 0) is the line of its first row of values, `names` are all its columns."""

    cells: pd.DataFrame
    first_line: int
    names: tuple[str, ...]


def read_text(
    path: Path, layout: TextLayout, used: Iterable[str], as_text: Iterable[str], apart: Sequence[str] = ()
) -> TextTable:
    """The rows of a text file, of the columns `used` that it has; those `as_text` stay text.

    Degrees, minutes and seconds of the columns `apart` may take three cells each, where rows have so many cells more
    than the heading; they are then named NAME d, NAME m, NAME s. Raises InputError naming the line.
    """
    try:
        names, first_line = _head(path, layout, apart)
        parts = {f"{name} {part}" for name in apart for part in "dms"}
        kept = [number for number, name in enumerate(names) if name in {*used, *parts}]
        if not kept:
            return TextTable(pd.DataFrame(), first_line, tuple(names))
        cells = _cells(path, layout, names, first_line, kept, set(as_text))
    except (UnicodeError, pd.errors.ParserError, OSError) as error:
        raise _fault(path, error) from None
    cells.columns = pd.Index([names[number] for number in kept])
    return TextTable(cells, first_line, tuple(names))


def first_lines(path: Path, encoding: str) -> list[str]:
    """The first lines of a text file without their ends.

    Raises UnicodeError for another encoding, InputError for what is no text.
    """
    is_utf_8 = encoding.lower() in {"utf-8", "utf8"}
    if is_utf_8:
        check_text(path, _WHAT)
    lines = lines_of(path, _WHAT, "utf-8-sig" if is_utf_8 else encoding, "strict")
    return [line.rstrip("\r\n") for line in islice(lines, _LINES_ABOVE)]


def _fault(path: Path, error: Exception) -> InputError:
    if isinstance(error, UnicodeError):
        return InputError(str(path), "bytes of another encoding", "text", "set source.navigation.encoding (latin-1)")
    found = re.sub(r"^Error tokenizing data\. C error: ", "", " ".join(str(error).split()))
    cells = re.search(r"Expected (\d+) fields in line (\d+), saw (\d+)", found)
    if cells:
        place, remedy = f"{path}, line {cells[2]}", "mend or remove the line, or correct source.navigation.delimiter"
        return InputError(place, f"{cells[3]} cells", f"{cells[1]}, as in the lines before it", remedy)
    return InputError(str(path), found, "text with the same cells in each row", "mend it")


def _cells(
    path: Path, layout: TextLayout, names: list[str], first_line: int, kept: list[int], as_text: set[str]
) -> pd.DataFrame:
    """The columns `kept`, by their numbers; read in parts, so that the others never take memory together."""
    numbers = list(range(len(names)))
    options: dict[str, Any] = {
        "header": None,
        "names": numbers,
        "index_col": False,
        "skiprows": first_line,
        "comment": layout.comment,
        "encoding": layout.encoding,
        "decimal": layout.decimal,
        "dtype": {number: "string[pyarrow]" for number, name in enumerate(names) if name in as_text},
        "chunksize": _ROWS_AT_ONCE,
    }
    if layout.widths:
        parts = pd.read_fwf(path, widths=layout.widths, **options)
    else:
        separator = _BLANKS if layout.delimiter.isspace() and layout.delimiter != "\t" else layout.delimiter
        parts = pd.read_csv(path, sep=separator, skipinitialspace=True, **options)
    with parts:
        return pd.concat([part[kept] for part in parts])


def _head(path: Path, layout: TextLayout, apart: Sequence[str]) -> tuple[list[str], int]:
    """Names of the columns, and the line (from 0) of the first row of values."""
    lines = first_lines(path, layout.encoding)
    row, names = layout.skipped_lines, list[str]()
    if layout.heading:
        if _next_row(lines, layout.skipped_lines, None) >= len(lines):
            raise InputError(str(path), "no heading", "a line with the names of the columns", "restore the file")
        row = _heading_row(path, lines, layout)
        names = _distinct(_words(_without_comment_sign(lines[row], layout), layout))
        row += 1
        for _ in range(layout.unit_rows):
            row = _next_row(lines, row, None) + 1
    row = _next_row(lines, row, layout.comment)
    if row >= len(lines):
        raise InputError(str(path), "no row of values", "a row of values", "restore the file")
    first = _words(lines[row], layout, is_heading=False)
    return (_fitted(names, first, apart, f"{path}, line {row + 1}") if names else _numbered(first)), row


def _heading_row(path: Path, lines: list[str], layout: TextLayout) -> int:
    if not layout.heading_words:
        return min(_next_row(lines, layout.skipped_lines, layout.comment), len(lines) - 1)
    for row in range(layout.skipped_lines, len(lines)):
        if set(layout.heading_words) <= set(_words(_without_comment_sign(lines[row], layout), layout)):
            return row
    found, expected = "no heading", f"a line with {', '.join(layout.heading_words)}"
    remedy = "correct source.navigation.heading_words or source.navigation.preset"
    raise InputError(str(path), found, expected, remedy)


def _next_row(lines: list[str], row: int, comment: str | None) -> int:
    """The first row from this one on that is neither blank nor a comment."""
    while row < len(lines) and (not lines[row].strip() or (comment and lines[row].lstrip().startswith(comment))):
        row += 1
    return row


def _without_comment_sign(line: str, layout: TextLayout) -> str:
    return line.strip().removeprefix(layout.comment) if layout.comment else line


def _words(line: str, layout: TextLayout, is_heading: bool = True) -> list[str]:
    if layout.comment:
        line = line.partition(layout.comment)[0]
    if layout.widths:
        ends = [sum(layout.widths[: number + 1]) for number in range(len(layout.widths))]
        return [line[end - width : end].strip() for end, width in zip(ends, layout.widths, strict=True)]
    if not layout.delimiter.isspace() or layout.delimiter == "\t":
        return [word.strip().strip('"') for word in line.split(layout.delimiter)]
    if is_heading and "," in line:  # names with blanks in them
        return [word.strip() for word in line.split(",")]
    return line.split()


def _distinct(names: list[str]) -> list[str]:
    """The names, the second of a kind with a 2 behind it."""
    return [f"{name} {before + 1}" if (before := names[:at].count(name)) else name for at, name in enumerate(names)]


def _numbered(first: list[str]) -> list[str]:
    return [str(number + 1) for number in range(len(first))]


def _fitted(names: list[str], first: list[str], apart: Sequence[str], place: str) -> list[str]:
    """The heading's names, one a cell of the first row."""
    if apart and len(first) == len(names) + 2 * len(apart):
        return [
            f"{name} {part}" if part else name
            for name in names
            for part in (("d", "m", "s") if name in apart else ("",))
        ]
    beyond = first[len(names) :]
    if len(first) < len(names) or any(beyond):
        remedy = "correct source.navigation.delimiter, or set latitude_unit: dms where angles take three cells"
        raise InputError(place, f"{len(first)} cells", f"{len(names)}, as in the heading", remedy)
    return [*names, *(f"beyond {number}" for number in range(1, len(beyond) + 1))]

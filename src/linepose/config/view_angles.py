"""A camera's view angles, from the CSV that its platform's file names."""

import csv
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from linepose.errors import InputError, quoted
from linepose.geometry.view_angles import fault_of_rows, fault_of_width
from linepose.inputs.number_files import plain_float
from linepose.inputs.text_files import small_text

_REQUIRED: Final = ("pixel", "across_deg")
_COLUMNS: Final = (*_REQUIRED, "along_deg")
_INSTEAD: Final = ("focal_length_m", "field_of_view_deg", "principal_point_px")
_WHAT: Final = "a CSV of view angles"
_SIGNS: Final = {";": "semicolons", "\t": "tabs", ",": "commas"}  # commas last, which may be those of decimals
_BLANKS: Final = "blanks"
_HEADING: Final = f"columns {', '.join(_REQUIRED)} and perhaps {_COLUMNS[2]}, by name"


def with_named_table(values: dict[str, Any], platform: Path) -> dict[str, Any]:
    """A platform file's values, with the path of the file beside it that `camera.view_angles` names.

    Raises InputError where the name is empty.
    """
    camera = values.get("camera")
    named = camera.get("view_angles") if isinstance(camera, dict) else None
    if not isinstance(named, str):
        return values
    if not named.strip():
        raise InputError(f"{platform}: camera.view_angles", repr(named), _WHAT, "name the file, or remove the key")
    return values | {"camera": values["camera"] | {"view_angles": platform.parent / named}}


def with_view_angles(values: dict[str, Any], place: str, inherits: bool) -> dict[str, Any]:
    """A platform's values with the numbers of the file whose path is `camera.view_angles`.

    `inherits` says whether some of them are of another platform, by `like`. Raises InputError for a file that is no
    table of this camera, and for keys of the camera that the table stands in for.
    """
    camera = values.get("camera")
    if not isinstance(camera, dict) or camera.get("view_angles") is None:
        return values
    twice = [name for name in _INSTEAD if camera.get(name) is not None]
    if twice:
        remedy = f"leave out {', '.join(twice)}" + (" (null where `like` gives it)" if inherits else "")
        raise InputError(f"{place}: camera", f"view_angles with {', '.join(twice)}", "one of them", remedy)
    path, n_pixels = camera["view_angles"], camera.get("n_pixels")
    if not isinstance(path, Path):
        return values
    table = read_view_angles(path, n_pixels if isinstance(n_pixels, int) and n_pixels > 0 else None)
    return values | {"camera": camera | {"view_angles": table}}


def read_view_angles(
    path: Path, n_pixels: int | None = None, key: str = "camera.view_angles", width_key: str = "camera.n_pixels"
) -> dict[str, list[float]]:
    """Columns of a CSV: pixel, across_deg, and along_deg where it has it; lines that begin with # are passed over.

    Between cells stands a comma, or the semicolon, tab or blanks of its heading, with which decimals may have a comma.
    Pixels that are numbered from 1 without a gap are counted from 0. Raises InputError naming the line that is none of
    such a table, also where it is not of a line of `n_pixels`; `key` and `width_key` are what the person gave these by.
    """
    lines = small_text(path, _WHAT, key).splitlines()
    rows = [(k, line) for k, line in enumerate(lines, 1) if line.strip() and not line.lstrip().startswith("#")]
    sign = next((one for one in _SIGNS if rows and one in rows[0][1]), None)
    heads = _cells(rows[0][1], sign) if rows else []
    unknown = [one for one in heads if one not in _COLUMNS]
    if unknown or not set(_REQUIRED) <= set(heads) or len(set(heads)) < len(heads):
        raise InputError(f"{path}, heading", ", ".join(heads) or "nothing", _HEADING, "name the columns")
    table: dict[str, list[float]] = {name: [] for name in heads}
    for k, line in rows[1:]:
        numbers = _numbers(line, sign)
        if numbers is None or len(numbers) != len(heads):
            raise _fault(line, heads, sign, f"{path}, line {k}")
        for name, number in zip(heads, numbers, strict=True):
            table[name].append(number)
    _check(table, [k for k, _ in rows[1:]], path)
    pixels = table["pixel"]
    if pixels == [float(k) for k in range(1, len(pixels) + 1)]:
        table["pixel"] = [one - 1 for one in pixels]
    fault = None if n_pixels is None else fault_of_width(table["pixel"], n_pixels, width_key)
    if fault is not None:
        raise _swapped(table, path) or InputError(str(path), fault.found, fault.expected, fault.remedy)
    return table


def _cells(line: str, sign: str | None) -> list[str]:
    """The cells of a line between these signs, or between blanks where there is none."""
    return line.split() if sign is None else [one.strip() for one in next(csv.reader([line], delimiter=sign))]


def _number(cell: str, sign: str | None) -> float | None:
    """The number of a cell, which between other signs than commas may have a decimal comma; None where it is none."""
    try:
        number = plain_float(cell if sign == "," else cell.replace(",", "."))
    except ValueError:
        return None
    return number if math.isfinite(number) else None


def _numbers(line: str, sign: str | None) -> list[float] | None:
    """The numbers of a line's cells; None where one of them is none."""
    numbers = [_number(cell, sign) for cell in _cells(line, sign)]
    whole = [one for one in numbers if one is not None]
    return whole if len(whole) == len(numbers) else None


def _fault(line: str, heads: list[str], sign: str | None, place: str) -> InputError:
    """What is wrong with a line that has no number for each column."""
    cells = _cells(line, sign)
    for other in (*_SIGNS, None):
        numbers = None if other == sign else _numbers(line, other)
        if numbers is not None and len(numbers) == len(heads):
            found, expected = (_SIGNS.get(one or "", _BLANKS) for one in (other, sign))
            remedy = "put the same sign between all cells, those of the heading too"
            return InputError(place, f"{found} between cells", f"{expected}, as in the heading", remedy)
    if len(cells) != len(heads):
        remedy = "mend it, or put semicolons between cells where decimals have a comma" if sign == "," else "mend it"
        return InputError(place, f"{len(cells)} cells", f"{len(heads)}, as the heading has", remedy)
    name, cell = next((name, cell) for name, cell in zip(heads, cells, strict=True) if _number(cell, sign) is None)
    return InputError(f"{place}, {name}", quoted(cell), "a number", "correct it")


def _check(table: Mapping[str, list[float]], lines: list[int], path: Path) -> None:
    fault = fault_of_rows(table["pixel"], table["across_deg"], table.get("along_deg", []))
    if fault is not None:
        where = "" if fault.row is None else f", line {lines[fault.row]}, {fault.column}"
        raise _swapped(table, path) or InputError(f"{path}{where}", fault.found, fault.expected, fault.remedy)


def _swapped(table: Mapping[str, list[float]], path: Path) -> InputError | None:
    """What to tell of a table at fault whose angles count up as pixels do, and whose pixels do not."""
    pixel, across = table["pixel"], table["across_deg"]
    counts = [[float(k) for k in range(first, first + len(across))] for first in (0, 1)]
    if across not in counts or all(one.is_integer() for one in pixel):
        return None
    found, expected = f"{across[0]:g} to {across[-1]:g} in steps of 1 under across_deg", "pixels under pixel"
    return InputError(f"{path}, heading", found, expected, "columns are swapped: exchange the headings")

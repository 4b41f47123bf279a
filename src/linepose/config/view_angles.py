"""A camera's view angles, from the CSV that its platform's file names."""

import csv
from pathlib import Path
from typing import Any, Final

from linepose.errors import InputError

_REQUIRED: Final = ("pixel", "across_deg")
_COLUMNS: Final = (*_REQUIRED, "along_deg")
_INSTEAD: Final = ("focal_length_m", "field_of_view_deg", "principal_point_px")
_WHAT: Final = f"columns {', '.join(_REQUIRED)} and perhaps {_COLUMNS[2]}, by name"


def with_view_angles(values: dict[str, Any], platform: Path) -> dict[str, Any]:
    """A platform file's values, with the numbers of the file that `camera.view_angles` names, beside the platform's.

    Raises InputError for a file that is no such table, and for keys of the camera that the table stands in for.
    """
    camera = values.get("camera")
    if not isinstance(camera, dict) or camera.get("view_angles") is None:
        return values
    place = f"{platform}: camera"
    twice = [name for name in _INSTEAD if camera.get(name) is not None]
    if twice:
        raise InputError(place, f"view_angles with {', '.join(twice)}", "one of them", f"leave out {', '.join(twice)}")
    named = camera["view_angles"]
    if not isinstance(named, str):
        return values
    return values | {"camera": camera | {"view_angles": read_view_angles(platform.parent / named)}}


def read_view_angles(path: Path) -> dict[str, list[float]]:
    """Columns of a CSV: pixel, across_deg, and along_deg where it has it; lines that begin with # are passed over.

    Pixels that are numbered from 1 without a gap are counted from 0. Raises InputError.
    """
    try:
        lines = path.read_text(encoding="utf-8-sig").splitlines()
    except FileNotFoundError:
        raise InputError(str(path), "no such file", "a CSV of view angles", "correct camera.view_angles") from None
    except (OSError, UnicodeDecodeError):
        raise InputError(str(path), "no text", "a CSV of view angles", "correct camera.view_angles") from None
    rows = [(k, line) for k, line in enumerate(lines, 1) if line.strip() and not line.lstrip().startswith("#")]
    heads = [one.strip() for one in next(csv.reader([rows[0][1]]))] if rows else []
    unknown = [one for one in heads if one not in _COLUMNS]
    if unknown or not set(_REQUIRED) <= set(heads) or len(set(heads)) < len(heads):
        raise InputError(f"{path}, heading", ", ".join(heads) or "nothing", _WHAT, "name the columns")
    table: dict[str, list[float]] = {name: [] for name in heads}
    for k, line in rows[1:]:
        cells = next(csv.reader([line]))
        if len(cells) != len(heads):
            raise InputError(f"{path}, line {k}", f"{len(cells)} cells", f"{len(heads)}, as the heading has", "mend it")
        for name, cell in zip(heads, cells, strict=True):
            try:
                table[name].append(float(cell))
            except ValueError:
                raise InputError(f"{path}, line {k}, {name}", repr(cell), "a number", "correct it") from None
    pixels = table["pixel"]
    if pixels == [float(k) for k in range(1, len(pixels) + 1)]:
        table["pixel"] = [one - 1 for one in pixels]
    return table

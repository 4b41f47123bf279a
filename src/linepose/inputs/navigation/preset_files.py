"""What a file of a preset says of itself: the sign between its cells, its clock, columns that it leaves out."""

import logging
import re
from collections import Counter
from collections.abc import Callable, Sequence
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from linepose.errors import InputError
from linepose.inputs.navigation.presets import PRESETS

if TYPE_CHECKING:
    from linepose.inputs.navigation.table import TableSection

_HEAD_LINES: Final = 200
_ROWS_LOOKED_AT: Final = 20
_SIGNS: Final = (";", "\t", ",", " ")

log = logging.getLogger(__name__)


def as_written(path: Path, section: "TableSection") -> "TableSection":
    """The section with what a text file of its preset says of itself, where the keys are still those of the preset.

    Raises InputError where the file has a clock that is not known.
    """
    preset = PRESETS.get(section.preset or "")
    if preset is None or not path.is_file():
        return section
    head = _head(path, section.encoding)
    changes: dict[str, Any] = {}
    delimiter = _delimiter(head[-_ROWS_LOOKED_AT:], section.delimiter, section.decimal)
    if section.delimiter == preset.keys.get("delimiter", ",") and not section.widths and delimiter != section.delimiter:
        changes["delimiter"] = delimiter
    if preset.name in _SAID:
        changes |= _SAID[preset.name](path, head, section)
    return section.model_copy(update=changes) if changes else section


def without_absent_sigmas(section: "TableSection", names: Sequence[str]) -> "TableSection":
    """The section without the preset's standard deviations, where the file has the columns of none of them."""
    preset = PRESETS.get(section.preset or "")
    columns = section.columns
    if preset is None or columns.sigma_position is None or set(map(str, columns.of_sigmas())) & set(names):
        return section
    keys = preset.keys["columns"]
    mine = columns.sigma_position, columns.sigma_attitude
    if mine != (keys.get("sigma_position"), keys.get("sigma_attitude")):
        return section
    less = columns.model_copy(update={"sigma_position": None, "sigma_attitude": None})
    return section.model_copy(update={"columns": less})


def _head(path: Path, encoding: str) -> list[str]:
    """The first lines that are not blank."""
    try:
        with path.open(encoding="utf-8-sig" if encoding.lower() in {"utf-8", "utf8"} else encoding) as file:
            return [line.rstrip("\r\n") for line in islice(file, _HEAD_LINES) if line.strip()]
    except (UnicodeError, OSError):
        return []  # told where the file is read


def _delimiter(rows: Sequence[str], usual: str, decimal: str) -> str:
    """The sign between the cells of most rows: the usual one, unless another stands there."""
    signs = [sign for sign in _SIGNS if sign != decimal]
    first = [] if usual == " " or usual == decimal else [usual]
    found = Counter(next((sign for sign in first + signs if sign in row), usual) for row in rows)
    sign = max(found, key=lambda one: found[one]) if found else usual
    return usual if sign.isspace() and usual.isspace() and "\t" not in usual else sign


def _of_rtklib(path: Path, head: list[str], section: "TableSection") -> dict[str, Any]:
    """The clock of the times, which the heading names, and weeks with seconds in the place of dates."""
    comments = [line for line in head if line.startswith("%")]
    if any(re.search(r"height=\S*/geodetic", line) for line in comments):
        log.warning("%s: heights above the geoid; export them above the ellipsoid, or add the geoid's height", path)
    if section.time_scale != "gps_iso":
        return {}
    heading = next((line for line in comments if "latitude" in line), "").lstrip("% ")
    if heading.startswith("JST"):
        raise InputError(str(path), "times in JST", "GPST or UTC", "export the solution with times in UTC or GPST")
    if heading.startswith("UTC"):
        return {"time_scale": "iso"}
    row = next((line for line in head if not line.startswith("%")), "")
    if section.columns.time == ("1", "2") and re.match(r"\s*\d{4}\s+\d+\.\d+\s", row):
        columns = section.columns.model_copy(update={"time": "2", "week": "1"})
        return {"time_scale": "gps_week", "time_unit": "s", "columns": columns}
    return {}


def _of_inertial_explorer(path: Path, head: list[str], section: "TableSection") -> dict[str, Any]:  # noqa: ARG001
    """Seconds of the week alone, where the export has no column of the week."""
    heading = next((line for line in head if all(word in line for word in section.heading_words)), "")
    if not heading or section.columns.week != "Week" or re.search(r"\bWeek\b", heading):
        return {}
    return {"columns": section.columns.model_copy(update={"week": None})}


_SAID: Final[dict[str, Callable[[Path, list[str], "TableSection"], dict[str, Any]]]] = {
    "rtklib": _of_rtklib,
    "inertial_explorer": _of_inertial_explorer,
}

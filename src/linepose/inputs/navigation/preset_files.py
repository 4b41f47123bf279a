"""What a file of a preset says of itself: the sign between its cells, its clock, columns that it leaves out."""

import logging
import re
from collections import Counter
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from linepose.errors import InputError
from linepose.inputs.navigation.presets import PRESETS
from linepose.inputs.navigation.text_file import first_lines

if TYPE_CHECKING:
    from linepose.inputs.navigation.table import TableSection

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
    lines = _lines(path, section)
    rows = _rows(lines, section)[:_ROWS_LOOKED_AT]
    delimiter = _delimiter(rows, section.delimiter, section.decimal)
    if section.delimiter == preset.keys.get("delimiter", ",") and not section.widths and delimiter != section.delimiter:
        section = section.model_copy(update={"delimiter": delimiter})
    if preset.name not in _SAID:
        return section
    return section.model_copy(update=_SAID[preset.name](path, lines, rows, section))


def tell_heights(path: Path, section: "TableSection") -> None:
    """Tell where a solution of RTKLIB says that its heights are above the geoid."""
    if section.preset != "rtklib" or not path.is_file():
        return
    if any(line.startswith("%") and re.search(r"height=\S*/geodetic", line) for line in _lines(path, section)):
        log.warning("%s: heights above the geoid; export them above the ellipsoid, or add the geoid's height", path)


def without_absent_sigmas(path: Path, section: "TableSection", names: Sequence[str]) -> "TableSection":
    """The section without the preset's standard deviations, where a file has the columns of none of them; told."""
    preset = PRESETS.get(section.preset or "")
    columns = section.columns
    if preset is None or columns.sigma_position is None or set(map(str, columns.of_sigmas())) & set(names):
        return section
    keys = preset.keys["columns"]
    mine = columns.sigma_position, columns.sigma_attitude
    if mine != (keys.get("sigma_position"), keys.get("sigma_attitude")):
        return section
    told = "%s: has no standard deviations, which preset %s has in %s; where other columns hold them, set "
    told += "source.navigation.columns.sigma_position and sigma_attitude"
    log.warning(told, path, preset.name, ", ".join(map(str, columns.of_sigmas())))
    less = columns.model_copy(update={"sigma_position": None, "sigma_attitude": None})
    return section.model_copy(update={"columns": less})


def _lines(path: Path, section: "TableSection") -> list[str]:
    """The first lines; none of a file that is no text, which is told where it is read."""
    try:
        return first_lines(path, section.encoding)
    except (UnicodeError, OSError):
        return []


def _rows(lines: Sequence[str], section: "TableSection") -> list[str]:
    """The rows of values among these lines: what is below the heading and its units, and no comment."""

    def is_comment(line: str) -> bool:
        return section.comment is not None and line.lstrip().startswith(section.comment)

    below = [line for line in lines[section.skipped_lines :] if line.strip()]
    if section.heading:
        words = section.heading_words
        is_heading = (all(word in line for word in words) and (words or not is_comment(line)) for line in below)
        below = below[next((at + 1 for at, found in enumerate(is_heading) if found), 0) + section.unit_rows :]
    return [line for line in below if not is_comment(line)]


def _delimiter(rows: Sequence[str], usual: str, decimal: str) -> str:
    """The sign between the cells of most rows: the usual one, unless another stands there."""
    signs = [sign for sign in _SIGNS if sign != decimal]
    first = [] if usual == " " or usual == decimal else [usual]
    found = Counter(next((sign for sign in first + signs if sign in row), usual) for row in rows)
    sign = max(found, key=lambda one: found[one]) if found else usual
    return usual if sign.isspace() and usual.isspace() and "\t" not in usual else sign


def _of_rtklib(path: Path, lines: Sequence[str], rows: Sequence[str], section: "TableSection") -> dict[str, Any]:
    """The clock of the times, which the heading names; weeks with seconds in the place of dates; dates with times.

    Between date and time stands a blank whatever the sign between cells, between week and seconds that sign.
    """
    columns, clock = section.columns, section.time_scale
    if clock != "gps_iso":
        return {}
    heading = next((line for line in lines if line.startswith("%") and "latitude" in line), "").lstrip("% ")
    if heading.startswith("JST"):
        raise InputError(str(path), "times in JST", "GPST or UTC", "export the solution with times in UTC or GPST")
    said: dict[str, Any] = {"time_scale": "iso"} if heading.startswith("UTC") else {}
    row = rows[0].strip() if rows else ""
    if columns.time != PRESETS["rtklib"].keys["columns"]["time"]:
        return said
    if not said and re.match(r"\d{4}[\s,;]+\d+\.\d+[\s,;]", row):
        columns = columns.model_copy(update={"time": "2", "week": "1"})
        return {"time_scale": "gps_week", "time_unit": "s", "columns": columns}
    if not section.delimiter.isspace() and re.search(r"\d\s+\d", row.partition(section.delimiter)[0]):
        changes: dict[str, Any] = {"time": "1"}
        if columns.position == PRESETS["rtklib"].keys["columns"]["position"]:
            changes["position"] = ("2", "3", "4")
        return said | {"columns": columns.model_copy(update=changes)}
    return said


def _of_inertial_explorer(
    path: Path,  # noqa: ARG001
    lines: Sequence[str],
    rows: Sequence[str],  # noqa: ARG001
    section: "TableSection",
) -> dict[str, Any]:
    """Seconds of the week alone, where the export has no column of the week."""
    heading = next((line for line in lines if all(word in line for word in section.heading_words)), "")
    if not heading or section.columns.week != "Week" or re.search(r"\bWeek\b", heading):
        return {}
    return {"columns": section.columns.model_copy(update={"week": None})}


_SAID: Final[dict[str, Callable[[Path, Sequence[str], Sequence[str], "TableSection"], dict[str, Any]]]] = {
    "rtklib": _of_rtklib,
    "inertial_explorer": _of_inertial_explorer,
}

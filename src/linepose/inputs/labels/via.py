"""VGG Image Annotator 2 (VIA), a project or exported annotations: regions that are points, named by an attribute.

Annotations are exported as JSON or as CSV: a region a row, with the same mappings as JSON in its cells. What VIA 3
writes is recognised, to be told.
"""

import csv
import json
import re
from itertools import islice
from pathlib import Path
from typing import Any, Final

from linepose.errors import InputError, quoted
from linepose.inputs.labels.clicked import Clicked
from linepose.inputs.labels.format import LabelFormat, entries, tell_passed_over

_PROJECT: Final = "_via_img_metadata"
_PROJECT_3: Final = {"project", "attribute", "file", "metadata", "view"}  # keys of VIA 3
_HEAD_3: Final = re.compile(r"#\s*(Exported using VGG Image Annotator|CSV_HEADER\s*=\s*metadata_id\b)")
_REGION: Final = ("region_shape_attributes", "region_attributes")  # columns of CSV
_LABELS: Final = ("label", "name")  # attributes that are as good as a label


def recognises(content: Any) -> bool:
    """Whether a JSON's content is VIA's."""
    if not isinstance(content, dict):
        return False
    return _PROJECT in content or set(content) >= _PROJECT_3 or any("regions" in one for one in entries(content))


def read(path: Path, content: Any) -> list[Clicked]:
    """The points of one file, other regions passed over; raises InputError naming the region that cannot be used."""
    if set(content) >= _PROJECT_3:
        raise _of_version_3(path)
    clicked: list[Clicked] = []
    others = 0
    for picture in entries(content.get(_PROJECT, content)):
        name = str(picture.get("filename", ""))
        for number, region in enumerate(entries(picture.get("regions")), 1):
            shape = region.get("shape_attributes")
            if not isinstance(shape, dict) or shape.get("name") != "point":
                others += 1
                continue
            clicked.append(_point(shape, region.get("region_attributes"), name, f"{path}, {name}, region {number}"))
    tell_passed_over(path, {"regions that are no points": others})
    return clicked


def _point(shape: dict[str, Any], attributes: Any, picture: str, where: str) -> Clicked:
    try:
        x, y = float(shape["cx"]), float(shape["cy"])
    except (KeyError, TypeError, ValueError, OverflowError):
        raise InputError(where, f"cx={quoted(shape.get('cx'))}", "cx and cy in pixels", "draw it anew") from None
    given = [(str(name), _text(value)) for name, value in attributes.items()] if isinstance(attributes, dict) else []
    given = [(name, text) for name, text in given if text]
    label = next((text for wanted in _LABELS for name, text in given if name.lower() == wanted), "")
    return Clicked(label, x, y, picture, None, where, tuple(given))


def _text(value: Any) -> str:
    """An attribute's text: of a choice, the one that is ticked."""
    ticked = [str(name) for name, is_ticked in value.items() if is_ticked] if isinstance(value, dict) else [value]
    return str(ticked[0]).strip() if len(ticked) == 1 and ticked[0] is not None else ""


def recognises_head(head: Any) -> bool:
    """Whether one of the lines of a CSV up to its heading is VIA's heading."""
    return isinstance(head, tuple) and any(_is_heading(line) or _HEAD_3.match(line) for line in head)


def read_csv(path: Path, head: Any) -> list[Clicked]:
    """As `read`, of a CSV with these lines up to its heading; raises InputError naming the row that cannot be used."""
    place = next((number for number, line in enumerate(head) if _is_heading(line)), None)
    if place is None:
        raise _of_version_3(path)
    columns = _columns(head[place])
    pictures: dict[str, Any] = {}
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            below = islice(file, place + 1, None)
            rows = list(csv.reader(below))
    except (UnicodeDecodeError, csv.Error) as error:
        found = " ".join(str(error).split())
        raise InputError(str(path), found, "VIA's CSV in UTF-8", "export the annotations anew") from None
    for number, cells in enumerate(rows, place + 2):
        if not any(cells):
            continue
        if len(cells) != len(columns):
            found, expected = f"{len(cells)} cells", f"{len(columns)}, as the heading has"
            raise InputError(f"{path}, row {number}", found, expected, "export the annotations anew")
        row = dict(zip(columns, cells, strict=True))
        shape, attributes = (_mapping(row[name], f"{path}, row {number}, {name}") for name in _REGION)
        regions = pictures.setdefault(row["filename"], {"filename": row["filename"], "regions": []})["regions"]
        if shape:  # a picture without a region has a row of its own
            regions.append({"shape_attributes": shape, "region_attributes": attributes})
    return read(path, pictures)


def _of_version_3(path: Path) -> InputError:
    remedy = "draw the points in VIA 2, or label with another tool (docs/formats.md)"
    return InputError(str(path), "annotations of VIA 3", "those of VIA 2", remedy)


def _is_heading(line: str) -> bool:
    """Whether it has the columns of VIA 2, which may begin with #."""
    return {"filename", *_REGION} <= set(_columns(line))


def _columns(heading: str) -> list[str]:
    return [name.strip().lstrip("#") for name in next(csv.reader([heading]), [])]


def _mapping(cell: str, where: str) -> dict[str, Any]:
    try:
        value = json.loads(cell or "{}")
    except (ValueError, RecursionError):
        value = None
    if not isinstance(value, dict):
        raise InputError(where, quoted(cell), "a mapping as in JSON", "export the annotations anew")
    return value


VIA: Final = LabelFormat("VIA 2", ".json", recognises, read)
VIA_CSV: Final = LabelFormat("VIA 2", ".csv", recognises_head, read_csv)

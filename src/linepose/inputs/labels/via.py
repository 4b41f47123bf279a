"""VGG Image Annotator (VIA), a project or exported annotations: regions that are points, named by an attribute.

Annotations are exported as JSON or as CSV: a region a row, with the same mappings as JSON in its cells.
"""

import csv
import json
from pathlib import Path
from typing import Any, Final

from linepose.errors import InputError, quoted
from linepose.inputs.labels.clicked import Clicked
from linepose.inputs.labels.format import LabelFormat, entries, tell_passed_over

_PROJECT: Final = "_via_img_metadata"
_REGION: Final = ("region_shape_attributes", "region_attributes")  # columns of CSV
_LABELS: Final = ("label", "name")  # attributes that are as good as a label


def recognises(content: Any) -> bool:
    """Whether a JSON's content is VIA's."""
    return isinstance(content, dict) and (_PROJECT in content or any("regions" in one for one in entries(content)))


def read(path: Path, content: Any) -> list[Clicked]:
    """The points of one file, other regions passed over; raises InputError naming the region that cannot be used."""
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


def recognises_heading(heading: Any) -> bool:
    """Whether the first line of a CSV is that of VIA's."""
    return isinstance(heading, str) and {"filename", *_REGION} <= set(_columns(heading))


def read_csv(path: Path, heading: Any) -> list[Clicked]:
    """As `read`, of a CSV with this heading; raises InputError naming the row that cannot be used."""
    columns = _columns(heading)
    pictures: dict[str, Any] = {}
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            rows = list(csv.reader(file))[1:]
    except (UnicodeDecodeError, csv.Error) as error:
        found = " ".join(str(error).split())
        raise InputError(str(path), found, "VIA's CSV in UTF-8", "export the annotations anew") from None
    for number, cells in enumerate(rows, 2):
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


VIA: Final = LabelFormat("VIA", ".json", recognises, read)
VIA_CSV: Final = LabelFormat("VIA", ".csv", recognises_heading, read_csv)

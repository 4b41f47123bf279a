"""LabelMe's JSON files, one a picture: shapes of the type "point", their labels naming the point."""

import json
from pathlib import Path
from typing import Any

from linepose.errors import InputError
from linepose.inputs.labels.clicked import Clicked


def read_labelme(path: Path) -> list[Clicked]:
    """The points of one file; raises InputError where it is not LabelMe's, or has a shape that is no point."""
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except (json.JSONDecodeError, UnicodeDecodeError) as error:
        raise InputError(str(path), str(error), "LabelMe's JSON", "restore the file") from None
    if not isinstance(content, dict) or not isinstance(content.get("shapes"), list):
        remedy = "save the labels with LabelMe, or correct source.labels"
        raise InputError(str(path), "JSON without shapes", "LabelMe's JSON", remedy)
    picture, width = content.get("imagePath") or path.name, content.get("imageWidth")
    return [
        _point(shape, f"{path}, shape {number}", picture, width) for number, shape in enumerate(content["shapes"], 1)
    ]


def _point(shape: Any, where: str, picture: str, width: int | None) -> Clicked:
    kind = shape.get("shape_type") if isinstance(shape, dict) else None
    if kind != "point":
        raise InputError(where, f"a shape of type {kind!r}", "a point", "draw it as a point, or remove it")
    try:
        (x, y), *rest = shape["points"]
        clicked = Clicked(str(shape["label"]), float(x), float(y), picture, width, where)
    except (KeyError, TypeError, ValueError):
        rest = [None]
    if rest:
        raise InputError(where, "no label with one place", "a label and a place [x, y]", "draw the point anew")
    return clicked

"""LabelMe's JSON files, one a picture: shapes of the type "point", their group_id or label naming the point."""

import json
import logging
from pathlib import Path
from typing import Any

from linepose.errors import InputError
from linepose.inputs.labels.clicked import Clicked

log = logging.getLogger(__name__)


def read_labelme(path: Path) -> list[Clicked]:
    """The points of one file, other shapes passed over; raises InputError where it is not LabelMe's."""
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except (json.JSONDecodeError, UnicodeDecodeError) as error:
        raise InputError(str(path), str(error), "LabelMe's JSON", "restore the file") from None
    if not isinstance(content, dict) or not isinstance(content.get("shapes"), list):
        remedy = "save the labels with LabelMe, or correct source.labels"
        raise InputError(str(path), "JSON without shapes", "LabelMe's JSON", remedy)
    picture, width = content.get("imagePath") or path.name, content.get("imageWidth")
    shapes = list(enumerate(content["shapes"], 1))
    points = [(number, one) for number, one in shapes if isinstance(one, dict) and one.get("shape_type") == "point"]
    if len(shapes) > len(points):
        log.warning("%s: passed over: %d shapes that are no points", path, len(shapes) - len(points))
    return [_point(shape, f"{path}, shape {number}", picture, width) for number, shape in points]


def _point(shape: dict[str, Any], where: str, picture: str, width: int | None) -> Clicked:
    group = shape.get("group_id")
    given = () if group is None else (("group_id", str(group)),)
    try:
        (x, y), *rest = shape["points"]
        clicked = Clicked(str(shape["label"]), float(x), float(y), picture, width, where, given)
    except (KeyError, TypeError, ValueError):
        rest = [None]
    if rest:
        raise InputError(where, "no label with one place", "a label and a place [x, y]", "draw the point anew")
    return clicked

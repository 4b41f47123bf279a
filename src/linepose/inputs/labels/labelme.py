"""LabelMe's JSON files, one a picture: shapes of the type "point", their group_id or label naming the point."""

from pathlib import Path
from typing import Any, Final

from linepose.errors import InputError
from linepose.inputs.labels.clicked import Clicked
from linepose.inputs.labels.format import LabelFormat, tell_passed_over


def recognises(content: Any) -> bool:
    """Whether a JSON's content is LabelMe's."""
    return isinstance(content, dict) and isinstance(content.get("shapes"), list)


def read(path: Path, content: Any) -> list[Clicked]:
    """The points of one file, other shapes passed over."""
    picture, size = str(content.get("imagePath") or path.name), (content.get("imageWidth"), content.get("imageHeight"))
    shapes = list(enumerate(content["shapes"], 1))
    points = [(number, one) for number, one in shapes if isinstance(one, dict) and one.get("shape_type") == "point"]
    tell_passed_over(path, {"shapes that are no points": len(shapes) - len(points)})
    return [_point(shape, f"{path}, shape {number}", picture, size) for number, shape in points]


def _point(shape: dict[str, Any], where: str, picture: str, size: tuple[int | None, int | None]) -> Clicked:
    group = shape.get("group_id")
    given = () if group is None else (("group_id", str(group)),)
    try:
        (x, y), *rest = shape["points"]
        if not all(type(one) in (int, float) for one in (x, y)):
            raise TypeError
        clicked = Clicked(str(shape["label"]), float(x), float(y), picture, size[0], where, given, size[1])
    except (KeyError, TypeError, ValueError, OverflowError):
        rest = [None]
    if rest:
        raise InputError(where, "no label with one place", "a label and a place [x, y]", "draw the point anew")
    return clicked


LABELME: Final = LabelFormat("LabelMe", ".json", recognises, read)

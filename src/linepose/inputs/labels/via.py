"""VGG Image Annotator (VIA) 2, a project or exported annotations: regions that are points, named by an attribute."""

from pathlib import Path
from typing import Any, Final

from linepose.errors import InputError, quoted
from linepose.inputs.labels.clicked import Clicked
from linepose.inputs.labels.format import LabelFormat, entries, tell_passed_over

_PROJECT: Final = "_via_img_metadata"
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


VIA: Final = LabelFormat("VIA", ".json", recognises, read)

"""CVAT's XML for images 1.1: elements `points` with one place each, alone or in skeletons.

The attribute `id` (or `point`, `point_id`), or the label, names the point. Points that are marked as outside the
picture, of which CVAT keeps the last place, are no labels.
"""

from collections.abc import Iterator
from pathlib import Path
from typing import Final
from xml.etree import ElementTree

from linepose.errors import InputError
from linepose.inputs.labels.clicked import Clicked
from linepose.inputs.labels.format import LabelFormat, tell_passed_over
from linepose.inputs.number_files import plain_float, plain_whole

_HELPERS: Final = {"box", "polygon", "polyline", "mask", "ellipse", "cuboid"}


def read(path: Path, _: object = None) -> list[Clicked]:
    """The points of one file; raises InputError where it is not CVAT's."""
    try:
        root = ElementTree.parse(path).getroot()
    except (ElementTree.ParseError, LookupError, ValueError, OSError) as error:
        raise InputError(str(path), str(error) or "a broken file", "CVAT's XML", "restore the file") from None
    if root.tag != "annotations":
        expected, remedy = "CVAT for images 1.1: <annotations>", "export the task in that format"
        raise InputError(str(path), f"an element <{root.tag}>", expected, remedy)
    if root.find("track") is not None:
        expected, remedy = "CVAT for images 1.1: <image>", "export the task in that format"
        raise InputError(str(path), "an element <track>, as of a video", expected, remedy)
    shapes = [(image, shape) for image in root.iter("image") for shape in _shapes(image)]
    seen = [(image, shape) for image, shape in shapes if not _is_outside(shape)]
    points = [(image, shape) for image, shape in seen if shape.tag == "points"]
    outside, others = len(shapes) - len(seen), len(seen) - len(points)
    tell_passed_over(path, {"shapes outside their pictures": outside, "shapes that are no points": others})
    place = {shape: number for image in root.iter("image") for number, shape in enumerate(image.iter("points"), 1)}
    return [
        _point(shape, f"{path}, image {image.get('name')}, points {place[shape]}", image) for image, shape in points
    ]


def _shapes(image: ElementTree.Element) -> Iterator[ElementTree.Element]:
    """Shapes of one picture; of a skeleton its points, or the whole of it where that is outside."""
    for shape in image:
        if shape.tag == "skeleton" and not _is_outside(shape):
            yield from _shapes(shape)
        elif shape.tag in {"points", "skeleton", *_HELPERS}:
            yield shape


def _is_outside(shape: ElementTree.Element) -> bool:
    return shape.get("outside", "0").strip().lower() in {"1", "true"}


def _point(element: ElementTree.Element, where: str, image: ElementTree.Element) -> Clicked:
    places = element.get("points", "").split(";")
    try:
        x, y = (plain_float(word) for word in places[0].split(","))
        width, height = (plain_whole(image.attrib[one]) if one in image.attrib else None for one in ("width", "height"))
    except ValueError:
        raise InputError(where, f"points={element.get('points')!r}", "x,y", "draw the point anew") from None
    if len(places) > 1:
        remedy = "draw each point as a shape of its own"
        raise InputError(where, f"{len(places)} places in one shape", "one", remedy)
    given = _attributes(element)
    return Clicked(element.get("label", ""), x, y, image.get("name", ""), width, where, given, height)


def _attributes(element: ElementTree.Element) -> tuple[tuple[str, str], ...]:
    """The attributes that are filled in."""
    named = ((one.get("name", ""), (one.text or "").strip()) for one in element.iter("attribute"))
    return tuple((name, text) for name, text in named if text)


CVAT: Final = LabelFormat("CVAT", ".xml", lambda _: True, read)

"""CVAT's XML for images 1.1: elements `points` with one place each; the label, or an attribute, names the point."""

from pathlib import Path
from xml.etree import ElementTree

from linepose.errors import InputError
from linepose.inputs.labels.clicked import Clicked


def read_cvat(path: Path) -> list[Clicked]:
    """The points of one file; raises InputError where it is not CVAT's."""
    try:
        root = ElementTree.parse(path).getroot()
    except ElementTree.ParseError as error:
        raise InputError(str(path), str(error), "CVAT's XML", "restore the file") from None
    if root.tag != "annotations":
        expected, remedy = "CVAT for images 1.1: <annotations>", "export the task in that format"
        raise InputError(str(path), f"an element <{root.tag}>", expected, remedy)
    if root.find("track") is not None:
        expected, remedy = "CVAT for images 1.1: <image>", "export the task in that format"
        raise InputError(str(path), "an element <track>, as of a video", expected, remedy)
    return [
        _point(element, f"{path}, image {image.get('name')}, points {number}", image)
        for image in root.iter("image")
        for number, element in enumerate(image.iter("points"), 1)
    ]


def _point(element: ElementTree.Element, where: str, image: ElementTree.Element) -> Clicked:
    places = element.get("points", "").split(";")
    try:
        x, y = (float(word) for word in places[0].split(","))
        width = int(image.attrib["width"]) if "width" in image.attrib else None
    except ValueError:
        raise InputError(where, f"points={element.get('points')!r}", "x,y", "draw the point anew") from None
    if len(places) > 1:
        remedy = "draw each point as a shape of its own"
        raise InputError(where, f"{len(places)} places in one shape", "one", remedy)
    return Clicked(_text(element), x, y, image.get("name", ""), width, where)


def _text(element: ElementTree.Element) -> str:
    """The label where it has a number, else the first attribute that has one."""
    texts = [element.get("label", ""), *(attribute.text or "" for attribute in element.iter("attribute"))]
    return next((text for text in texts if any(letter.isdigit() for letter in text)), texts[0])

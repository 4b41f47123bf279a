"""COCO keypoints: JSON of images, categories and annotations; the keypoint's name in its category names the point.

Keypoints of visibility 0 were not labelled. Annotations without keypoints, such as boxes, are passed over.
"""

from pathlib import Path
from typing import Any, Final

from linepose.errors import InputError, quoted
from linepose.inputs.labels.clicked import Clicked
from linepose.inputs.labels.format import LabelFormat, entries, tell_passed_over

_NUMBERS: Final = 3  # of a keypoint: x, y, visibility


def recognises(content: Any) -> bool:
    """Whether a JSON's content is COCO's."""
    return isinstance(content, dict) and all(isinstance(content.get(key), list) for key in ("images", "annotations"))


def read(path: Path, content: Any) -> list[Clicked]:
    """The keypoints of one file; raises InputError naming the annotation that cannot be used."""
    images = {str(one.get("id")): one for one in entries(content["images"])}
    names = {str(one.get("id")): one.get("keypoints") for one in entries(content.get("categories"))}
    clicked: list[Clicked] = []
    unlabelled = others = 0
    for number, one in enumerate(entries(content["annotations"]), 1):
        where = f"{path}, annotation {one.get('id', number)}"
        if not one.get("keypoints"):
            others += 1
            continue
        image = images.get(str(one.get("image_id")))
        if image is None or not isinstance(image.get("file_name"), str):
            found = f"image_id {quoted(one.get('image_id'))}"
            raise InputError(where, found, "the id of an image with a file_name", "restore the file")
        rows = _keypoints(one["keypoints"], names.get(str(one.get("category_id"))), where)
        seen = [row for row in rows if row[3] > 0]
        unlabelled += len(rows) - len(seen)
        width, height = (image.get(one) if isinstance(image.get(one), int) else None for one in ("width", "height"))
        picture = image["file_name"]
        clicked += [Clicked(name, x, y, picture, width, f"{where}, {name}", height=height) for name, x, y, _ in seen]
    tell_passed_over(path, {"keypoints of visibility 0": unlabelled, "annotations without keypoints": others})
    return clicked


def _keypoints(values: Any, names: Any, where: str) -> list[tuple[str, float, float, float]]:
    """Name, place and visibility of each keypoint."""
    try:
        numbers = [float(value) for value in values]
    except (TypeError, ValueError, OverflowError):
        raise InputError(where, "keypoints that are no numbers", "x, y, visibility of each", "restore it") from None
    if not isinstance(names, list) or len(numbers) != _NUMBERS * len(names):
        count = len(names) if isinstance(names, list) else 0
        found = f"{len(numbers)} numbers for {count} keypoints of its category"
        raise InputError(where, found, "x, y, visibility of each", "name the keypoints in the category")
    return [
        (str(name), *numbers[_NUMBERS * k : _NUMBERS * (k + 1)])  # type: ignore[misc]
        for k, name in enumerate(names)
    ]


COCO: Final = LabelFormat("COCO keypoints", ".json", recognises, read)

"""Label Studio's export, JSON or JSON-MIN: keypoints in percent of the picture, one task a picture.

The keypoint's label names the point, or what stands beside it in the same region under the name of its control (a text,
a number, a choice). Other regions, and annotations that were cancelled, are passed over.
"""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final
from urllib.parse import unquote

from linepose.errors import InputError, quoted
from linepose.inputs.labels.clicked import Clicked
from linepose.inputs.labels.format import LabelFormat, entries, tell_passed_over

_LABELS: Final = ("keypointlabels", "labels")
_VALUES: Final = ("text", "number", "choices", "rating")  # of a control beside the keypoint
_UPLOADED: Final = re.compile(r"[0-9a-f]{8}-(?=.)")  # what Label Studio writes before a picture's name
_PICTURES: Final = {".png", ".jpg", ".jpeg", ".tif", ".tiff", ".bmp", ".gif", ".webp"}  # that a browser or a scan has
_PER_CENT: Final = 100.0


def recognises(content: Any) -> bool:
    """Whether a JSON's content is Label Studio's: a list of tasks."""
    return isinstance(content, list) and any(
        isinstance(one, dict) and ("annotations" in one or any(_of_minimum(one))) for one in content
    )


def read(path: Path, content: Any) -> list[Clicked]:
    """The keypoints of one file; raises InputError naming the task that cannot be used."""
    clicked: list[Clicked] = []
    others = cancelled = 0
    for number, task in enumerate(entries(content), 1):
        where, picture = f"{path}, task {task.get('id', number)}", _picture(task)
        annotations = entries(task.get("annotations", [{"result": list(_of_minimum(task))}]))
        kept = [one for one in annotations if not one.get("was_cancelled")]
        cancelled += len(annotations) - len(kept)
        for one in kept:
            regions = _regions(entries(one.get("result")))
            points = [region for region in regions if _is_point(region)]
            others += len(regions) - len(points)
            clicked += [_point(region, picture, where) for region in points]
    tell_passed_over(path, {"regions that are no keypoints": others, "cancelled annotations": cancelled})
    return clicked


def _of_minimum(task: dict[str, Any]) -> Iterator[dict[str, Any]]:
    """The results of a task in the short form, where each has its values beside its size."""
    for name, value in task.items():
        for one in value if isinstance(value, list) else ():
            if isinstance(one, dict) and "original_width" in one:
                yield {**one, "value": one, "from_name": name, "type": "keypointlabels" if _LABELS[0] in one else ""}


def _regions(results: list[dict[str, Any]]) -> list[list[dict[str, Any]]]:
    """Results by region: those that have one id."""
    regions: dict[Any, list[dict[str, Any]]] = {}
    drawn = {str(result.get("id", number)) for number, result in enumerate(results) if "original_width" in result}
    for number, result in enumerate(results):
        if str(result.get("id", number)) in drawn:
            regions.setdefault(str(result.get("id", number)), []).append(result)
    return list(regions.values())


def _is_point(region: list[dict[str, Any]]) -> bool:
    return any(str(one.get("type")) in ("keypoint", "keypointlabels") for one in region)


def _point(region: list[dict[str, Any]], picture: str, where: str) -> Clicked:
    where = f"{where}, region {region[0].get('id', '')}".removesuffix(", region ")
    values = [one["value"] for one in region if isinstance(one.get("value"), dict)]
    try:
        place = next(value for value in values if "x" in value)
        sized = next(one for one in region if "original_width" in one)
        width, height = (int(sized[f"original_{side}"]) for side in ("width", "height"))
        x, y = float(place["x"]) / _PER_CENT * width, float(place["y"]) / _PER_CENT * height
    except (StopIteration, KeyError, TypeError, ValueError, OverflowError):
        raise InputError(where, "no place", "x and y in percent, original_width and _height", "draw it anew") from None
    if region[0].get("image_rotation"):
        found = f"a picture turned by {quoted(region[0]['image_rotation'])} deg"
        raise InputError(where, found, "one that is not turned", "label the scan's own pixels")
    labels = [text for value in values for key in _LABELS for text in _texts(value.get(key))]
    given = [
        (str(one.get("from_name")), text)
        for one in region
        if isinstance(one.get("value"), dict)
        for key in _VALUES
        for text in _texts(one["value"].get(key))
    ]
    return Clicked(next(iter(labels), ""), x, y, picture, width, where, tuple(given), height)


def _texts(value: Any) -> list[str]:
    return [str(one) for one in value] if isinstance(value, list) else [] if value is None else [str(value)]


def _picture(task: dict[str, Any]) -> str:
    """Name of a task's picture: of the first address of a picture, else of a text that may be one; empty without."""
    data = task.get("data") if isinstance(task.get("data"), dict) else task
    texts = [text for text in (task.get("file_upload"), *data.values()) if isinstance(text, str)]  # type: ignore[union-attr]
    names = {text: _file_name(text) for text in sorted(texts, key=lambda text: "/" not in text)}
    pictures = [name for name in names.values() if Path(name).suffix.lower() in _PICTURES]
    others = [name for text, name in names.items() if "." in text]
    return next(iter(pictures or others), "")


def _file_name(address: str) -> str:
    """Name of the file at an address, without the keys of a store and what an upload has put before it."""
    address = address.rsplit("?d=", 1)[-1]  # of a file on the server itself
    name = Path(unquote(address.partition("?")[0]).replace("\\", "/")).name
    return _UPLOADED.sub("", name, count=1) if _UPLOADED.match(name) else name


LABEL_STUDIO: Final = LabelFormat("Label Studio", ".json", recognises, read)

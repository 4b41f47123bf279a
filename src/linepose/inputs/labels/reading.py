"""Reading labels by the ending of their files, and of JSON and CSV by what is in it.

Inside, u_px and line are whole numbers at the centres of pixels and lines. The tools count from the picture's upper
left corner, so that the first pixel's centre is at 0.5: half a pixel is subtracted from their coordinates.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from linepose.errors import InputError
from linepose.inputs.labels.clicked import Clicked, labels_of
from linepose.inputs.labels.format import LabelFormat, read_head, read_json
from linepose.inputs.labels.labels import HEADING, is_own, read_labels
from linepose.inputs.labels.registry import FORMATS
from linepose.inputs.patterns import matching


def read_point_labels(
    folder: Path, pattern: str, scans: Mapping[int, Path], n_pixels: int, point_id: str | None = None
) -> pd.DataFrame:
    """Labels observation, point, u_px, line, ordered by the first two, of a file or a pattern of files in `folder`.

    `scans` are the scan files by observation; tools name the picture of a scan by the scan's own name.
    `point_id` is the place of the points' names, see `point_of`. Raises InputError naming the file and the label that
    has no scan, no name, or is given twice.
    """
    paths = matching(folder, pattern)
    if Path(pattern).suffix.lower() == ".csv" and not any(path.is_file() and _format_of(path)[0] for path in paths):
        return read_labels(_own(folder / pattern, paths), list(scans))
    if not paths:
        remedy = "restore it, correct source.labels, or set source.points: detection"
        raise InputError(str(folder / pattern), "no such file", "approximate labels", remedy)
    clicked: list[Clicked] = []
    for path in paths:
        clicked += _read(path)
    if not clicked:
        raise InputError(str(paths[0]), "no label", "the points that are seen in each scan", "label the scans")
    return labels_of(clicked, scans, n_pixels, point_id)


def _own(named: Path, paths: Sequence[Path]) -> Path:
    """The one file in our own layout; raises InputError where a pattern is of several."""
    if len(paths) > 1:
        found, remedy = f"{len(paths)} files, as {paths[0].name} and {paths[1].name}", "put the rows into one file"
        raise InputError(str(named), found, f"one CSV of labels ({HEADING})", remedy)
    return paths[0] if paths else named


def _read(path: Path) -> list[Clicked]:
    """The labels of one file, in whichever format it is."""
    one, content = _format_of(path)
    if one is not None:
        return one.read(path, content)
    suffix = path.suffix.lower()
    formats = [one for one in FORMATS if one.suffix == suffix]
    if not formats:
        expected = f"one of {', '.join(sorted({'.csv', *(one.suffix for one in FORMATS)}))}"
        raise InputError(str(path), f"file type {path.suffix!r}", expected, "export the labels in one of these")
    if is_own(content):
        found, expected = f"a CSV of our own ({HEADING}) beside one of a tool", "labels in one of the two layouts"
        raise InputError(str(path), found, expected, "name the files of one of them alone in source.labels")
    tools = ", ".join(dict.fromkeys(one.tool for one in formats))
    remedy = "export the labels in one of these, or correct source.labels"
    found = f"{suffix[1:].upper()} of another kind"
    raise InputError(str(path), found, f"that of one of {tools}", remedy)


def _format_of(path: Path) -> tuple[LabelFormat | None, Any]:
    """The format that a file is in, None where it is in none, and its content as the format takes it."""
    suffix = path.suffix.lower()
    content = read_json(path) if suffix == ".json" else read_head(path) if suffix == ".csv" else None
    formats = [one for one in FORMATS if one.suffix == suffix and one.recognises(content)]
    return (formats[0] if formats else None), content

"""Reading labels by the ending of their files.

Inside, u_px and line are whole numbers at the centres of pixels and lines. LabelMe and CVAT count from the picture's
upper left corner, so that the first pixel's centre is at 0.5: half a pixel is subtracted from their coordinates.
"""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Final

import pandas as pd

from linepose.errors import InputError
from linepose.inputs.labels.clicked import Clicked, labels_of
from linepose.inputs.labels.cvat import read_cvat
from linepose.inputs.labels.labelme import read_labelme
from linepose.inputs.labels.labels import read_labels

_TOOLS: Final[dict[str, Callable[[Path], list[Clicked]]]] = {".json": read_labelme, ".xml": read_cvat}


def read_point_labels(
    folder: Path, pattern: str, scans: Mapping[int, Path], n_pixels: int, point_id: str | None = None
) -> pd.DataFrame:
    """Labels observation, point, u_px, line, ordered by the first two, of a file or a pattern of files in `folder`.

    `scans` are the scan files by observation; LabelMe and CVAT name the picture of a scan by the scan's own name.
    `point_id` is the place of the points' names, see `point_of`. Raises InputError naming the file and the label that
    has no scan, no name, or is given twice.
    """
    if Path(pattern).suffix.lower() == ".csv":
        return read_labels(folder / pattern, list(scans))
    paths = sorted(folder.glob(pattern))
    if not paths:
        remedy = "restore it, correct source.labels, or set source.points: detection"
        raise InputError(str(folder / pattern), "no such file", "approximate labels", remedy)
    clicked: list[Clicked] = []
    for path in paths:
        tool = _TOOLS.get(path.suffix.lower())
        if tool is None:
            expected = f"one of .csv, {', '.join(_TOOLS)}"
            raise InputError(str(path), f"file type {path.suffix!r}", expected, "export the labels in one of these")
        clicked += tool(path)
    if not clicked:
        raise InputError(str(paths[0]), "no label", "the points that are seen in each scan", "label the scans")
    return labels_of(clicked, scans, n_pixels, point_id)

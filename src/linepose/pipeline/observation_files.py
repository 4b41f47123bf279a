"""Which file an observation was recorded in, for messages."""

import csv
from pathlib import Path, PurePosixPath

from linepose.config.platform import Platform
from linepose.inputs.source import LabelledViewsSection


def observation_in_words(platform: Platform, sums: Path, number: int) -> str:
    """An observation by its number, counted from 1, and by its file where the list `sums` of a data set's files has it.

    The file is that of the labelled view, or the scan: "observation 8 (labelled_points/view008.csv)".
    """
    source, name = platform.source, f"observation {number}"
    views = source.views if isinstance(source, LabelledViewsSection) else source.scans
    first, step = (source.first, source.step) if isinstance(source, LabelledViewsSection) else (1, 1)
    if not sums.is_file():
        return name
    with sums.open(encoding="utf-8", newline="") as file:
        listed = [PurePosixPath(row["file"]) for row in csv.DictReader(file)]
    depth = len(PurePosixPath(views).parts)
    found = sorted(path for path in listed if len(path.parts) == depth and path.match(views))[first - 1 :: step]
    return f"{name} ({found[number - 1]})" if number <= len(found) else name

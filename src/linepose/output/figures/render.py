"""All figures of a platform on disk, with an index that says what each shows or why it was left out."""

from collections.abc import Sequence
from pathlib import Path

import pandas as pd

from linepose.errors import LineposeError
from linepose.output.figures.entry import FigureEntry
from linepose.output.figures.registry import FIGURES
from linepose.output.figures.style import save
from linepose.pipeline.calibration import Calibration


def render_figures(
    calibration: Calibration, folder: Path, entries: Sequence[FigureEntry] | None = None
) -> pd.DataFrame:
    """Draw figures, by default all of the registry, into a folder, PNG and PDF; one row a figure, drawn or left out.

    Columns as in `FIGURES`: where `left_out` has a sentence there is no file.
    """
    return pd.DataFrame([_render(entry, calibration, folder) for entry in entries or FIGURES])


def _render(entry: FigureEntry, calibration: Calibration, folder: Path) -> dict[str, str]:
    caption, left_out = "", entry.left_out(calibration.platform_file)
    if not left_out:
        try:
            caption = entry.caption(calibration)
            save(entry.draw(calibration), folder / entry.name)
        except LineposeError as error:
            caption, left_out = "", f"This figure could not be drawn. {error}."
    return {
        "figure": entry.name,
        "title": entry.title,
        "caption": caption,
        "alt": f"{calibration.name}: {entry.shows}.",
        "left_out": left_out,
    }

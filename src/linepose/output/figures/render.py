"""All figures of a platform on disk, with an index that says what each shows or why it was left out."""

from pathlib import Path

import pandas as pd

from linepose.errors import LineposeError
from linepose.output.figures.catalogue import FIGURES
from linepose.output.figures.entry import CatalogueEntry
from linepose.output.figures.results import PlatformResults
from linepose.output.figures.style import save


def render_figures(results: PlatformResults, folder: Path) -> pd.DataFrame:
    """Draw every figure of the catalogue into a folder, PNG and PDF; one row a figure, drawn or left out.

    Columns as in `FIGURES`: where `left_out` has a sentence there is no file.
    """
    return pd.DataFrame([_render(entry, results, folder) for entry in FIGURES])


def _render(entry: CatalogueEntry, results: PlatformResults, folder: Path) -> dict[str, str]:
    caption, left_out = "", entry.left_out(results.platform)
    if not left_out:
        try:
            caption = entry.caption(results)
            save(entry.draw(results), folder / entry.name)
        except LineposeError as error:
            caption, left_out = "", f"This figure could not be drawn. {error}."
    return {
        "figure": entry.name,
        "title": entry.title,
        "paper_figure": entry.paper_figure,
        "caption": caption,
        "alt": f"{results.name}: {entry.shows}.",
        "left_out": left_out,
    }

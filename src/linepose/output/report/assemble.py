"""A platform's part of the page from its folder of results."""

from collections.abc import Mapping
from typing import Any

from linepose.output.figures.entry import FIGURES
from linepose.output.figures.results import PlatformResults
from linepose.output.report.page import PlatformOnPage, figures_on_page
from linepose.output.report.platform_sections import platform_sections
from linepose.output.report.provenance import settings_text
from linepose.pipeline.summary import summarise
from linepose.tables import read_table


def platform_on_page(results: PlatformResults, settings: Mapping[str, Any]) -> PlatformOnPage:
    """Summary, sections and drawn figures of a platform, with the settings of its file."""
    folder = results.folder / "figures"
    index = read_table(folder / "index.parquet", FIGURES)
    figures = figures_on_page(results.name, folder, index)
    return PlatformOnPage(summarise(results), platform_sections(results), figures, settings_text(settings))

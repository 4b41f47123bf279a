"""A platform's part of the page from its folder of results."""

from collections.abc import Mapping
from typing import Any

from linepose.output.figures.entry import FIGURES
from linepose.output.report.page import PlatformOnPage, figures_on_page
from linepose.output.report.platform_sections import leading_sections, platform_sections
from linepose.output.report.provenance import settings_text
from linepose.pipeline.calibration import Calibration
from linepose.pipeline.summary import summarise
from linepose.tables import read_table


def platform_on_page(calibration: Calibration, settings: Mapping[str, Any]) -> PlatformOnPage:
    """Summary, sections and drawn figures of a platform, with the settings of its file."""
    index = calibration.results.path("figures/index")
    figures = figures_on_page(calibration.name, index.parent, read_table(index, FIGURES))
    return PlatformOnPage(
        summarise(calibration),
        leading_sections(calibration),
        platform_sections(calibration),
        figures,
        settings_text(settings),
    )

"""The sections of a platform's part of the page, in their order: those that lead it, and those after its pose."""

from collections.abc import Callable
from typing import Final

from linepose.output.adjusted import is_adjusted
from linepose.output.report.adjustment import adjustment_section
from linepose.output.report.clocks import clocks_section
from linepose.output.report.data_or_prior import prior_weight_section
from linepose.output.report.on_the_map import map_section
from linepose.output.report.sections import SectionOnPage
from linepose.output.report.sensitivity import influence_section
from linepose.pipeline.calibration import Calibration

_SECTIONS: Final[tuple[Callable[[Calibration], SectionOnPage | None], ...]] = (
    prior_weight_section,
    influence_section,
    clocks_section,
    map_section,
)


def leading_sections(calibration: Calibration) -> list[SectionOnPage]:
    """What stands before the pose: an adjustment beside the noise model that the rest of the page is of."""
    if is_adjusted(calibration.platform_file):
        return []
    return _made([adjustment_section], calibration)


def platform_sections(calibration: Calibration) -> list[SectionOnPage]:
    """Every section after the pose for which the platform has results."""
    first = [adjustment_section] if is_adjusted(calibration.platform_file) else []
    return _made([*first, *_SECTIONS], calibration)


def _made(makers: list[Callable[[Calibration], SectionOnPage | None]], calibration: Calibration) -> list[SectionOnPage]:
    return [section for make in makers if (section := make(calibration)) is not None]

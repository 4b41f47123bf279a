"""The sections of a platform's part of the page that stand between its pose and its figures, in their order."""

from collections.abc import Callable
from typing import Final

from linepose.output.report.clocks import clocks_section
from linepose.output.report.data_or_prior import decided_section
from linepose.output.report.sections import SectionOnPage
from linepose.output.report.sensitivity import dependence_section
from linepose.pipeline.calibration import Calibration

_SECTIONS: Final[tuple[Callable[[Calibration], SectionOnPage | None], ...]] = (
    decided_section,
    dependence_section,
    clocks_section,
)


def platform_sections(calibration: Calibration) -> list[SectionOnPage]:
    """Every section for which the platform has results."""
    return [section for make in _SECTIONS if (section := make(calibration)) is not None]

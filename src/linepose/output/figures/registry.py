"""Every figure of a platform, in the order of the page: one entry each."""

from typing import Final

from linepose.output.figures import (
    basin,
    corner_plot,
    identifiability,
    mapping,
    outlier_matrix,
    platform_sketch,
    repeatability,
    residuals,
    rotation_axis,
    scan,
    survey_plan,
    trace,
    uncertainty,
)
from linepose.output.figures.entry import FigureEntry

FIGURES: Final[tuple[FigureEntry, ...]] = (
    *survey_plan.FIGURES,
    *scan.FIGURES,
    *outlier_matrix.FIGURES,
    *uncertainty.FIGURES,
    *corner_plot.FIGURES,
    *rotation_axis.FIGURES,
    *platform_sketch.FIGURES,
    *mapping.FIGURES,
    *basin.FIGURES,
    *trace.FIGURES,
    *residuals.FIGURES,
    *repeatability.FIGURES,
    *identifiability.FIGURES,
)

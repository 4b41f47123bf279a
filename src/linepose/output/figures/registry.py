"""Every figure of a platform, in the order of the page: one entry each."""

from typing import Final

from linepose.output.figures import (
    basin,
    corner_plot,
    corrections,
    estimates,
    halves,
    identifiability,
    levels,
    mapping,
    normalised_residuals,
    outlier_matrix,
    platform_sketch,
    repeatability,
    residuals,
    rotation_axis,
    scan,
    strip_fit,
    survey_plan,
    trace,
    uncertainty,
    weights,
)
from linepose.output.figures.entry import FigureEntry

FIGURES: Final[tuple[FigureEntry, ...]] = (
    *estimates.FIGURES,
    *halves.FIGURES,
    *levels.FIGURES,
    *corrections.FIGURES,
    *weights.FIGURES,
    *normalised_residuals.FIGURES,
    *survey_plan.FIGURES,
    *scan.FIGURES,
    *outlier_matrix.FIGURES,
    *uncertainty.FIGURES,
    *corner_plot.FIGURES,
    *rotation_axis.FIGURES,
    *platform_sketch.FIGURES,
    *mapping.FIGURES,
    *strip_fit.FIGURES,
    *basin.FIGURES,
    *trace.FIGURES,
    *residuals.FIGURES,
    *repeatability.FIGURES,
    *identifiability.FIGURES,
)

"""Every figure of a platform, in the order of the page: one entry each."""

from typing import Final

from linepose.output.figures import (
    basin,
    consistency,
    corner_plot,
    identifiability,
    mapping,
    noise_models,
    outlier_matrix,
    platform_sketch,
    repeatability,
    residuals,
    rotation_axis,
    scan,
    survey_plan,
    trace,
    uncertainty,
    weights,
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
    *noise_models.FIGURES,
    *consistency.FIGURES,
    *weights.FIGURES,
    *identifiability.FIGURES,
)

"""The schemas of an adjustment's tables, apart from what makes them: they are read by commands that compute nothing."""

from typing import Final

import pyarrow as pa

from linepose.estimation.outliers import OUTLIERS
from linepose.pipeline.adjusted_intrinsics import INTRINSICS
from linepose.pipeline.residual_tables import ESTIMATED_POINTS, RESIDUALS
from linepose.pipeline.stages import DIAGNOSTICS, OPTIMA, POSE
from linepose.survey.observations import EULER_COLUMNS, POSITION_COLUMNS
from linepose.tables import floats, optional_floats, point_column, texts, whole_numbers

STAGE: Final = "inliers"
CORRECTION_COLUMNS: Final = tuple(f"correction_{name}" for name in (*POSITION_COLUMNS, *EULER_COLUMNS))
NORMALISED_COLUMNS: Final = ("normalised_along", "normalised_across")

LEVELS: Final = pa.schema(
    [
        *texts("level"),
        *floats("value"),
        *optional_floats("low", "high"),
        *floats("prior_median", "prior_low", "prior_high"),
    ]
)
VIEWS: Final = pa.schema(
    [*whole_numbers("observation"), *optional_floats("weight", *CORRECTION_COLUMNS), *texts("fault")]
)
MEASUREMENTS: Final = pa.schema(
    [
        *whole_numbers("observation"),
        point_column(),
        *whole_numbers("time_us"),
        *floats(*CORRECTION_COLUMNS, "weight"),
        *optional_floats(*NORMALISED_COLUMNS),
    ]
)
STAGES: Final = {
    "outliers": OUTLIERS,
    "optima": OPTIMA,
    "diagnostics": DIAGNOSTICS,
    "pose": POSE,
    "residuals": RESIDUALS,
    "estimated_points": ESTIMATED_POINTS,
}
ADJUSTED: Final = {
    "levels": LEVELS,
    "adjusted_intrinsics": INTRINSICS,
    "adjusted_views": VIEWS,
    "adjusted_measurements": MEASUREMENTS,
}

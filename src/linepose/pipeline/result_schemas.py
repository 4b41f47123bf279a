"""The columns of every result, with units in their names: what other code may rely on."""

from collections.abc import Sequence
from typing import Final

import pyarrow as pa

from linepose.geometry.pose import POSE_COLUMNS, SIGMA_COLUMNS
from linepose.pipeline.residual_tables import POINT_COVARIANCE_COLUMNS
from linepose.survey import navigation
from linepose.survey.observations import COVARIANCE_COLUMNS, EULER_COLUMNS, POSITION_COLUMNS
from linepose.tables import flags, floats, optional_floats, texts, whole_numbers

LAPLACE_SIGMA_COLUMNS: Final = tuple(f"laplace_{name}" for name in SIGMA_COLUMNS)


def laplace_sigma_columns(names: Sequence[str]) -> tuple[str, ...]:
    """Columns of the curvature's sigmas of these parameters."""
    return tuple(f"laplace_sigma_{name}" for name in names)


_POINT = [*whole_numbers("observation", "point", "time_us"), *floats("u_px", *POSITION_COLUMNS, *EULER_COLUMNS)]

POINTS: Final = pa.schema(_POINT)
SCAN_POINTS: Final = pa.schema([*whole_numbers("observation", "point", "time_us"), *floats("u_px", "line")])
_SCAN: Final = [*whole_numbers("observation", "n_lines"), *floats("range_m", "v_px_per_line")]
EXTRACTION_ACCURACY: Final = pa.schema(
    [
        *_SCAN,
        *texts("method"),
        *flags("chosen"),
        *whole_numbers("n_points", "n_missing"),
        *floats("bias_u_px", "sigma_u_px", "bias_v_px", "sigma_v_px"),
    ]
)
DETECTION: Final = pa.schema([*_SCAN, *whole_numbers("n_visible", "n_found", "n_wrong"), *texts("doubt")])
OBSERVATIONS: Final = pa.schema([*_POINT, *floats(*COVARIANCE_COLUMNS, "nav_gap_s")])
OUTLIERS: Final = pa.schema(
    [
        *whole_numbers("n_observations", "observation"),
        *floats("error_px"),
        *flags("removed", "accepted"),
        *floats("neg_log_likelihood", *POSE_COLUMNS),
        *whole_numbers("n_evaluations"),
    ]
)
OPTIMA: Final = pa.schema(
    [
        *texts("stage"),
        *whole_numbers("n_observations"),
        *floats(*POSE_COLUMNS, *LAPLACE_SIGMA_COLUMNS, "neg_log_likelihood", "start_neg_log_likelihood"),
        *floats("reduced_chi_square"),
        *whole_numbers("n_evaluations", "degrees_of_freedom"),
        *flags("converged"),
    ]
)
SAMPLES: Final = pa.schema([*whole_numbers("walker", "step"), *floats(*POSE_COLUMNS, "log_likelihood")])
DIAGNOSTICS: Final = pa.schema(
    [
        *texts("stage"),
        *whole_numbers("n_observations"),
        *texts("parameter"),
        *floats(
            "acceptance_fraction",
            "autocorrelation_time",
            "effective_sample_size",
            "split_r_hat",
            "sampled_sigma",
            "laplace_sigma",
            "neg_log_likelihood",
            "reduced_chi_square",
        ),
        *texts("warning"),
    ]
)
POSE: Final = pa.schema(
    [
        *texts("stage"),
        *whole_numbers("n_observations"),
        *floats(*POSE_COLUMNS, *SIGMA_COLUMNS, "neg_log_likelihood"),
        *whole_numbers("n_evaluations"),
    ]
)
RESIDUALS: Final = pa.schema(
    [
        *texts("stage"),
        *whole_numbers("observation", "point"),
        *floats("error_px", "error_u_px", "error_v_px", "sigma_px"),
    ]
)
ESTIMATED_POINTS: Final = pa.schema(
    [*texts("stage"), *whole_numbers("point"), *floats(*POSITION_COLUMNS, *POINT_COVARIANCE_COLUMNS)]
)
FIGURES: Final = pa.schema(texts("figure", "title", "paper_figure", "caption", "alt", "left_out"))
MAP_FRAME: Final = pa.schema([*texts("crs"), *optional_floats("latitude_deg", "longitude_deg", "height_m")])
NAVIGATION_SIGMA: Final = pa.schema(floats(*navigation.SIGMA_COLUMNS))
TRUTH_ERROR: Final = pa.schema(
    [
        *texts("stage"),
        *whole_numbers("n_observations"),
        *texts("quantity"),
        *floats("error", "sigma", "error_in_sigmas"),
    ]
)
REGRESSION: Final = pa.schema(
    [
        *texts("quantity"),
        *floats("published", "obtained", "tolerance"),
        *flags("passed", "known_deviation"),
        *texts("note"),
    ]
)


def with_parameters(schema: pa.Schema, names: Sequence[str]) -> pa.Schema:
    """The schema with the columns of a noise model's own parameters at its end."""
    return pa.schema([*schema, *floats(*names)])

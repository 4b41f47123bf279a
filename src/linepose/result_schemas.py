"""The columns of every result, with units in their names: what other code may rely on."""

from typing import Final

import pyarrow as pa

from linepose import navigation
from linepose.observations import COVARIANCE_COLUMNS, EULER_COLUMNS, POSITION_COLUMNS
from linepose.pose import POSE_COLUMNS, SIGMA_COLUMNS

LAPLACE_SIGMA_COLUMNS: Final = tuple(f"laplace_{name}" for name in SIGMA_COLUMNS)


def _floats(*names: str) -> list[pa.Field]:
    return [pa.field(name, pa.float64(), nullable=False) for name in names]


def _whole(*names: str) -> list[pa.Field]:
    return [pa.field(name, pa.int64(), nullable=False) for name in names]


def _texts(*names: str) -> list[pa.Field]:
    return [pa.field(name, pa.string(), nullable=False) for name in names]


def _flags(*names: str) -> list[pa.Field]:
    return [pa.field(name, pa.bool_(), nullable=False) for name in names]


_POINT = [*_whole("observation", "point", "time_us"), *_floats("u_px", *POSITION_COLUMNS, *EULER_COLUMNS)]

POINTS: Final = pa.schema(_POINT)
SCAN_POINTS: Final = pa.schema([*_whole("observation", "point", "time_us"), *_floats("u_px", "line")])
OBSERVATIONS: Final = pa.schema([*_POINT, *_floats(*COVARIANCE_COLUMNS, "nav_gap_s")])
OUTLIERS: Final = pa.schema(
    [
        *_whole("n_observations", "observation"),
        *_floats("error_px"),
        *_flags("removed", "accepted"),
        *_floats("neg_log_likelihood", *POSE_COLUMNS),
        *_whole("n_evaluations"),
    ]
)
OPTIMA: Final = pa.schema(
    [
        *_texts("stage"),
        *_whole("n_observations"),
        *_floats(*POSE_COLUMNS, *LAPLACE_SIGMA_COLUMNS, "neg_log_likelihood", "start_neg_log_likelihood"),
        *_floats("reduced_chi_square"),
        *_whole("n_evaluations", "degrees_of_freedom"),
        *_flags("converged"),
    ]
)
SAMPLES: Final = pa.schema([*_whole("walker", "step"), *_floats(*POSE_COLUMNS, "log_likelihood")])
DIAGNOSTICS: Final = pa.schema(
    [
        *_texts("stage"),
        *_whole("n_observations"),
        *_texts("parameter"),
        *_floats(
            "acceptance_fraction",
            "autocorrelation_time",
            "effective_sample_size",
            "split_r_hat",
            "sampled_sigma",
            "laplace_sigma",
            "neg_log_likelihood",
            "reduced_chi_square",
        ),
        *_texts("warning"),
    ]
)
POSE: Final = pa.schema(
    [
        *_texts("stage"),
        *_whole("n_observations"),
        *_floats(*POSE_COLUMNS, *SIGMA_COLUMNS, "neg_log_likelihood"),
        *_whole("n_evaluations"),
    ]
)
NAVIGATION_SIGMA: Final = pa.schema(_floats(*navigation.SIGMA_COLUMNS))
TRUTH_ERROR: Final = pa.schema(
    [
        *_texts("stage"),
        *_whole("n_observations"),
        *_texts("quantity"),
        *_floats("error", "sigma", "error_in_sigmas"),
    ]
)
REGRESSION: Final = pa.schema(
    [
        *_texts("quantity"),
        *_floats("published", "obtained", "tolerance"),
        *_flags("passed", "known_deviation"),
        *_texts("note"),
    ]
)


def with_parameters(schema: pa.Schema, names: tuple[str, ...]) -> pa.Schema:
    """The schema with the columns of a noise model's own parameters at its end."""
    return pa.schema([*schema, *_floats(*names)])

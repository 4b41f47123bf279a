"""The columns of the experiments' results, with units in their names: what other code may rely on.

A number is null where an experiment has none: a sigma of a pose that is left open, a projection that misses the plane.
"""

from typing import Final

import pyarrow as pa

from linepose.experiments.basin import START_COLUMNS
from linepose.experiments.clock_offset import CORRELATION_COLUMNS
from linepose.experiments.mapping import PROJECTED_COLUMNS, PROJECTED_COVARIANCE_COLUMNS
from linepose.experiments.noise_models import EXTRA_PARAMETERS, LEVEL_COLUMNS
from linepose.geometry.pose import POSE_COLUMNS, SIGMA_COLUMNS
from linepose.tables import flags, floats, optional_floats, texts, whole_numbers


def _estimate(suffix: str = "") -> list[pa.Field]:
    return [
        *whole_numbers(f"n_observations{suffix}"),
        *texts(f"observations{suffix}"),
        *floats(*(f"{name}{suffix}" for name in POSE_COLUMNS)),
        *optional_floats(*(f"{name}{suffix}" for name in SIGMA_COLUMNS)),
        *floats(f"neg_log_likelihood{suffix}"),
        *whole_numbers(f"n_evaluations{suffix}"),
    ]


_AGREEMENT: Final = [*floats("distance_m", "angle_rad"), *optional_floats("mahalanobis", "p_value")]

SUBSETS: Final = pa.schema([*texts("subset"), *_estimate()])
REPEATABILITY: Final = pa.schema([*texts("subset"), *_estimate(), *_AGREEMENT])
SPLITS: Final = pa.schema([*whole_numbers("split"), *_estimate("_1"), *_estimate("_2"), *_AGREEMENT])
LEAVE_ONE_OUT: Final = pa.schema(
    [*whole_numbers("left_out"), *_estimate(), *floats("distance_m", "angle_rad", "influence")]
)
UNCERTAINTY: Final = pa.schema(
    [*texts("stage", "method"), *whole_numbers("n_observations"), *floats(*POSE_COLUMNS, *SIGMA_COLUMNS)]
)
BASIN: Final = pa.schema(
    [
        *texts("optimiser"),
        *whole_numbers("cell"),
        *floats("distance_m", "angle_rad", *START_COLUMNS, *POSE_COLUMNS, "neg_log_likelihood"),
        *whole_numbers("n_evaluations"),
        *floats("mahalanobis"),
        *flags("success"),
    ]
)
BASIN_SUMMARY: Final = pa.schema(
    [
        *texts("optimiser", "region"),
        *whole_numbers("n_starts", "n_successes"),
        *optional_floats("success_rate", "success_rate_low", "success_rate_high", "median_n_evaluations"),
    ]
)
MAPPING: Final = pa.schema(
    [
        *texts("pose"),
        *whole_numbers("observation", "point"),
        *optional_floats(*PROJECTED_COLUMNS, *PROJECTED_COVARIANCE_COLUMNS),
    ]
)
MAPPING_SUMMARY: Final = pa.schema(
    [
        *texts("pose", "observations"),
        *whole_numbers("n_projected"),
        *optional_floats("spread_mm", "sigma_mm"),
        *floats("normal_north", "normal_east", "normal_down", "plane_rms_mm", "equation_26_angle_rad"),
    ]
)
NOISE_MODELS: Final = pa.schema(
    [
        *texts("noise_model", "set"),
        *_estimate(),
        *optional_floats(*EXTRA_PARAMETERS, *LEVEL_COLUMNS),
        *floats("effective_sample_size", "split_r_hat"),
        *texts("warning"),
        *floats("distance_m", "angle_rad", "mahalanobis"),
        *optional_floats("position_error_m", "rotation_error_rad", "error_in_sigmas"),
    ]
)
IDENTIFIABILITY: Final = pa.schema(
    [
        *texts("parameter"),
        *floats("prior_sigma", "posterior_sigma", "shrinkage", "weakest_direction", "weakest_shrinkage"),
        *texts("weakest_in_words"),
    ]
)
WEIGHTS: Final = pa.schema(
    [*whole_numbers("observation", "point"), *floats("view_weight", "point_weight"), *flags("removed")]
)
CONSISTENCY: Final = pa.schema(
    [
        *texts("noise_model", "comparison"),
        *whole_numbers("split"),
        *_estimate("_1"),
        *_estimate("_2"),
        *_AGREEMENT,
    ]
)
CONSISTENCY_SUMMARY: Final = pa.schema(
    [
        *texts("noise_model", "comparison"),
        *whole_numbers("n_splits", "n_open"),
        *optional_floats(
            "median_distance",
            "sigma_factor",
            "share_beyond_68",
            "share_beyond_95",
            "kolmogorov",
            "largest_distance",
        ),
    ]
)
SENSITIVITY: Final = pa.schema([*texts("change"), *_estimate(), *_AGREEMENT[:2], *optional_floats("mahalanobis")])
PRIOR: Final = pa.schema(
    [
        *texts("parameter"),
        *floats("difference", "sigma", "prior_sigma", "data_weight"),
        *flags("prior_counted_in"),
        *texts("decided_by"),
    ]
)
CLOCK_OFFSET: Final = pa.schema(
    [
        *whole_numbers("n_observations"),
        *texts("observations"),
        *floats("offset_s", "sigma_s", "sampled_sigma_s"),
        *optional_floats("laplace_sigma_s", "jackknife_sigma_s"),
        *floats("maximum_s", "shrinkage", "correlation_pose", *CORRELATION_COLUMNS),
        *floats(*POSE_COLUMNS, *SIGMA_COLUMNS, "neg_log_likelihood"),
        *floats(*(f"{name}_without" for name in (*POSE_COLUMNS, *SIGMA_COLUMNS, "neg_log_likelihood")), "mahalanobis"),
        *flags("identifiable"),
        *texts("verdict", "advice"),
    ]
)

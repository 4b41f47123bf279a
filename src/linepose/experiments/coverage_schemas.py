"""The columns of the coverage study's results, with units in their names. A number that does not exist is null."""

from typing import Final

import pyarrow as pa

from linepose.experiments.coverage import LEVEL_COLUMNS, RANK_COLUMNS, TRUE_COLUMNS, TRUE_LEVEL_COLUMNS
from linepose.experiments.coverage_summary import BIAS_COLUMNS, CELL, RANK_P_COLUMNS, RMSE_COLUMNS
from linepose.geometry.pose import POSE_COLUMNS, SIGMA_COLUMNS
from linepose.tables import flags, floats, optional_floats, texts, whole_numbers

COVERAGE_SURVEYS: Final = pa.schema(
    [
        *texts(*CELL),
        *whole_numbers("survey"),
        *floats(*TRUE_COLUMNS, *POSE_COLUMNS),
        *optional_floats(*TRUE_LEVEL_COLUMNS, *SIGMA_COLUMNS, *LEVEL_COLUMNS),
        *floats("neg_log_likelihood"),
        *whole_numbers("n_evaluations"),
        *flags("failed"),
        *optional_floats(*RANK_COLUMNS, "pareto_shape", "effective_sample_size"),
        *floats("laplace_credibility", "credibility"),
    ]
)
COVERAGE: Final = pa.schema(
    [
        *texts(*CELL),
        *floats("nominal"),
        *whole_numbers("n_surveys", "n_covered"),
        *floats("coverage", "coverage_low", "coverage_high"),
    ]
)
COVERAGE_SUMMARY: Final = pa.schema(
    [
        *texts(*CELL),
        *whole_numbers("n_surveys", "n_failed"),
        *floats(*(f"coverage_{p}{end}" for p in (68, 95) for end in ("", "_low", "_high"))),
        *floats("laplace_coverage_68", "laplace_coverage_95"),
        *optional_floats(
            *RMSE_COLUMNS, *BIAS_COLUMNS, *RANK_P_COLUMNS, "median_effective_sample_size", "untrusted_share"
        ),
    ]
)

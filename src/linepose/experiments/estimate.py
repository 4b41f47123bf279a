"""An estimate as columns of a table: what every experiment notes under its own condition."""

import numpy as np
import pyarrow as pa
from numpy.typing import ArrayLike

from linepose.estimation.estimator import Estimate
from linepose.geometry.pose import POSE_COLUMNS, SIGMA_COLUMNS
from linepose.tables import floats, optional_floats, texts, whole_numbers


def estimate_row(estimate: Estimate) -> dict[str, object]:
    """An estimate as the columns of one table row."""
    return {
        "n_observations": len(estimate.number),
        "observations": observation_list(estimate.number),
        **dict(zip(POSE_COLUMNS, estimate.pose, strict=True)),
        **dict(zip(SIGMA_COLUMNS, estimate.sigma(), strict=True)),
        "neg_log_likelihood": estimate.neg_log_likelihood,
        "n_evaluations": estimate.n_evaluations,
    }


def estimate_fields(suffix: str = "") -> list[pa.Field]:
    """The columns of `estimate_row`, with a suffix at their end; a sigma of a pose that is left open is null."""
    return [
        *whole_numbers(f"n_observations{suffix}"),
        *texts(f"observations{suffix}"),
        *floats(*(f"{name}{suffix}" for name in POSE_COLUMNS)),
        *optional_floats(*(f"{name}{suffix}" for name in SIGMA_COLUMNS)),
        *floats(f"neg_log_likelihood{suffix}"),
        *whole_numbers(f"n_evaluations{suffix}"),
    ]


def observation_list(numbers: ArrayLike) -> str:
    """Observation numbers as a table shows them, in the given order, a space between."""
    return " ".join(str(int(number)) for number in np.asarray(numbers))

"""How far two independent estimates of one pose lie apart."""

from typing import Final

import numpy as np

from linepose.estimation.estimator import Estimate
from linepose.experiments.estimate import estimate_row
from linepose.geometry.distance import euclidean_distance_m, geodesic_angle_rad, mahalanobis_between, p_value
from linepose.tables import floats, optional_floats

AGREEMENT: Final = [*floats("distance_m", "angle_rad"), *optional_floats("mahalanobis", "p_value")]


def agreement(first: Estimate, second: Estimate) -> dict[str, float]:
    """How far two independent estimates lie apart: metres, radians, sigmas, and the p-value of that.

    The last two are NaN where an estimate has no covariance. Raises EstimationError for a singular one.
    """
    known = np.all(np.isfinite(first.covariance + second.covariance))
    distance = (
        mahalanobis_between(first.pose, first.covariance, second.pose, second.covariance) if known else float("nan")
    )
    return {
        "distance_m": float(euclidean_distance_m(first.pose, second.pose)),
        "angle_rad": float(geodesic_angle_rad(first.pose, second.pose)),
        "mahalanobis": distance,
        "p_value": float(p_value(distance)),
    }


def pair_row(first: Estimate, second: Estimate) -> dict[str, object]:
    """Two estimates and their agreement as columns of one row, those of each with `_1` or `_2` at their end."""
    columns = {
        f"{key}_{k}": value for k, one in enumerate((first, second), 1) for key, value in estimate_row(one).items()
    }
    return columns | agreement(first, second)

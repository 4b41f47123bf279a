"""The adjustment's results of the made-up platform: levels, views, measurements, and other sets beside."""

import numpy as np
import pandas as pd

from linepose.adjustment.levels import LEVEL_NAMES, LOG_SIGMA, MEDIAN
from linepose.experiments.adjustment_beside import ADJUSTED_SPLITS, ADJUSTMENT
from linepose.geometry.pose import POSE_COLUMNS, SIGMA_COLUMNS
from linepose.pipeline.adjusted_intrinsics import INTRINSICS, AdjustedIntrinsics, intrinsics_table
from linepose.pipeline.adjusted_schemas import CORRECTION_COLUMNS, LEVELS, MEASUREMENTS, VIEWS

VALUES = dict(zip(LEVEL_NAMES, (0.8, 0.01, 0.6, 0.23, 0.62, 13.0, 0.4), strict=True))  # drift and constant make 1.0
POSE = np.array([0.17, 0.03, -0.70, -0.82, 0.74, -1.43])
POSE_SIGMA = np.array([0.04, 0.014, 0.08, 0.008, 0.009, 0.004])
SETS = {"all": (6, 0.0, 0.4, (0.2, 0.6)), "inliers": (4, 0.03, 0.5, (0.3, 0.8)), "other": (6, 0.0, 1.1, (0.8, 1.5))}


def levels() -> pd.DataFrame:
    """A drift of 13 s and 0.8 of the reported sigmas, 0.6 common to a view; attitude 0.4 of what is reported."""
    value = np.array(list(VALUES.values()))
    median, factor = np.array(MEDIAN), np.exp(1.96 * np.array(LOG_SIGMA))
    table = pd.DataFrame({"level": LEVEL_NAMES, "value": value, "low": 0.5 * value, "high": 1.5 * value})
    return table.assign(prior_median=median, prior_low=median / factor, prior_high=median * factor)


def adjusted_views() -> pd.DataFrame:
    """Observation 6 has a clock that is off, observation 5 a label."""
    table = pd.DataFrame({"observation": np.arange(1, 7), "weight": [1.2, 1.1, 1.0, 0.9, 0.8, 0.1]})
    table = table.assign(**dict.fromkeys(CORRECTION_COLUMNS, 0.002))
    return table.assign(fault=["", "", "", "", "label", "clock"])


def adjusted_measurements() -> pd.DataFrame:
    """One second between points, a minute between observations; point 2 of observation 5 counts least."""
    observation, point = (grid.ravel() for grid in np.meshgrid(np.arange(1, 7), np.arange(4), indexing="ij"))
    table = pd.DataFrame({"observation": observation, "point": point})
    table["time_us"] = 60_000_000 * observation + 1_000_000 * point
    for k, name in enumerate(CORRECTION_COLUMNS):
        table[name] = 0.004 * (-1.0) ** observation + 0.001 * point * (k == 0)
    normal = np.sin(np.arange(len(table)))
    weight = np.where((observation == 5) & (point == 2), 0.05, 1.1)
    return table.assign(weight=weight, normalised_along=normal, normalised_across=4.0 * (point == 3))


def adjusted_intrinsics() -> pd.DataFrame:
    """A principal point 4 px off the file's, known to 0.3 px; the camera's y turn follows it."""
    turn = np.zeros((6, 2))
    turn[4, 0] = 1.0 / 1108.0
    return intrinsics_table(
        AdjustedIntrinsics(
            ("principal_point_px", "focal_length_m"),
            np.array([327.0, 8.25e-3]),
            np.diag([0.3**2, 1e-5**2]),
            turn,
            np.array([323.0, 8.2e-3]),
            np.array([2.0, 1e-4]),
        )
    )


def adjustment() -> pd.DataFrame:
    """All observations, the accepted ones, and another platform, whose attitude sigmas fit as they are."""
    rows = []
    for name, (count, moved_m, attitude, (low, high)) in SETS.items():
        values = VALUES | {"attitude": attitude}
        ends = {f"{level}_{end}": 0.5 * value for level, value in values.items() for end in ("low", "high")}
        ends |= {"attitude_low": low, "attitude_high": high}
        estimate = {"n_observations": count, "observations": "1 2 3 4", "neg_log_likelihood": 9.0, "n_evaluations": 40}
        estimate |= dict(zip(POSE_COLUMNS, POSE + moved_m * np.eye(6)[0], strict=True))
        estimate |= dict(zip(SIGMA_COLUMNS, POSE_SIGMA, strict=True))
        told = {"least_eigenvalue": 0.9, "smallest_weight": 0.05, "warning": "few draws" if name == "other" else ""}
        errors = dict.fromkeys(("position_error_m", "rotation_error_rad", "error_in_sigmas"), np.nan)
        rows.append({"set": name, **estimate, **values, **ends, **told, **errors})
    return pd.DataFrame(rows)


def adjusted_splits() -> pd.DataFrame:
    """Thirty halves of each set: their median distance is 2.2 sigmas, or 1.1 for the other platform."""
    estimate = {"observations": "1 2", "n_observations": 2, "neg_log_likelihood": 1.0, "n_evaluations": 9}
    estimate |= dict.fromkeys((*POSE_COLUMNS, *SIGMA_COLUMNS), 0.1)
    both = {f"{name}_{k}": value for k in (1, 2) for name, value in estimate.items()}
    distance = np.linspace(1.2, 3.2, 31)
    parts = [
        pd.DataFrame({"split": np.arange(31), **both, "mahalanobis": distance / (2 if name == "other" else 1)}).assign(
            set=name, distance_m=0.1, angle_rad=0.01, p_value=0.5
        )
        for name in SETS
    ]
    return pd.concat(parts, ignore_index=True)


BESIDE = {
    "levels": (levels, LEVELS),
    "adjusted_intrinsics": (adjusted_intrinsics, INTRINSICS),
    "adjusted_views": (adjusted_views, VIEWS),
    "adjusted_measurements": (adjusted_measurements, MEASUREMENTS),
    "adjustment": (adjustment, ADJUSTMENT),
    "adjusted_splits": (adjusted_splits, ADJUSTED_SPLITS),
}

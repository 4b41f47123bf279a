"""What the experiments found on the made-up platform."""

import numpy as np
import pandas as pd

from linepose.experiments.basin import START_COLUMNS, Region, summarise
from linepose.experiments.clock_offset import CORRELATION_COLUMNS
from linepose.experiments.mapping import PROJECTED_COLUMNS, PROJECTED_COVARIANCE_COLUMNS
from linepose.geometry.pose import POSE_COLUMNS, SIGMA_COLUMNS
from unit.made_up_platform import ACCEPTED, N_OBSERVATIONS, OPTIMUM, ORIGIN, POINTS, SIGMA


def prior() -> pd.DataFrame:
    """The data decide everything but the height, which the tape knew as well."""
    names = [*POSE_COLUMNS[:3], "roll_rad", "pitch_rad", "yaw_rad"]
    table = pd.DataFrame({"parameter": names, "difference": [0.01, -0.14, 0.01, 0.02, 0.0, -0.01], "sigma": SIGMA})
    table = table.assign(prior_sigma=[0.1] * 3 + [0.035] * 3, data_weight=[0.9, 0.8, 0.5, 0.9, 0.9, 0.9])
    decided = ["data", "data", "data and prior", "data", "data", "data"]
    return table.assign(prior_counted_in=True, decided_by=decided)


def identifiability() -> pd.DataFrame:
    """The height is what the data say least of."""
    names = (*POSE_COLUMNS[:3], "roll_rad", "pitch_rad", "yaw_rad")
    table = pd.DataFrame({"parameter": names, "prior_sigma": 1.0, "posterior_sigma": np.linspace(0.1, 0.6, 6)})
    table = table.assign(weakest_direction=[0.3, 0.0, -0.95, 0.0, 0.0, 0.0], weakest_shrinkage=0.1)
    return table.assign(shrinkage=1 - table["posterior_sigma"] ** 2, weakest_in_words="r_z against r_x")


def mapping() -> pd.DataFrame:
    """Projections off by 0.1 m before, by 0.01 m after, by 0.05 m when turned."""
    rows = []
    for name, error in (("hand_measured", 0.1), ("calibrated", 0.01), ("perturbed", 0.05)):
        for number in range(1, N_OBSERVATIONS + 1):
            for point, place in enumerate(ORIGIN + POINTS):
                shifted = place + np.array([error * np.cos(number), error * np.sin(number), 0.0])
                row = {"pose": name, "observation": number, "point": point}
                row |= dict(zip(PROJECTED_COLUMNS, shifted, strict=True))
                diagonal = {PROJECTED_COVARIANCE_COLUMNS[k]: 4e-4 for k in (0, 3)}
                rows.append(row | dict.fromkeys(PROJECTED_COVARIANCE_COLUMNS, 0.0) | diagonal)
    return pd.DataFrame(rows)


def mapping_summary() -> pd.DataFrame:
    """Spreads of 100, 10 and 50 mm."""
    rows = [
        {"pose": name, "observations": which, "n_projected": 24, "spread_mm": spread, "sigma_mm": 20.0}
        for name, spread in (("hand_measured", 100.0), ("calibrated", 10.0), ("perturbed", 50.0))
        for which in ("all", "accepted")
    ]
    about = {"normal_north": 0.0, "normal_east": 0.0, "normal_down": 1.0, "plane_rms_mm": 1.0}
    return pd.DataFrame(rows).assign(**about, equation_26_angle_rad=0.0)


def basin() -> pd.DataFrame:
    """Two optimisers on 4 x 3 cells, the second finds the optimum from everywhere."""
    i, j = np.divmod(np.arange(12), 3)
    grid = pd.DataFrame({"cell": np.arange(12), "distance_m": 0.25 + 0.5 * i, "angle_rad": 0.1 + 0.2 * j})
    grid = grid.assign(**dict.fromkeys((*START_COLUMNS, *POSE_COLUMNS), 0.0), neg_log_likelihood=1.0, n_evaluations=9)
    grid = grid.assign(mahalanobis=0.0)
    return pd.concat([grid.assign(optimiser="powell", success=i < 2), grid.assign(optimiser="wide", success=True)])


def basin_summary() -> pd.DataFrame:
    """Counts of the sweep."""
    parts = basin().groupby("optimiser", sort=False)
    return pd.concat([summarise(part, Region(1.0, 0.6)).assign(optimiser=name) for name, part in parts])


def splits() -> pd.DataFrame:
    """Forty splits, one of which leaves the pose open; the median distance is 4.6 sigmas, twice what is right."""
    distance = np.concatenate([np.linspace(2.6, 6.6, 39), [np.nan]])
    estimate = {"observations": "1 2", "n_observations": 2, "neg_log_likelihood": 1.0, "n_evaluations": 9}
    estimate |= dict.fromkeys((*POSE_COLUMNS, *SIGMA_COLUMNS), 0.1)
    halves = {f"{name}_{k}": value for k in (1, 2) for name, value in estimate.items()}
    agreement = {"distance_m": 0.1, "angle_rad": 0.01, "mahalanobis": distance, "p_value": 0.1}
    return pd.DataFrame({"split": np.arange(40), **halves, **agreement})


def leave_one_out() -> pd.DataFrame:
    """Observation 3 moves the pose most, by 1.5 sigmas."""
    table = pd.DataFrame({"left_out": ACCEPTED, "influence": [0.2, 0.3, 1.5, 0.1]})
    table = table.assign(n_observations=3, observations="", neg_log_likelihood=1.0, n_evaluations=9, distance_m=0.01)
    return table.assign(angle_rad=0.01, **dict.fromkeys((*POSE_COLUMNS, *SIGMA_COLUMNS), 0.1))


def uncertainty() -> pd.DataFrame:
    """Sigmas that grow as observations go, a little different by method."""
    rows = [
        {
            "stage": stage,
            "method": method,
            "n_observations": count,
            **dict(zip(POSE_COLUMNS, OPTIMUM, strict=True)),
            **dict(zip(SIGMA_COLUMNS, factor * SIGMA * np.sqrt(4 / count), strict=True)),
        }
        for stage, count in (("all", 6), ("observations_5", 5), ("inliers", 4))
        for method, factor in (("mcmc", 1.0), ("laplace", 0.95))
    ]
    return pd.DataFrame(rows)


def clock_offset() -> pd.DataFrame:
    """A camera that is 30 ms late, known to 5 ms by the noise model and to 8 ms by leaving out observations."""
    pose = dict(zip(POSE_COLUMNS, OPTIMUM, strict=True)) | dict(zip(SIGMA_COLUMNS, SIGMA, strict=True))
    row = {"n_observations": 4, "observations": "1 2 3 4", "offset_s": 0.03, "sigma_s": 0.008, "sampled_sigma_s": 0.005}
    row |= {"laplace_sigma_s": 0.005, "jackknife_sigma_s": 0.008, "maximum_s": 0.1, "shrinkage": 0.98}
    row |= {"correlation_pose": 0.4, **dict.fromkeys(CORRELATION_COLUMNS, 0.25), **pose, "neg_log_likelihood": 9.5}
    row |= {f"{name}_without": value for name, value in pose.items()} | {"neg_log_likelihood_without": 12.5}
    row |= {
        "mahalanobis": 1.2,
        "identifiable": True,
        "verdict": "The camera's clock is behind.",
        "advice": "Add 30000 us.",
    }
    return pd.DataFrame([row])

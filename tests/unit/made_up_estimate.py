"""What the made-up platform's observations and estimate are: observations, removal, optima, chain, residuals."""

import numpy as np
import pandas as pd

from linepose.geometry.pose import POSE_COLUMNS, SIGMA_COLUMNS
from linepose.pipeline.residual_tables import POINT_COVARIANCE_COLUMNS
from linepose.pipeline.stages import LAPLACE_SIGMA_COLUMNS
from linepose.survey.observations import COVARIANCE_COLUMNS, EULER_COLUMNS, POSITION_COLUMNS
from unit.made_up_platform import (
    ACCEPTED,
    N_OBSERVATIONS,
    N_STEPS,
    N_WALKERS,
    OPTIMUM,
    ORIGIN,
    POINTS,
    REMOVED,
    SIGMA,
    platform,
)


def samples() -> pd.DataFrame:
    """A chain around the optimum with the stated sigmas."""
    random = np.random.default_rng(5)
    drawn = OPTIMUM + SIGMA * random.standard_normal((N_STEPS * N_WALKERS, 6))
    step, walker = np.divmod(np.arange(N_STEPS * N_WALKERS), N_WALKERS)
    return pd.DataFrame(
        {"walker": walker, "step": step, **dict(zip(POSE_COLUMNS, drawn.T, strict=True)), "log_likelihood": -10.0}
    )


def observations() -> pd.DataFrame:
    """Six observations of four points from a ring of 3 m, the odd ones rolled by 5 deg."""
    rows = []
    for number in range(1, N_OBSERVATIONS + 1):
        bearing = 2 * np.pi * number / N_OBSERVATIONS
        position = ORIGIN + np.array([3 * np.cos(bearing), 3 * np.sin(bearing), -1.0])
        euler = [np.radians(5.0) * (number % 2), 0.01, bearing]
        for point in range(len(POINTS)):
            rows.append(
                {
                    "observation": number,
                    "point": point,
                    "time_us": 1_000_000 * number + point,
                    "u_px": 300.0 + point,
                    **dict(zip(POSITION_COLUMNS, position, strict=True)),
                    **dict(zip(EULER_COLUMNS, euler, strict=True)),
                    **{name: 1e-4 * (name.split("_")[1] == name.split("_")[2]) for name in COVARIANCE_COLUMNS},
                    "nav_gap_s": 0.1,
                }
            )
    return pd.DataFrame(rows)


def outliers() -> pd.DataFrame:
    """Six observations, 6 and 5 removed, four accepted, one more removed for the figure."""
    rows = []
    for left_out in ([], REMOVED[:1], REMOVED, [*REMOVED, 4]):
        used = [number for number in range(1, N_OBSERVATIONS + 1) if number not in left_out]
        for number in used:
            rows.append(
                {
                    "n_observations": len(used),
                    "observation": number,
                    "error_px": 1.0 + 0.5 * number + 5.0 * (number in REMOVED),
                    "removed": number == max(used) and len(used) > 3,
                    "accepted": used == ACCEPTED,
                    "neg_log_likelihood": 10.0 * len(used),
                    **dict(zip(POSE_COLUMNS, OPTIMUM, strict=True)),
                    "n_evaluations": 100,
                }
            )
    return pd.DataFrame(rows)


def optima() -> pd.DataFrame:
    """Three stages, all at the same optimum."""
    rows = []
    for stage, count in (("all", 6), ("observations_5", 5), ("inliers", 4)):
        rows.append(
            {
                "stage": stage,
                "n_observations": count,
                **dict(zip(POSE_COLUMNS, OPTIMUM, strict=True)),
                **dict(zip(LAPLACE_SIGMA_COLUMNS, SIGMA, strict=True)),
                "neg_log_likelihood": 12.5,
                "start_neg_log_likelihood": 90.0,
                "reduced_chi_square": 0.9,
                "n_evaluations": 1000,
                "degrees_of_freedom": 10,
                "converged": True,
            }
        )
    return pd.DataFrame(rows)


def pose() -> pd.DataFrame:
    """The hand-measured pose and the three stages."""
    made = platform()
    hand = {"stage": "hand_measured", "n_observations": 4, "neg_log_likelihood": 90.0, "n_evaluations": 1}
    hand |= dict(zip(POSE_COLUMNS, made.start_pose(), strict=True))
    hand |= dict(zip(SIGMA_COLUMNS, np.sqrt(np.diag(made.start_covariance())), strict=True))
    stages = optima()[["stage", "n_observations", *POSE_COLUMNS, "neg_log_likelihood", "n_evaluations"]]
    return pd.concat([pd.DataFrame([hand]), stages.assign(**dict(zip(SIGMA_COLUMNS, SIGMA, strict=True)))])


def diagnostics() -> pd.DataFrame:
    """One stage's chain, too short for its autocorrelation time of 4 steps."""
    rows = [
        {
            "stage": "inliers",
            "n_observations": 4,
            "parameter": name,
            "acceptance_fraction": 0.4,
            "autocorrelation_time": 4.0,
            "effective_sample_size": 80.0,
            "split_r_hat": 1.2,
            "sampled_sigma": SIGMA[k],
            "laplace_sigma": SIGMA[k],
            "neg_log_likelihood": 12.5,
            "reduced_chi_square": 0.9,
            "warning": "short",
        }
        for k, name in enumerate(POSE_COLUMNS)
    ]
    unknown = (
        "pareto_shape",
        "least_eigenvalue",
        "disagreement_sigmas",
        "sigma_without_target",
        "target_misfit_sigmas",
    )
    return pd.DataFrame(rows).assign(**dict.fromkeys(unknown, np.nan))


def residuals() -> pd.DataFrame:
    """Errors of the accepted observations: u alike in a view, v alternating."""
    rows = [
        {
            "stage": "inliers",
            "observation": number,
            "point": point,
            "error_u_px": float(number - 2.5),
            "error_v_px": (-1.0) ** point,
            "error_px": float(np.hypot(number - 2.5, 1.0)),
            "sigma_px": 2.0,
        }
        for number in ACCEPTED
        for point in range(len(POINTS))
    ]
    return pd.DataFrame(rows)


def estimated_points() -> pd.DataFrame:
    """The four points, in map coordinates."""
    table = pd.DataFrame(ORIGIN + POINTS, columns=list(POSITION_COLUMNS))
    return table.assign(stage="inliers", point=np.arange(len(POINTS)), **dict.fromkeys(POINT_COVARIANCE_COLUMNS, 1e-6))

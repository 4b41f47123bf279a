"""Results of a made-up platform: small, written by hand, with numbers that tests can look for in pictures and pages."""

from pathlib import Path

import numpy as np
import pandas as pd

from linepose.config.platform import Platform
from linepose.estimation.outliers import OUTLIERS
from linepose.experiments.basin import BASIN, BASIN_SUMMARY, START_COLUMNS, Region, summarise
from linepose.experiments.clock_offset import CLOCK_OFFSET, CORRELATION_COLUMNS
from linepose.experiments.leave_one_out import LEAVE_ONE_OUT
from linepose.experiments.mapping import MAPPING, MAPPING_SUMMARY, PROJECTED_COLUMNS, PROJECTED_COVARIANCE_COLUMNS
from linepose.experiments.prior import IDENTIFIABILITY, PRIOR_TABLE
from linepose.experiments.splits import SPLITS
from linepose.experiments.uncertainty import UNCERTAINTY
from linepose.geometry.pose import POSE_COLUMNS, SIGMA_COLUMNS
from linepose.pipeline.residual_tables import ESTIMATED_POINTS, POINT_COVARIANCE_COLUMNS, RESIDUALS
from linepose.pipeline.stages import DIAGNOSTICS, LAPLACE_SIGMA_COLUMNS, OPTIMA, POSE, SAMPLES
from linepose.survey.observations import COVARIANCE_COLUMNS, EULER_COLUMNS, OBSERVATIONS, POSITION_COLUMNS
from linepose.tables import write_table
from unit import made_up_adjustment

OPTIMUM = np.array([0.19, -0.14, -0.79, -0.82, 0.74, -1.43])
SIGMA = np.array([0.03, 0.05, 0.06, 0.016, 0.018, 0.009])
ORIGIN = np.array([6248000.0, 332960.0, -42.0])
N_OBSERVATIONS, ACCEPTED, REMOVED = 6, [1, 2, 3, 4], [6, 5]
POINTS = np.array([[-0.2, -0.3, 0.0], [-0.2, 0.3, 0.0], [0.2, -0.3, 0.0], [0.2, 0.3, 0.0]])
N_STEPS, N_WALKERS = 20, 16
PLATFORM = {
    "description": "A made-up platform",
    "noise_model": "published",
    "prior": "none",
    "camera": {"focal_length_m": 8.2e-3, "pixel_pitch_m": 7.4e-6, "n_pixels": 648, "principal_point_px": 323.0},
    "hand_measured": {"position_m": [0.2, 0.0, -0.8], "euler_deg": [-56.0, 0.0, -90.0]},
    "source": {"kind": "labelled_views", "dataset": "made_up"},
    "experiments": {"adjustment_beside": {"platforms": ["other"]}},
    "outline": {
        "side": {"lines": [[[-1.0, 0.5], [1.0, 0.5], [0.0, -0.7], [-1.0, 0.5]]], "circles": [[0.5, 0.7, 0.2]]},
        "front": {"lines": [[[-0.7, 0.5], [0.7, 0.5]]]},
    },
}


def platform(**changes) -> Platform:
    """The made-up platform, with keys of its file changed."""
    return Platform.model_validate(PLATFORM | changes)


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
            **dict.fromkeys(("pareto_shape", "least_eigenvalue", "disagreement_sigmas"), np.nan),
        }
        for k, name in enumerate(POSE_COLUMNS)
    ]
    unknown = dict.fromkeys(("pareto_shape", "least_eigenvalue", "disagreement_sigmas"), np.nan)
    return pd.DataFrame(rows).assign(**unknown)


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


def identifiability() -> pd.DataFrame:
    """The height is what the data say least of."""
    names = (*POSE_COLUMNS[:3], "roll_rad", "pitch_rad", "yaw_rad")
    table = pd.DataFrame({"parameter": names, "prior_sigma": 1.0, "posterior_sigma": np.linspace(0.1, 0.6, 6)})
    table = table.assign(weakest_direction=[0.3, 0.0, -0.95, 0.0, 0.0, 0.0], weakest_shrinkage=0.1)
    return table.assign(shrinkage=1 - table["posterior_sigma"] ** 2, weakest_in_words="r_z against r_x")


def prior() -> pd.DataFrame:
    """The data decide everything but the height, which the tape knew as well."""
    names = [*POSE_COLUMNS[:3], "roll_rad", "pitch_rad", "yaw_rad"]
    table = pd.DataFrame({"parameter": names, "difference": [0.01, -0.14, 0.01, 0.02, 0.0, -0.01], "sigma": SIGMA})
    table = table.assign(prior_sigma=[0.1] * 3 + [0.035] * 3, data_weight=[0.9, 0.8, 0.5, 0.9, 0.9, 0.9])
    decided = ["data", "data", "data and prior", "data", "data", "data"]
    return table.assign(prior_counted_in=True, decided_by=decided)


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


TABLES = {
    "prior": (prior, PRIOR_TABLE),
    "clock_offset": (clock_offset, CLOCK_OFFSET),
    "observations": (observations, OBSERVATIONS),
    "outliers": (outliers, OUTLIERS),
    "optima": (optima, OPTIMA),
    "pose": (pose, POSE),
    "mcmc/inliers": (samples, SAMPLES),
    "diagnostics": (diagnostics, DIAGNOSTICS),
    "residuals": (residuals, RESIDUALS),
    "estimated_points": (estimated_points, ESTIMATED_POINTS),
    "mapping": (mapping, MAPPING),
    "mapping_summary": (mapping_summary, MAPPING_SUMMARY),
    "basin": (basin, BASIN),
    "basin_summary": (basin_summary, BASIN_SUMMARY),
    "splits": (splits, SPLITS),
    "leave_one_out": (leave_one_out, LEAVE_ONE_OUT),
    "uncertainty": (uncertainty, UNCERTAINTY),
    "identifiability": (identifiability, IDENTIFIABILITY),
    **made_up_adjustment.BESIDE,
}
ADJUSTED = {
    name: TABLES[name]
    for name in ("prior", "identifiability", "observations", "mcmc/inliers", "residuals", "estimated_points", "splits")
} | {name: TABLES[name] for name in ("mapping", "mapping_summary", "leave_one_out")}


def write_results(folder: Path) -> None:
    """Write every table of the made-up platform into a folder."""
    for name, (make, schema) in TABLES.items():
        write_table(make(), folder / f"{name}.parquet", schema)


def adjusted_platform() -> Platform:
    """The made-up platform with the adjustment for its noise model."""
    return platform(noise_model="adjustment", prior="hand_measured", experiments={"basin": None})


def write_adjusted_results(folder: Path) -> None:
    """Write every table of the made-up platform under the adjustment: one stage, all observations in it."""
    for name, (make, schema) in ADJUSTED.items():
        write_table(make(), folder / f"{name}.parquet", schema)
    told = {"pareto_shape": 0.3, "least_eigenvalue": 0.9, "disagreement_sigmas": 0.5, "warning": "few draws"}
    whole = outliers().query("n_observations == 6").assign(accepted=True, removed=False)
    write_table(whole, folder / "outliers.parquet", OUTLIERS)
    write_table(optima().query("stage == 'inliers'"), folder / "optima.parquet", OPTIMA)
    write_table(pose().query("stage in ('hand_measured', 'inliers')"), folder / "pose.parquet", POSE)
    write_table(diagnostics().assign(**told), folder / "diagnostics.parquet", DIAGNOSTICS)
    for name in ("levels", "adjusted_views", "adjusted_measurements"):
        make, schema = made_up_adjustment.BESIDE[name]
        write_table(make(), folder / f"{name}.parquet", schema)

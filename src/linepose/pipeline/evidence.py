"""What the verdict rests on, gathered from a calibration and from the experiments that were run on it."""

from collections.abc import Sequence
from typing import Final

import numpy as np
import pandas as pd
import pyarrow as pa
from scipy.special import chdtri

from linepose.adjustment.thresholds import DOUBTFUL_WEIGHT
from linepose.estimation.identifiability import BOTH, DATA, PRIOR, WORDS, data_weight, decider, in_body_axes
from linepose.estimation.noise_models import noise_model
from linepose.geometry.pose import N_PARAMETERS, POSE_COLUMNS
from linepose.geometry.pose_with_covariance import PoseWithCovariance
from linepose.pipeline.adjusted_intrinsics import INTRINSICS, farthest, intrinsics_from_table
from linepose.pipeline.adjusted_schemas import LEVELS, MEASUREMENTS, VIEWS
from linepose.pipeline.calibration import HAND_MEASURED, INLIERS, Calibration
from linepose.pipeline.checks import AdjustedEvidence, DoubtfulView, Evidence, LostMeasurement
from linepose.pipeline.navigation_checks import EXACT
from linepose.pipeline.pose_tables import PoseNumber, euler_numbers, rotation_vector_numbers
from linepose.pipeline.residual_tables import intraclass_correlation
from linepose.pipeline.results import Results
from linepose.pipeline.table_checks import accepted_rows, stage_rows
from linepose.survey.body_angles import body_angles_rad
from linepose.survey.observations import AXES, VARIANCE_COLUMNS, Survey
from linepose.tables import floats, optional_floats, whole_numbers

_HALF: Final = 0.5  # of the weight: the data and the hand measurement know a number equally well
# Of the experiments' results the columns that count here: what made them stands in a room above.
_SPLITS: Final = pa.schema(optional_floats("mahalanobis"))
_LEAVE_ONE_OUT: Final = pa.schema([*whole_numbers("left_out"), *floats("influence")])


def pose_numbers(calibration: Calibration) -> list[PoseNumber]:
    """The six numbers of the pose beside the hand measurement, and the truth where it is known."""
    return rotation_vector_numbers(
        calibration.estimate, _by_hand(calibration), calibration.true_pose, hand_counts(calibration)
    )


def angles(calibration: Calibration) -> list[PoseNumber]:
    """Roll, pitch and yaw beside the hand measurement, as `euler_numbers`."""
    return euler_numbers(calibration.estimate, _by_hand(calibration), calibration.true_pose, hand_counts(calibration))


def _by_hand(calibration: Calibration) -> PoseWithCovariance:
    return PoseWithCovariance(calibration.hand_measured.pose, calibration.hand_measured.covariance)


def hand_counts(calibration: Calibration) -> bool:
    """Whether the hand measurement is a prior that the estimate has counted in."""
    if calibration.platform is None:
        return bool(calibration.diagnostics["disagreement_sigmas"].notna().any())  # told only where it is a prior
    return calibration.platform.prior == HAND_MEASURED


def gather_evidence(calibration: Calibration) -> Evidence:
    """The numbers that the verdict rests on, all of the accepted observations."""
    results, numbers = calibration.results, pose_numbers(calibration)
    optimum = _accepted_stage(calibration.optima, results, "optima").iloc[0]
    chain = _accepted_stage(calibration.diagnostics, results, "diagnostics")
    residuals = _accepted_stage(calibration.residuals, results, "residuals")
    outliers = calibration.outlier_removal
    accepted = accepted_rows(outliers)
    worst = accepted.loc[accepted["error_px"].idxmax()]
    farthest_by_hand = max([*numbers, *angles(calibration)], key=lambda number: abs(number.difference_sigmas))
    decided = _decided(calibration)
    wrong = max(numbers, key=lambda number: abs(number.error_sigmas or 0.0))
    most_influential, influence = _influence(results)
    return Evidence(
        n_observations=int(outliers["n_observations"].max()),
        n_accepted=len(accepted),
        converged=bool(optimum["converged"]),
        n_steps=int(calibration.samples["step"].max()) + 1,
        autocorrelation_time=float(chain["autocorrelation_time"].max()),
        split_r_hat=float(chain["split_r_hat"].max()),
        reduced_chi_square=float(optimum["reduced_chi_square"]),
        intraclass_correlation=max(
            intraclass_correlation(residuals, column) for column in ("error_u_px", "error_v_px")
        ),
        tilt_spread_deg=tilt_spread_deg(calibration.survey().select(calibration.inliers)),
        worst_observation=int(worst["observation"]),
        worst_error_px=float(worst["error_px"]),
        threshold_px=calibration.threshold_px,
        hand_sigmas=abs(farthest_by_hand.difference_sigmas),
        hand_parameter=farthest_by_hand.name,
        adjusted=None if noise_model(calibration.noise_model).removes_outliers else _adjusted(results, chain),
        undecided=tuple(decided[PRIOR]),
        decided_by_both=tuple(decided[BOTH]),
        sigma_factor=_sigma_factor(results),
        most_influential=most_influential,
        influence=influence,
        truth_sigmas=None if wrong.error_sigmas is None else abs(wrong.error_sigmas),
        truth_parameter=wrong.name,
        noise_model=calibration.noise_model,
        hand_counts=hand_counts(calibration),
        exact_axes=exact_axes(calibration.observations, calibration.inliers),
    )


def tilt_spread_deg(survey: Survey) -> float:
    """RMS distance of the observations' (roll, pitch) from their mean, in degrees."""
    tilt = np.degrees(body_angles_rad(survey)[:, :2])
    return float(np.sqrt(np.mean(np.sum((tilt - tilt.mean(axis=0)) ** 2, axis=1))))


def exact_axes(observations: pd.DataFrame, accepted: Sequence[int]) -> tuple[str, ...]:
    """Axes of the body pose that any accepted measurement reports with a sigma of next to nothing."""
    variance = observations.loc[observations["observation"].isin(accepted), list(VARIANCE_COLUMNS)]
    exact = (variance < np.square(EXACT)).any().to_numpy()
    return tuple(axis for axis, one in zip(AXES, exact, strict=True) if one)


def _accepted_stage(table: pd.DataFrame, results: Results, name: str) -> pd.DataFrame:
    return stage_rows(table, INLIERS, [], f"{results.name}/{name}.parquet")


def _sigma_factor(results: Results) -> float | None:
    """What random halves want the sigmas multiplied by; None where they were not made or say nothing."""
    if not results.has("splits"):
        return None
    distance = results.table("splits", _SPLITS)["mahalanobis"].dropna()
    median = np.sqrt(chdtri(N_PARAMETERS, 0.5))  # of a chi distribution
    return float(distance.median() / median) if len(distance) else None


def _decided(calibration: Calibration) -> dict[str, list[str]]:
    """Numbers of the pose in words, with turns about the body's axes, by who decided them as in `decider`.

    Without a prior the hand measurement decides nothing: `PRIOR` are those that it knows as well as the data.
    """
    counted_in, hand = hand_counts(calibration), calibration.hand_measured.body_covariance
    names, covariance = in_body_axes(POSE_COLUMNS, calibration.estimate.pose, calibration.estimate.covariance)
    weights = data_weight(np.sqrt(np.diag(covariance)), np.sqrt(np.diag(hand)), counted_in)
    found: dict[str, list[str]] = {DATA: [], PRIOR: [], BOTH: []}
    for name, weight in zip(names, weights, strict=True):
        who = decider(weight) if counted_in else (DATA if weight > _HALF else PRIOR)
        found[who].append(WORDS.get(name, name))
    return found


def _adjusted(results: Results, chain: pd.DataFrame) -> AdjustedEvidence:
    views = results.table("adjusted_views", VIEWS)
    levels = results.table("levels", LEVELS).set_index("level")
    doubtful = views[views["fault"] != ""]
    single = results.table("adjusted_measurements", MEASUREMENTS)
    single = single[~single["observation"].isin(doubtful["observation"])]
    lost = single[single["weight"] < DOUBTFUL_WEIGHT].sort_values("weight", kind="stable")
    intrinsics = intrinsics_from_table(results.table("adjusted_intrinsics", INTRINSICS))
    parameter, moved = farthest(intrinsics)
    return AdjustedEvidence(
        float(chain["least_eigenvalue"].iloc[0]),
        float(chain["effective_sample_size"].min()),
        float(chain["pareto_shape"].iloc[0]),
        tuple(
            DoubtfulView(int(row["observation"]), float(row["weight"]), str(row["fault"]))
            for _, row in doubtful.iterrows()
        ),
        drift_known=bool(levels.loc["drift", "value"] > 0),
        navigation_error=navigation_error(levels["value"]),
        lost=tuple(
            LostMeasurement(int(observation), str(point), float(weight))
            for observation, point, weight in zip(lost["observation"], lost["point"], lost["weight"], strict=True)
        ),
        n_measurements=len(single),
        target_misfit=float(misfit) if np.isfinite(misfit := chain["target_misfit_sigmas"].iloc[0]) else None,
        camera_sigmas=moved,
        camera_parameter=parameter,
        camera_held=tuple(name for name, held in zip(intrinsics.names, intrinsics.is_held, strict=True) if held),
    )


def navigation_error(level: "pd.Series[float]") -> float:
    """The whole navigation error, in reported sigmas: that of positions, or of attitudes where it is the larger."""
    return position_error(level) * max(1.0, float(level["attitude"]))


def position_error(level: "pd.Series[float]") -> float:
    """The navigation error of positions, in reported sigmas: drift, constant and white together."""
    return float(np.sqrt(np.sum(level[["drift", "constant", "white"]].astype(float) ** 2)))


def _influence(results: Results) -> tuple[int | None, float | None]:
    if not results.has("leave_one_out"):
        return None, None
    table = results.table("leave_one_out", _LEAVE_ONE_OUT)
    most = table.loc[table["influence"].idxmax()]
    return int(most["left_out"]), float(most["influence"])

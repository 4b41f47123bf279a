"""An adjustment as the tables of a calibration: those that every noise model has, and what the errors were."""

from typing import Final

import numpy as np
import pandas as pd

from linepose.adjustment.faults import view_faults
from linepose.adjustment.levels import LEVEL_NAMES
from linepose.adjustment.reprojection import reprojection
from linepose.adjustment.result import Adjustment
from linepose.adjustment.settings import AdjustmentSection
from linepose.arrays import Floats
from linepose.estimation.adjustment_estimator import AdjustmentEstimator
from linepose.estimation.diagnostics import split_r_hat
from linepose.geometry.camera import Camera
from linepose.geometry.camera_sigmas import ALWAYS_ESTIMATED
from linepose.geometry.pose import POSE_COLUMNS, SIGMA_COLUMNS
from linepose.likelihood.base import Residuals
from linepose.pipeline.adjusted_intrinsics import AdjustedIntrinsics, intrinsics_table
from linepose.pipeline.adjusted_schemas import CORRECTION_COLUMNS, NORMALISED_COLUMNS, STAGE
from linepose.pipeline.residual_tables import point_rows, residual_rows
from linepose.pipeline.stages import LAPLACE_SIGMA_COLUMNS
from linepose.survey.hand_measured import HandMeasured
from linepose.survey.observations import Survey

_INTERVAL: Final = 1.959963984540054  # sigmas, of 95 %


def adjusted_tables(estimator: AdjustmentEstimator, seed: int) -> dict[str, pd.DataFrame]:
    """Every table of a platform's calibration by the adjustment, by the name of the workflow's result.

    No observation is removed: the one stage is called `inliers`, and weights say which views are far off.
    """
    survey, hand = estimator.survey, estimator.hand_measured
    found = estimator.adjusted(seed=seed)
    errors = reprojection(survey, estimator.camera, found, estimator.settings.line_period_s)
    return {
        "outliers": _outliers(survey, found, errors),
        "optima": _optima(survey, found),
        f"mcmc/{STAGE}": found.samples,
        "diagnostics": _diagnostics(survey, found),
        "pose": _poses(survey, found, hand),
        "residuals": residual_rows(STAGE, survey, errors),
        "estimated_points": point_rows(STAGE, survey, errors),
        **error_tables(survey, estimator.camera, found, errors, estimator.settings),
    }


def error_tables(
    survey: Survey, camera: Camera, found: Adjustment, errors: Residuals, settings: AdjustmentSection
) -> dict[str, pd.DataFrame]:
    """What the errors were: levels, intrinsics, and each view's and each measurement's corrections and weight."""
    return {
        "adjusted_intrinsics": intrinsics_table(adjusted_intrinsics(found, camera)),
        "levels": level_table(found, settings),
        "adjusted_views": view_table(survey, found, errors),
        "adjusted_measurements": measurement_table(survey, found),
    }


def level_table(found: Adjustment, settings: AdjustmentSection) -> pd.DataFrame:
    """One row a level with what holds it with 95 %, before and after the data; columns as in `LEVELS`."""
    median, log_sigma = np.asarray(settings.priors.median), np.asarray(settings.priors.log_sigma)
    return pd.DataFrame(
        {
            "level": LEVEL_NAMES,
            "value": np.asarray(found.levels),
            "low": found.level_intervals[:, 0],
            "high": found.level_intervals[:, 1],
            "prior_median": median,
            "prior_low": median * np.exp(-_INTERVAL * log_sigma),
            "prior_high": median * np.exp(_INTERVAL * log_sigma),
        }
    )


def view_table(survey: Survey, found: Adjustment, errors: Residuals) -> pd.DataFrame:
    """One row an observation: its weight, mean correction and, where it is far off, what its errors look like.

    Columns as in `VIEWS`.
    """
    seen = np.any(np.isfinite(found.corrections[..., 0]), axis=1)
    mean = np.full((survey.n_observations, 6), np.nan)
    mean[seen] = np.nanmean(found.corrections[seen], axis=1)
    return pd.DataFrame(
        {
            "observation": survey.number,
            "weight": found.view_weight,
            **dict(zip(CORRECTION_COLUMNS, mean.T, strict=True)),
            "fault": view_faults(found, errors),
        }
    )


def measurement_table(survey: Survey, found: Adjustment) -> pd.DataFrame:
    """One row a measurement: correction of its body pose, weight, normalised residual; as in `MEASUREMENTS`."""
    row, point = np.nonzero(np.isfinite(found.measurement_weight))
    return pd.DataFrame(
        {
            "observation": survey.number[row],
            "point": survey.names[point],
            "time_us": survey.time_us[row, point],
            **dict(zip(CORRECTION_COLUMNS, found.corrections[row, point].T, strict=True)),
            "weight": found.measurement_weight[row, point],
            **dict(zip(NORMALISED_COLUMNS, found.normalised[row, point].T, strict=True)),
        }
    )


def adjusted_intrinsics(found: Adjustment, camera: Camera) -> AdjustedIntrinsics:
    """The intrinsics that an adjustment found, beside those of the camera that it was given."""
    names = (*ALWAYS_ESTIMATED, *found.coefficients)
    return AdjustedIntrinsics(
        names,
        np.array([found.principal_point_px, found.focal_length_m, *found.coefficients.values()]),
        found.intrinsics_covariance,
        found.pose_by_intrinsics,
        np.array([getattr(camera, name) for name in names]),
        np.array([getattr(camera.sigmas, name) for name in names]),
    )


def _outliers(survey: Survey, found: Adjustment, errors: Residuals) -> pd.DataFrame:
    return pd.DataFrame(
        {
            "n_observations": survey.n_observations,
            "observation": survey.number,
            "error_px": np.nan_to_num(errors.mean_error_px()),
            "removed": False,
            "accepted": True,
            **_objective(found),
            **dict(zip(POSE_COLUMNS, found.pose, strict=True)),
        }
    )


def _optima(survey: Survey, found: Adjustment) -> pd.DataFrame:
    told = found.diagnostics
    row = {
        "stage": STAGE,
        "n_observations": survey.n_observations,
        **dict(zip(POSE_COLUMNS, found.pose, strict=True)),
        **dict(zip(LAPLACE_SIGMA_COLUMNS, found.sigma, strict=True)),
        **_objective(found),
        "start_neg_log_likelihood": np.nan,
        "reduced_chi_square": told.reduced_chi_squared,
        "degrees_of_freedom": told.degrees_of_freedom,
        "converged": told.converged,
    }
    return pd.DataFrame([row])


def _objective(found: Adjustment) -> dict[str, object]:
    """Half of chi squared, which decides on the pose, and the passes that it took."""
    told = found.diagnostics
    return {"neg_log_likelihood": 0.5 * told.chi_squared, "n_evaluations": told.n_passes}


def _diagnostics(survey: Survey, found: Adjustment) -> pd.DataFrame:
    told, poses = found.diagnostics, found.samples[list(POSE_COLUMNS)].to_numpy()
    board = told.board
    half = len(poses) // 2
    r_hat = split_r_hat(poses[: 2 * half].reshape(2, half, -1).swapaxes(0, 1))
    return pd.DataFrame(
        {
            "stage": STAGE,
            "n_observations": survey.n_observations,
            "parameter": POSE_COLUMNS,
            "acceptance_fraction": 1.0,
            "autocorrelation_time": 1.0,
            "effective_sample_size": told.effective_draws,
            "split_r_hat": r_hat,
            "sampled_sigma": poses.std(axis=0, ddof=1),
            "laplace_sigma": found.sigma,
            "neg_log_likelihood": 0.5 * told.chi_squared,
            "reduced_chi_square": told.reduced_chi_squared,
            "pareto_shape": told.pareto_shape,
            "least_eigenvalue": told.least_eigenvalue,
            "disagreement_sigmas": told.disagreement_sigmas,
            "sigma_without_target": np.full(len(POSE_COLUMNS), np.nan) if board is None else board.sigma_without,
            "target_misfit_sigmas": np.nan if board is None else board.misfit_sigmas,
            "warning": "; ".join(told.warnings),
        }
    )


def _poses(survey: Survey, found: Adjustment, hand: HandMeasured) -> pd.DataFrame:
    rows: list[tuple[str, Floats, Floats, dict[str, object]]] = [
        (
            "hand_measured",
            hand.pose,
            np.sqrt(np.diag(hand.covariance)),
            {"neg_log_likelihood": np.nan, "n_evaluations": 0},
        ),
        (STAGE, found.pose, found.sigma, _objective(found)),
    ]
    return pd.DataFrame(
        [
            {
                "stage": stage,
                "n_observations": survey.n_observations,
                **dict(zip(POSE_COLUMNS, pose, strict=True)),
                **dict(zip(SIGMA_COLUMNS, sigma, strict=True)),
                **rest,
            }
            for stage, pose, sigma, rest in rows
        ]
    )

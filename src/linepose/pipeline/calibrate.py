"""A calibration without the workflow: observations, camera and hand measurement in, pose and covariance out.

The stages are those of the workflow, on the accepted observations only; with the same settings the numbers are the
same to the last bit.
"""

from collections.abc import Mapping
from typing import Any, Final, Literal

import numpy as np
import pandas as pd
from pydantic import Field, NonNegativeInt, PositiveFloat, model_validator

from linepose.adjustment.known_points import KnownPoints
from linepose.adjustment.settings import AdjustmentSection
from linepose.config.platform import Platform
from linepose.config.study import Study
from linepose.errors import InputError
from linepose.estimation.adjustment_estimator import adjustment_estimator
from linepose.estimation.diagnostics import diagnose_samples
from linepose.estimation.estimator import Conditions
from linepose.estimation.noise_models import (
    DEFAULT,
    MEANINGS,
    NOISE_MODELS,
    NoiseModelName,
    likelihood_of,
    noise_model,
)
from linepose.estimation.optimise import Search
from linepose.estimation.outliers import OutlierSettings, outlier_table, reject_outliers, stage_observations
from linepose.estimation.sampling import SamplingSettings, sample, stage_seed
from linepose.geometry.camera import Camera
from linepose.geometry.pose import N_PARAMETERS
from linepose.likelihood.prior import pose_prior
from linepose.pipeline.adjusted_tables import adjusted_tables
from linepose.pipeline.calibration import Calibration
from linepose.pipeline.known_points import known_of_survey
from linepose.pipeline.residual_tables import residual_tables
from linepose.pipeline.results import Results
from linepose.pipeline.stages import (
    diagnostics_table,
    estimated_parameters,
    optimise_stages,
    pose_table,
    sample_table,
    samples_from_table,
)
from linepose.settings import Settings
from linepose.survey.covariance_rule import COVARIANCE_REMEDY, COVARIANCE_WORDS, first_unusable
from linepose.survey.hand_measured import HandMeasured
from linepose.survey.observations import (
    OBSERVATIONS,
    Survey,
    check_determined,
    covariance_matrices,
    survey_from_table,
)
from linepose.survey.point_knowledge import PointKnowledge
from linepose.survey.rows import check_time_units, checked_rows

_STAGE = "inliers"
_KINDS: Final[dict[str, tuple[type, str]]] = {
    "observations": (pd.DataFrame, "linepose.observations_from_arrays"),
    "camera": (Camera, "linepose.Camera"),
    "hand_measured": (HandMeasured, "linepose.HandMeasured"),
}
_OF_LIKELIHOODS: Final = ("threshold_px", "minimum_observations", "search", "sampling")
_OF_ADJUSTMENT: Final = ("adjustment",)


def _as_in(settings: type[Settings], key: str) -> Any:
    """The key as other settings have it: its default, range and meaning stand there."""
    return settings.model_fields[key]


class CalibrationSettings(Settings):
    """How a calibration is made; the defaults are those of config/config.yaml.

    `threshold_px`, `minimum_observations`, `search` and `sampling` are of noise models with a likelihood, `adjustment`
    of the adjustment: what the noise model makes no use of is refused.

    Examples
    --------
    >>> import linepose
    >>> linepose.CalibrationSettings(prior="none").noise_model
    'adjustment'
    """

    noise_model: NoiseModelName = Field(DEFAULT.name, description=f"The noise model. {MEANINGS}")
    prior: Literal["none", "hand_measured"] = _as_in(Platform, "prior")
    threshold_px: PositiveFloat = _as_in(OutlierSettings, "threshold_px")
    minimum_observations: int = _as_in(OutlierSettings, "minimum_observations")
    search: Search = _as_in(Study, "search")
    sampling: SamplingSettings = _as_in(Study, "sampling")
    adjustment: AdjustmentSection = _as_in(Study, "adjustment")
    seed: NonNegativeInt = _as_in(Study, "seed")

    @model_validator(mode="after")
    def _all_count(self) -> "CalibrationSettings":
        removes = noise_model(self.noise_model).removes_outliers
        foreign = _OF_ADJUSTMENT if removes else _OF_LIKELIHOODS
        defaults = type(self).model_fields
        for name in foreign:
            if getattr(self, name) != defaults[name].default:
                one_of = [one.name for one in NOISE_MODELS.values() if one.removes_outliers != removes]
                raise InputError(
                    f"CalibrationSettings: {name}",
                    f"a value, of which the noise model {self.noise_model} makes no use",
                    "none",
                    f"leave it out, or set noise_model to {' or '.join(one_of)}",
                )
        return self


def calibrate(
    observations: pd.DataFrame,
    camera: Camera,
    hand_measured: HandMeasured,
    settings: CalibrationSettings | None = None,
    name: str = "calibration",
    *,
    known_points: Mapping[str, PointKnowledge] | None = None,
) -> Calibration:
    """The camera's pose on the vehicle, and how sure it is.

    Parameters
    ----------
    observations : pandas.DataFrame
        One row for each measurement: observation, point, u_px, body pose and covariance, as `observations_from_arrays`
        and `load_observations` make it.
    camera : Camera
        Intrinsic parameters and how well they are known.
    hand_measured : HandMeasured
        The pose by tape measure (m, deg), where the search starts.
    settings : CalibrationSettings, optional
        How it is done.
    name : str, optional
        What messages and exports call the platform.
    known_points : mapping of str to PointKnowledge, optional
        What is known of points by their names, beside their measurements.

    Returns
    -------
    Calibration
        The pose (m, rad), its covariance and all that it rests on.

    Raises
    ------
    InputError
        The observations lack something, or a setting is wrong.
    EstimationError
        No set of observations agrees on a pose.

    Examples
    --------
    >>> observations = linepose.load_observations("myrobot")
    >>> camera = linepose.Camera(focal_length_m=8.2e-3, pixel_pitch_m=7.407e-6, n_pixels=648, principal_point_px=323)
    >>> by_hand = linepose.HandMeasured(position_m=(0.2, 0.0, -0.8), euler_deg=(-56.0, 0.0, -90.0))
    >>> calibration = linepose.calibrate(observations, camera, by_hand)
    >>> calibration.pose.shape, calibration.matrix.shape
    ((6,), (4, 4))
    """
    settings = CalibrationSettings() if settings is None else settings
    _check_kinds(observations=observations, camera=camera, hand_measured=hand_measured, settings=settings)
    observations = _checked(observations, camera.n_pixels)
    survey = survey_from_table(observations)
    _check_covariances(observations)
    check_determined(survey, 0 if settings.prior == "hand_measured" else N_PARAMETERS)
    if noise_model(settings.noise_model).removes_outliers:
        made = _removed_and_sampled(survey, camera, hand_measured, settings)
    else:
        made = _adjusted(survey, camera, hand_measured, settings, known_of_survey(known_points or {}, survey))
    tables = {"observations": observations, **made}
    results = Results(name, in_memory=tables)
    return Calibration(results, hand_measured, camera, settings.threshold_px, settings.noise_model)


def _adjusted(
    survey: Survey,
    camera: Camera,
    hand_measured: HandMeasured,
    settings: CalibrationSettings,
    known_points: KnownPoints | None,
) -> dict[str, pd.DataFrame]:
    conditions = Conditions(
        camera,
        hand_measured,
        settings.prior == "hand_measured",
        adjustment=settings.adjustment,
        known_points=known_points,
    )
    return adjusted_tables(adjustment_estimator(survey, conditions), settings.seed)


def _removed_and_sampled(
    survey: Survey, camera: Camera, hand_measured: HandMeasured, settings: CalibrationSettings
) -> dict[str, pd.DataFrame]:
    start, hand_covariance = hand_measured.pose, hand_measured.covariance
    prior = pose_prior(start, hand_covariance) if settings.prior == "hand_measured" else None
    likelihood = likelihood_of(settings.noise_model, survey, camera, prior)
    stages = reject_outliers(likelihood, start, settings.minimum_observations, settings.search)
    outliers = outlier_table(stages, settings.threshold_px)
    accepted = {_STAGE: stage_observations(outliers)[_STAGE]}
    optima = optimise_stages(likelihood, accepted, start, settings.search)
    names = likelihood.parameter_names
    optimum = optima.loc[0, list(names)].to_numpy(dtype=float, copy=True)
    seed = stage_seed(settings.seed, len(accepted[_STAGE]))
    chain = sample(likelihood.select(accepted[_STAGE]), optimum, seed, settings.sampling)
    samples = sample_table(chain, names)
    diagnostics = diagnose_samples(samples_from_table(samples, estimated_parameters(optima)))
    residuals, points = residual_tables(likelihood, accepted, {_STAGE: optimum})
    return {
        "outliers": outliers,
        "optima": optima,
        f"mcmc/{_STAGE}": samples,
        "diagnostics": diagnostics_table(optima, {_STAGE: diagnostics}),
        "pose": pose_table(optima, {_STAGE: diagnostics.sigma}, start, np.sqrt(np.diag(hand_covariance))),
        "residuals": residuals,
        "estimated_points": points,
    }


def _check_kinds(**given: object) -> None:
    """Raise InputError naming the first argument of `calibrate` that is of another kind."""
    for name, value in given.items():
        kind, makes = _KINDS.get(name, (CalibrationSettings, "linepose.CalibrationSettings"))
        if not isinstance(value, kind):
            raise InputError(name, f"a {type(value).__name__}", f"a {kind.__name__}", f"make it with {makes}")


def _check_covariances(observations: pd.DataFrame) -> None:
    """Raise InputError naming the first row of the observations whose covariance is none."""
    unusable = first_unusable(covariance_matrices(observations))
    if unusable is not None:
        raise InputError(f"observations, row {unusable[0]}", unusable[1], COVARIANCE_WORDS, COVARIANCE_REMEDY)


def _checked(observations: pd.DataFrame, n_pixels: int) -> pd.DataFrame:
    """The observations with the columns that may be left out; raises InputError."""
    missing = {"time_us": np.int64(0), "nav_gap_s": 0.0}
    missing = {name: value for name, value in missing.items() if name not in observations.columns}
    observations = checked_rows(observations.assign(**missing), OBSERVATIONS.names)
    off_line = np.flatnonzero(~observations["u_px"].between(-1.0, float(n_pixels)))
    if off_line.size:
        raise InputError(
            f"observations, row {off_line[0]}",
            f"u_px {observations['u_px'].iloc[off_line[0]]:g}",
            f"a pixel of the scan line, 0 to {n_pixels - 1}",
            "correct u_px, or n_pixels of the camera",
        )
    check_time_units(observations)
    return observations

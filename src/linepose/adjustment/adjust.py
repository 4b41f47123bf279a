"""The adjustment of a survey, from its observations to the posterior of the camera's pose."""

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from linepose.adjustment.assemble import Fit, assembled
from linepose.adjustment.curvature import Curvature, curvature
from linepose.adjustment.estimate import Estimate, unit_weights
from linepose.adjustment.hand_measured import HandMeasuredPrior, hand_measured, ran_off
from linepose.adjustment.heavy_tailed import with_tails
from linepose.adjustment.levels import log_from_levels
from linepose.adjustment.many_points import (
    MANY_POINTS,
    normalised_of_many,
    slopes_by_levels,
    solve_many,
    some_points,
    spread_of_many,
)
from linepose.adjustment.measurements import KnownPoints, Measurements, measurements_from_survey
from linepose.adjustment.normal import point_covariances, trailing_inverse
from linepose.adjustment.posterior import Mixture, mixture
from linepose.adjustment.residuals import normalised_residuals
from linepose.adjustment.result import Adjustment
from linepose.adjustment.settings import AdjustmentSettings, default_hand_covariance
from linepose.adjustment.start import start_points
from linepose.adjustment.state import Knowledge, state_at
from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.geometry.camera import Camera
from linepose.geometry.pose import check_pose
from linepose.survey.observations import Survey


def adjust(
    survey: Survey,
    camera: Camera,
    hand_measured_pose: ArrayLike,
    hand_covariance: ArrayLike | None = None,
    settings: AdjustmentSettings | None = None,
    known_points: KnownPoints | None = None,
    *,
    start_pose: ArrayLike | None = None,
) -> Adjustment:
    """The camera's pose with its posterior, from a hand-measured pose (6,), which is start and prior.

    With a start_pose (6,) the search begins there, and the hand measurement is the prior alone.

    hand_covariance (6, 6): of its position (m) and turn about body axes (rad); 0.1 m and 2 deg if None. Raises
    InputError for observations, covariances or sigmas of the camera that are of no use, EstimationError where no start
    leads to an estimate.
    """
    settings = settings or AdjustmentSettings()
    pose = check_pose(hand_measured_pose, "hand-measured pose")
    start = pose if start_pose is None else check_pose(start_pose, "start pose")
    _check_camera(camera)
    hand = hand_measured(
        pose, np.asarray(default_hand_covariance() if hand_covariance is None else hand_covariance, dtype=float)
    )
    measurements = measurements_from_survey(survey, camera, known_points, settings.line_period_s)
    if measurements.n_views < 2:
        raise InputError("observations", "one observation", "two or more", "add observations of the same pattern")
    knowledge = Knowledge(camera, hand if settings.hand_measured_prior else None, settings.clock_offset_sigma_s)
    if measurements.n_points <= MANY_POINTS:
        return assembled(
            survey, measurements, knowledge, *_of_all(measurements, knowledge, start, hand, settings), settings
        )
    few = measurements_from_survey(some_points(survey, settings.seed), camera, known_points, settings.line_period_s)
    fit, found, curved, spread = _of_all(few, knowledge, start, hand, settings)
    nearby = replace(
        state_at(fit.state.pose, camera, start_points(measurements, camera, fit.state.pose), len(measurements.u_px)),
        principal_point_px=fit.state.principal_point_px,
        focal_length_m=fit.state.focal_length_m,
        clock_offset_s=fit.state.clock_offset_s,
    )
    many = solve_many(
        measurements,
        knowledge,
        nearby,
        found.levels,
        unit_weights(measurements),
        tails=bool(np.any(found.weights.of_measurement != 1)),
    )
    n = knowledge.n_sought
    mode = log_from_levels(found.levels)
    spread = spread_of_many(
        spread,
        trailing_inverse(found.solution.done.upper, n),
        many.camera_covariance[-n:, -n:],
        mode,
        slopes_by_levels(measurements, knowledge, many, spread, mode),
    )
    normalised = normalised_of_many(many, measurements.n_points)
    fit = Fit(
        many.state,
        many.z,
        many.q,
        many.weights,
        normalised,
        many.chi_squared,
        many.converged and found.converged and not ran_off(hand, many.state.position_m),
        np.full((measurements.n_points, 3, 3), np.nan),
    )
    return assembled(survey, measurements, knowledge, fit, found, curved, spread, settings)


def _of_all(
    measurements: Measurements,
    knowledge: Knowledge,
    start: Floats,
    hand: HandMeasuredPrior,
    settings: AdjustmentSettings,
) -> tuple[Fit, Estimate, Curvature, Mixture]:
    """All measurements at once, where their normal equations are small."""
    found = with_tails(
        measurements,
        knowledge,
        replace(knowledge, hand=hand),
        state_at(start, knowledge.camera, start_points(measurements, knowledge.camera, start), len(measurements.u_px)),
        settings,
    )
    curved = curvature(measurements, knowledge, found.solution, found.levels, found.weights)
    spread = mixture(found.restricted, found.log_levels, curved.stretch, settings.n_draws, settings.seed)
    solution = found.solution
    fit = Fit(
        solution.state,
        solution.z,
        solution.q,
        found.weights,
        normalised_residuals(solution.done),
        solution.done.chi_squared,
        found.converged and not ran_off(hand, solution.state.position_m),
        point_covariances(solution.done.upper, measurements.n_points),
    )
    return fit, found, curved, spread


def _check_camera(camera: Camera) -> None:
    sigmas = {
        "u_px": camera.sigmas.u_px,
        "principal_point_px": camera.sigmas.principal_point_px,
        "focal_length_m": camera.sigmas.focal_length_m,
    }
    for name, value in sigmas.items():
        if not (np.isfinite(value) and value > 0):
            raise InputError(f"camera.sigmas.{name}", f"{value}", "a positive number", "give how well it is known")

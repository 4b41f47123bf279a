"""The adjustment of a survey, from its observations to the posterior of the camera's pose."""

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from linepose.adjustment.all_at_once import AllAtOnce, Fit, adjust_all
from linepose.adjustment.assemble import assembled
from linepose.adjustment.contradictions import KnownPointsFit
from linepose.adjustment.estimate import unit_weights
from linepose.adjustment.hand_measured import HandMeasuredPrior, hand_measured, ran_off
from linepose.adjustment.known_points import KnownPoints
from linepose.adjustment.levels import log_from_levels
from linepose.adjustment.many_points import (
    MANY_POINTS,
    normalised_of_many,
    slopes_by_levels,
    solve_many,
    some_points,
    spread_of_many,
)
from linepose.adjustment.measurements import Measurements, measurements_from_survey
from linepose.adjustment.normal import trailing_inverse
from linepose.adjustment.result import Adjustment
from linepose.adjustment.settings import AdjustmentSettings, default_hand_covariance
from linepose.adjustment.start import start_points
from linepose.adjustment.state import Knowledge, state_at
from linepose.adjustment.with_board import adjusted_with_board
from linepose.arrays import Floats
from linepose.errors import EstimationError, InputError
from linepose.geometry.camera import Camera
from linepose.geometry.camera_sigmas import fault_of_certain
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
    found = _adjusted(
        survey, camera, hand_measured_pose, hand_covariance, settings or AdjustmentSettings(), known_points, start_pose
    )
    if not (np.all(np.isfinite(found.pose)) and np.all(np.isfinite(found.covariance))):
        raise EstimationError(
            "adjustment: the pose or its covariance is no number; check the units of positions and covariances (m, "
            "rad), of the camera's sigmas and of those of the hand measurement"
        )
    return found


def _adjusted(
    survey: Survey,
    camera: Camera,
    hand_measured_pose: ArrayLike,
    hand_covariance: ArrayLike | None,
    settings: AdjustmentSettings,
    known_points: KnownPoints | None,
    start_pose: ArrayLike | None,
) -> Adjustment:
    pose = check_pose(hand_measured_pose, "hand-measured pose")
    start = pose if start_pose is None else check_pose(start_pose, "start pose")
    _check_camera(camera)
    hand = hand_measured(
        pose, np.asarray(default_hand_covariance() if hand_covariance is None else hand_covariance, dtype=float)
    )
    measurements = measurements_from_survey(survey, camera, known_points, settings.line_period_s)
    if measurements.n_views < 2 and not np.any(measurements.known.any):
        raise InputError("observations", "one observation", "two or more", "add observations of the same pattern")
    knowledge = Knowledge(camera, hand if settings.hand_measured_prior else None, settings.clock_offset_sigma_s)
    if known_points is not None and np.any(measurements.known.on_board):
        return adjusted_with_board(survey, known_points, measurements, knowledge, start, hand, settings)
    if measurements.n_points <= MANY_POINTS:
        return assembled(
            survey, measurements, knowledge, adjust_all(measurements, knowledge, start, hand, settings), settings
        )
    always = None if known_points is None else known_points.apart
    few = measurements_from_survey(
        some_points(survey, settings.seed, always), camera, known_points, settings.line_period_s
    )
    return _of_many(survey, measurements, few, knowledge, start, hand, settings)


def _of_many(
    survey: Survey,
    measurements: Measurements,
    few: Measurements,
    knowledge: Knowledge,
    start: Floats,
    hand: HandMeasuredPrior,
    settings: AdjustmentSettings,
) -> Adjustment:
    """Levels, curvature and weights of known points from few points, the pose from all."""
    told = adjust_all(few, knowledge, start, hand, settings)
    known = _known_of_all(measurements, few, told.known)
    measurements = replace(measurements, known=measurements.known.weighted(known.counted))
    fit, found = told.fit, told.found
    points = start_points(measurements, knowledge.camera, fit.state.pose)
    nearby = replace(
        state_at(fit.state.pose, knowledge.camera, points, measurements),
        principal_point_px=fit.state.principal_point_px,
        focal_length_m=fit.state.focal_length_m,
        lens=fit.state.lens,
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
        told.spread,
        trailing_inverse(found.solution.done.upper, n),
        many.camera_covariance[-n:, -n:],
        mode,
        slopes_by_levels(measurements, knowledge, many, told.spread, mode),
    )
    fit = Fit(
        many.state,
        many.z,
        many.q,
        many.weights,
        normalised_of_many(many, measurements.n_points),
        many.chi_squared,
        many.converged and found.converged and not ran_off(hand, many.state.position_m),
        np.full((measurements.n_points, 3, 3), np.nan),
        many.camera_covariance,
    )
    all_at_once = AllAtOnce(fit, found, told.curved, spread, known)
    return assembled(survey, measurements, knowledge, all_at_once, settings)


def _known_of_all(measurements: Measurements, few: Measurements, fitted: KnownPointsFit) -> KnownPointsFit:
    """How known points fit, from that of few points among them."""
    weight, sigmas = np.full((2, measurements.n_points), np.nan)
    rows = np.searchsorted(measurements.points, few.points)
    weight[rows], sigmas[rows] = fitted.weight, fitted.sigmas
    return KnownPointsFit(weight, sigmas)


def _check_camera(camera: Camera) -> None:
    if fault := fault_of_certain(camera.sigmas):
        raise InputError(fault.key, fault.found, fault.expected, fault.remedy)
    for name, value in camera.sigmas:
        if value is not None and not (np.isfinite(value) and value >= 0):
            raise InputError(f"camera.sigmas.{name}", f"{value}", "a number of 0 or more", "give how well it is known")

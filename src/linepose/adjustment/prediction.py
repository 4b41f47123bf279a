"""The covariance that an adjustment will come to, from the normal equations of a survey's geometry."""

from typing import Final

import numpy as np

from linepose.adjustment.estimate import unit_weights
from linepose.adjustment.hand_measured import hand_measured
from linepose.adjustment.known_points import KnownPoints
from linepose.adjustment.levels import Levels
from linepose.adjustment.many_points import covariance_of_many
from linepose.adjustment.measurements import measurements_from_survey
from linepose.adjustment.normal import N_POSE, trailing_inverse
from linepose.adjustment.solve import model_at, pass_at
from linepose.adjustment.state import Knowledge, state_at
from linepose.arrays import Floats
from linepose.errors import EstimationError
from linepose.geometry.camera import Camera
from linepose.survey.observations import Survey

_DENSE_POINTS: Final = 60  # above which conjugate gradients are the faster way


def predicted_covariance(
    survey: Survey,
    camera: Camera,
    pose: Floats,
    points_m: Floats,
    levels: Levels,
    hand_covariance: Floats | None = None,
    known_points: KnownPoints | None = None,
    line_period_s: float | None = None,
) -> Floats:
    """Covariance (6, 6) of position (m) and small turns about the body's axes (rad) of a camera at a pose (6,).

    The survey's pixels need not be right: its body poses, covariances and times count. points_m (M, 3): from the
    survey's origin; hand_covariance (6, 6): of a hand measurement that counts as a prior; known_points: what is
    known of all M. Raises EstimationError where a point lies behind the camera or the geometry leaves a direction open.
    """
    measurements = measurements_from_survey(survey, camera, known_points, line_period_s)
    hand = None if hand_covariance is None else hand_measured(pose, hand_covariance)
    state = state_at(pose, camera, np.ascontiguousarray(points_m[measurements.points]), measurements)
    knowledge, used = Knowledge(camera, hand), levels if measurements.timed else levels._replace(drift=0.0)
    if measurements.n_points > _DENSE_POINTS and not np.any(measurements.known.on_board):
        return covariance_of_many(measurements, knowledge, state, used)[-N_POSE:, -N_POSE:]
    model = model_at(measurements, knowledge, state)
    if model is None:
        raise EstimationError("predicted sigmas: a point lies behind the camera; correct the hand-measured pose")
    _, done = pass_at(measurements, model, used, unit_weights(measurements))
    if not np.isfinite(done.log_determinant):
        raise EstimationError("predicted sigmas: the geometry leaves a direction of the pose open")
    return trailing_inverse(done.upper, N_POSE)

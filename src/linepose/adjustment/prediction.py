"""The covariance that an adjustment will come to, from the normal equations of a survey's geometry."""

import numpy as np

from linepose.adjustment.estimate import unit_weights
from linepose.adjustment.hand_measured import hand_measured
from linepose.adjustment.levels import Levels
from linepose.adjustment.measurements import measurements_from_survey
from linepose.adjustment.normal import N_POSE, trailing_inverse
from linepose.adjustment.solve import model_at, pass_at
from linepose.adjustment.state import Knowledge, state_at
from linepose.arrays import Floats
from linepose.errors import EstimationError
from linepose.geometry.camera import Camera
from linepose.survey.observations import Survey


def predicted_covariance(
    survey: Survey,
    camera: Camera,
    pose: Floats,
    points_m: Floats,
    levels: Levels,
    hand_covariance: Floats | None = None,
) -> Floats:
    """Covariance (6, 6) of position (m) and small turns about the body's axes (rad) of a camera at a pose (6,).

    The survey's pixels need not be right: its body poses, covariances and times count. points_m (M, 3): from the
    survey's origin; hand_covariance (6, 6): of a hand measurement that counts as a prior. Raises EstimationError where
    a point lies behind the camera or the geometry leaves a direction open.
    """
    measurements = measurements_from_survey(survey, camera)
    hand = None if hand_covariance is None else hand_measured(pose, hand_covariance)
    state = state_at(pose, camera, np.ascontiguousarray(points_m[measurements.points]), measurements)
    model = model_at(measurements, Knowledge(camera, hand), state)
    if model is None:
        raise EstimationError("predicted sigmas: a point lies behind the camera; correct the hand-measured pose")
    used = levels if measurements.timed else levels._replace(drift=0.0)
    _, done = pass_at(measurements, model, used, unit_weights(measurements))
    if not np.isfinite(done.log_determinant):
        raise EstimationError("predicted sigmas: the geometry leaves a direction of the pose open")
    return trailing_inverse(done.upper, N_POSE)

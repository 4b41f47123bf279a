"""The pose at given levels, with heavy tails: in a second for thousands of measurements, wrong ones among them."""

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from linepose.adjustment.estimate import unit_weights
from linepose.adjustment.hand_measured import hand_measured
from linepose.adjustment.levels import START, Levels
from linepose.adjustment.many_points import solve_many
from linepose.adjustment.measurements import measurements_from_survey
from linepose.adjustment.normal import N_POSE
from linepose.adjustment.result import gridded
from linepose.adjustment.start import start_points
from linepose.adjustment.state import Knowledge, state_at
from linepose.arrays import Floats
from linepose.geometry.camera import Camera
from linepose.geometry.pose import check_pose
from linepose.survey.observations import Survey

_LEVELS: Final = START


@dataclass(frozen=True)
class PoseAtLevels:
    """Pose (6,) with the covariance (6, 6) of its position (m) and turn about body axes (rad), as the levels say it.

    points_m (M, 3): from the survey's origin, NaN for a point left out; measurement_weight (N, M): towards 0 is bad,
    NaN where there is no measurement; converged.
    """

    pose: Floats
    covariance: Floats
    points_m: Floats
    measurement_weight: Floats
    converged: bool


def pose_at_levels(
    survey: Survey,
    camera: Camera,
    hand_measured_pose: ArrayLike,
    hand_covariance: ArrayLike,
    levels: Levels = _LEVELS,
    line_period_s: float | None = None,
) -> PoseAtLevels:
    """The pose of a survey from above, from a hand-measured pose (6,) with covariance (6, 6), which is start and prior.

    Raises InputError for observations of no use, EstimationError where it cannot be solved.
    """
    pose = check_pose(hand_measured_pose, "hand-measured pose")
    hand = hand_measured(pose, np.asarray(hand_covariance, dtype=float))
    measurements = measurements_from_survey(survey, camera, None, line_period_s)
    knowledge = Knowledge(camera, hand, None)
    levels = levels if measurements.timed else levels._replace(drift=0.0)
    start = state_at(pose, camera, start_points(measurements, camera, pose), measurements)
    found = solve_many(measurements, knowledge, start, levels, unit_weights(measurements), tails=True)
    points = np.full((survey.n_points, 3), np.nan)
    points[measurements.points] = found.state.points_m
    weight = gridded(found.weights.of_measurement, measurements.row, measurements.column, survey.u_px.shape)
    covariance = found.camera_covariance[-N_POSE:, -N_POSE:]
    return PoseAtLevels(found.state.pose, covariance, points, weight, found.converged)

"""The score of the pose at the truth: what the estimate is where it is zero must be zero on the mean."""

import numpy as np
import pytest

from linepose.adjustment.estimate import unit_weights
from linepose.adjustment.levels import Levels
from linepose.adjustment.measurements import measurements_from_survey
from linepose.adjustment.normal import N_POSE
from linepose.adjustment.solve import solve
from linepose.adjustment.start import start_points
from linepose.adjustment.state import Knowledge, state_at
from unit.adjustment import timed_survey

N_SURVEYS = 60
CAMERA, POSE = timed_survey.CAMERA, timed_survey.POSE
ERRORS = timed_survey.Errors()
LEVELS = Levels(
    ERRORS.drift, ERRORS.white, ERRORS.constant, ERRORS.pixel, ERRORS.lateness, ERRORS.correlation_time_s, 1.0
)


def normal_score(seed):
    """Score (6,) of the pose at the truth and the true levels, in units of the root of the normal equations."""
    survey = timed_survey.make_survey(10, 8, ERRORS, seed=seed)
    m = measurements_from_survey(survey, CAMERA, line_period_s=timed_survey.LINE_S)
    start = state_at(POSE, CAMERA, start_points(m, CAMERA, POSE), m)
    done = solve(m, Knowledge(CAMERA, None), start, LEVELS, unit_weights(m), tolerance=1e-8, n_held=N_POSE).done
    n = len(done.upper) - 1
    return done.upper[n - N_POSE : n, n]


@pytest.mark.statistical
def test_no_bias_and_unit_variance_at_the_true_levels():
    scores = np.array([normal_score(7000 + k) for k in range(N_SURVEYS)])
    standard_error = scores.std(axis=0, ddof=1) / np.sqrt(N_SURVEYS)
    assert np.all(np.abs(scores.mean(axis=0)) < 3 * standard_error)
    # mean square of 360 numbers, four standard errors; intrinsics that are not drawn take a little of it
    assert np.mean(scores**2) == pytest.approx(1.0, abs=4 * np.sqrt(2 / scores.size))

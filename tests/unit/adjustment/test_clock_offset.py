"""The clock offset as one more parameter of the adjustment."""

from dataclasses import replace

import numpy as np
import pytest

from linepose.adjustment import AdjustmentSettings, adjust
from linepose.adjustment.estimate import unit_weights
from linepose.adjustment.levels import Levels
from linepose.adjustment.many_points import solve_many
from linepose.adjustment.measurements import measurements_from_survey
from linepose.adjustment.motion import body_rates
from linepose.adjustment.normal import trailing_inverse
from linepose.adjustment.solve import model_at, solve
from linepose.adjustment.start import start_points
from linepose.adjustment.state import Knowledge, state_at
from unit.adjustment import timed_survey

CAMERA, POSE = timed_survey.CAMERA, timed_survey.POSE
SPEEDS = (1.0, -1.2, 0.4, -0.6)
SETTINGS = AdjustmentSettings(line_period_s=timed_survey.LINE_S, n_draws=60, n_samples=200)
SOUGHT = SETTINGS.replaced(clock_offset_sigma_s=0.02)
LEVELS = Levels(0.4, 0.1, 0.4, 0.5, 0.5, 30.0, 1.0)


def there_and_back(offset_s, seed=51):
    return timed_survey.make_survey(12, 8, seed=seed, speeds_m_s=SPEEDS, clock_offset_s=offset_s)


@pytest.fixture(scope="module")
def agreeing():
    return there_and_back(0.0)


def solved(survey, sigma_s):
    m = measurements_from_survey(survey, CAMERA, line_period_s=timed_survey.LINE_S)
    start = state_at(POSE, CAMERA, start_points(m, CAMERA, POSE), m)
    knowledge = Knowledge(CAMERA, None, sigma_s)
    return m, knowledge, start, solve(m, knowledge, start, LEVELS, unit_weights(m), tolerance=1e-10)


def test_rates_are_those_of_the_views_own_poses(agreeing):
    m = measurements_from_survey(agreeing, CAMERA)
    speed = np.linalg.norm(m.rate[:, :3], axis=1)
    # errors of a centimetre over a second of a view
    assert np.allclose(speed, np.abs(SPEEDS)[m.view % 4], atol=0.05)
    assert np.isnan(body_rates(m.body_pose, np.zeros(len(m.view), dtype=np.int64), m.view)).all()


def test_the_column_is_the_derivative_of_the_residual_by_the_offset(agreeing):
    m = measurements_from_survey(agreeing, CAMERA)
    knowledge = Knowledge(CAMERA, None, 0.02)
    state = state_at(POSE, CAMERA, start_points(m, CAMERA, POSE), m)
    step_s = 1e-4
    ahead, behind = (
        model_at(m, knowledge, replace(state, clock_offset_s=0.003 + sign * step_s)).linearised.residual_px
        for sign in (1, -1)
    )
    column = model_at(m, knowledge, replace(state, clock_offset_s=0.003)).linearised.by_theta[..., 9]
    # the third derivative times a square of 0.1 mm
    assert np.allclose(-(ahead - behind) / (2 * step_s), column, rtol=1e-6, atol=1e-6 * np.abs(column).max())


def test_the_offset_of_a_step_is_the_one_that_is_held_best(agreeing):
    """The minimum over all columns is that of the profile over the offset, and its sigma the profile's curvature."""
    m, _, _, found = solved(there_and_back(0.005), 0.02)
    variance = trailing_inverse(found.done.upper, 7)[0, 0]
    offsets = found.state.clock_offset_s + np.sqrt(variance) * np.array([-0.3, 0.0, 0.3])
    chi_squared = [_held(m, offset_s, found.state) for offset_s in offsets]
    prior = (offsets / 0.02) ** 2
    total = np.array(chi_squared) + prior
    assert total[1] == pytest.approx(found.done.chi_squared, abs=1e-5)
    assert total[0] - total[1] == pytest.approx(0.09, rel=0.1)
    assert total[2] - total[1] == pytest.approx(0.09, rel=0.1)


def _held(m, offset_s, state):
    """Least chi squared with bodies moved to an offset, which is then no parameter."""
    moved = replace(m, body_pose=m.body_pose + offset_s * m.rate)
    start = replace(state, clock_offset_s=0.0)
    return solve(moved, Knowledge(CAMERA, None), start, LEVELS, unit_weights(m), tolerance=1e-10).done.chi_squared


@pytest.mark.parametrize("offset_s", [0.005, 0.020])
def test_a_planted_offset_comes_back(offset_s):
    found = adjust(there_and_back(offset_s), CAMERA, POSE, settings=SOUGHT)
    assert abs(found.clock_offset_s - offset_s) < 3 * found.clock_offset_sigma_s
    assert found.clock_offset_sigma_s < 0.003
    error = found.pose - POSE
    assert error @ np.linalg.solve(found.covariance, error) < 22.5  # chi squared of six, 99.9 %
    assert found.diagnostics.least_eigenvalue > 0.3
    assert found.diagnostics.clock_known


def test_an_offset_that_is_not_allowed_for_is_worse():
    survey = there_and_back(0.020)
    without, found = (adjust(survey, CAMERA, POSE, settings=one) for one in (SETTINGS, SOUGHT))
    assert np.isnan(without.clock_offset_s)
    assert np.isnan(without.clock_offset_sigma_s)
    assert np.prod(found.sigma) < np.prod(without.sigma)


def test_clocks_that_are_known_to_agree_leave_the_pose_as_it_is(agreeing):
    without = adjust(agreeing, CAMERA, POSE, settings=SETTINGS)
    held = adjust(agreeing, CAMERA, POSE, settings=SETTINGS.replaced(clock_offset_sigma_s=1e-9))
    # chi squared ends within 1e-6 of its minimum, a thousandth of a sigma
    assert np.all(np.abs(held.pose - without.pose) < 5e-3 * without.sigma)
    assert np.allclose(held.sigma, without.sigma, rtol=0.01)
    assert held.clock_offset_s == pytest.approx(0.0, abs=1e-9)
    assert held.clock_offset_sigma_s == pytest.approx(1e-9, rel=0.01)
    assert not held.diagnostics.clock_known
    assert any("clock offset to its prior" in line for line in held.diagnostics.warnings)


def test_one_speed_leaves_the_offset_to_the_lever_arm():
    found = adjust(timed_survey.make_survey(12, 8, seed=21), CAMERA, POSE, settings=SOUGHT)
    assert found.clock_offset_sigma_s == pytest.approx(0.02, rel=0.1)
    assert not found.diagnostics.clock_known


def test_without_times_there_is_no_rate_and_the_offset_stays_open(agreeing):
    found = adjust(replace(agreeing, time_us=np.zeros_like(agreeing.time_us)), CAMERA, POSE, settings=SOUGHT)
    assert found.clock_offset_s == 0
    assert found.clock_offset_sigma_s == pytest.approx(0.02, rel=1e-6)


def test_many_points_find_the_same_offset():
    m, knowledge, start, few = solved(there_and_back(0.005), 0.02)
    many = solve_many(m, knowledge, start, LEVELS, unit_weights(m))
    sigma = np.sqrt(trailing_inverse(few.done.upper, 7)[0, 0])
    assert many.state.clock_offset_s == pytest.approx(few.state.clock_offset_s, abs=3e-3 * sigma)
    assert np.sqrt(many.camera_covariance[3, 3]) == pytest.approx(sigma, rel=1e-3)

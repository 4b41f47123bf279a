"""Many points: conjugate gradients find what the dense normal equations do."""

import numpy as np
import pytest

from linepose.adjustment import AdjustmentSettings, adjust
from linepose.adjustment import adjust as adjust_module
from linepose.adjustment.estimate import unit_weights
from linepose.adjustment.iterative import Preconditioner, Smooth, blocks, conjugate_gradients, equations, smooth
from linepose.adjustment.levels import levels_from_log, log_from_levels
from linepose.adjustment.many_points import slopes_by_levels, solve_many, spread_of_many
from linepose.adjustment.normal import solve_step, trailing_inverse
from linepose.adjustment.posterior import Mixture
from linepose.adjustment.solve import solve
from linepose.adjustment.state import camera_step
from unit.adjustment import timed_survey
from unit.adjustment.test_against_dense import LEVELS, Case


@pytest.fixture(scope="module")
def case():
    return Case(LEVELS)


def test_step_and_covariance_of_the_normal_equations(case):
    system = equations(case.model.linearised, case.measurements.point, case.done.factor, case.model.prior)
    inverse = Preconditioner(blocks(system), smooth(system, case.state.points_m))
    right = system.right_side(case.e.reshape(-1, 2))
    assert np.allclose(right, case.right, rtol=1e-9, atol=1e-9 * np.abs(case.right).max())
    columns = np.array([system.times_normal(column) for column in np.eye(len(case.right))])
    assert np.allclose(columns, case.normal, rtol=0, atol=1e-9 * np.abs(case.normal).max())
    step, _ = conjugate_gradients(system, inverse, right, 1e-12)
    sigma = np.sqrt(np.diag(np.linalg.inv(case.normal)))
    dense_step = solve_step(case.done.upper, 3 * case.measurements.n_points, 0.0)
    assert np.allclose((step - dense_step) / sigma, 0, atol=1e-6)


def test_the_same_optimum_and_covariance(case):
    weights = unit_weights(case.measurements)
    many = solve_many(case.measurements, case.knowledge, case.state, LEVELS, weights)
    few = solve(case.measurements, case.knowledge, case.state, LEVELS, weights, tolerance=1e-9)
    covariance = trailing_inverse(few.done.upper, 10)
    sigma = np.sqrt(np.diag(covariance))
    assert many.converged
    # a chi squared of 1e-6 above the minimum is a thousandth of a sigma
    assert np.all(np.abs(many.state.pose - few.state.pose) < 3e-3 * sigma[-6:])
    assert np.allclose(many.camera_covariance / np.outer(sigma, sigma), covariance / np.outer(sigma, sigma), atol=1e-3)
    assert np.allclose(many.state.correction / timed_survey.SIGMA, few.state.correction / timed_survey.SIGMA, atol=5e-3)


def test_smooth_displacements_save_most_iterations():
    survey = timed_survey.make_survey(8, 300, timed_survey.Errors(constant=1.0, drift=1.0), seed=42)
    case = Case(LEVELS._replace(white=0.01, pixel=0.2, lateness=0.02), survey=survey, with_dense=False)
    system = equations(case.model.linearised, case.measurements.point, case.done.factor, case.model.prior)
    parts = blocks(system), smooth(system, case.state.points_m)
    none = Smooth(np.zeros((3 * 300 + 10, 1)), np.zeros((1, 1)))
    right = system.right_side(case.model.linearised.residual_px)
    (one, many), (other, few) = (
        conjugate_gradients(system, Preconditioner(parts[0], part), right, 1e-7) for part in (none, parts[1])
    )
    assert few < 0.5 * many
    assert (one - other) @ system.times_normal(one - other) < 1e-12 * (one @ right)


def test_an_adjustment_of_many_points(monkeypatch):
    module = __import__("sys").modules[adjust_module.__module__]
    survey = timed_survey.make_survey(10, 12, seed=41)
    settings = AdjustmentSettings(line_period_s=timed_survey.LINE_S, n_draws=60, n_samples=200)
    few = adjust(survey, timed_survey.CAMERA, timed_survey.POSE, settings=settings)
    monkeypatch.setattr(module, "MANY_POINTS", 11)
    many = adjust(survey, timed_survey.CAMERA, timed_survey.POSE, settings=settings)
    assert np.all(np.abs(many.pose - few.pose) < 0.2 * few.sigma)
    assert np.allclose(many.sigma, few.sigma, rtol=0.15)
    assert many.diagnostics.converged


def test_the_pose_follows_the_levels_as_the_dense_solution_does(case):
    """Half of each draw a twentieth up and half of it down: sigmas of 0.05, and one level that is not estimated."""
    weights, mode, n = unit_weights(case.measurements), log_from_levels(LEVELS), case.knowledge.n_sought
    many = solve_many(case.measurements, case.knowledge, case.state, LEVELS, weights)
    signs = np.array([[1.0], [-1.0]]) * np.array([0.05] * 6 + [0.0])
    draws = Mixture(np.full(2, 0.5), np.zeros((2, n)), np.tile(np.eye(n), (2, 1, 1)), mode + signs, np.zeros(2), 0.0)
    slopes = slopes_by_levels(case.measurements, case.knowledge, many, draws, mode)
    assert slopes.shape == (7, n)
    np.testing.assert_array_equal(slopes[6], 0.0)
    sigma = np.sqrt(np.diag(many.camera_covariance))[-n:]
    for index in range(6):
        moved = mode.copy()
        moved[index] += 0.05
        ends = [
            solve(case.measurements, case.knowledge, case.state, levels, weights, tolerance=1e-12).state
            for levels in (LEVELS, levels_from_log(moved))
        ]
        expected = camera_step(*ends)[-n:] / 0.05
        # each solution stops within a thousandth of a sigma or so
        np.testing.assert_allclose(slopes[index] / sigma, expected / sigma, atol=0.1)
    spread = spread_of_many(draws, np.eye(n), 4 * np.eye(n), mode, slopes)
    np.testing.assert_allclose(spread.mean, signs @ slopes)
    np.testing.assert_allclose(spread.covariance[0], 4 * np.eye(n))

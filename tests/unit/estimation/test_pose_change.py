"""The test of a move: its p-values, its power, and what is not seen, on draws from the linear model itself."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from linepose.estimation.pose_change import (
    FALSE_ALARMS,
    GROUPS,
    POWER,
    SCALE,
    WHOLE,
    change_of_estimates,
    change_of_shrunk,
)

N_DRAWS = 300
ERROR = 4 * np.sqrt(0.25 / N_DRAWS)  # four standard errors of a share


@pytest.fixture
def covariance():
    """Of a difference of two estimates whose errors are correlated, in the units of moves."""
    mixed = np.random.default_rng(1).standard_normal((6, 6))
    return (mixed @ mixed.T + np.eye(6)) * np.outer(SCALE, SCALE) * 0.01


def drawn(covariance, move=None):
    noise = np.random.default_rng(2).standard_normal((N_DRAWS, 6)) @ np.linalg.cholesky(covariance).T
    return noise + (0 if move is None else move)


@pytest.mark.statistical
def test_alarms_without_a_move_are_as_often_as_asked_for(covariance):
    changes = [change_of_estimates(one, covariance) for one in drawn(covariance)]
    for group in GROUPS:
        p = np.array([change.test(group).p_value for change in changes])
        assert_allclose([np.mean(p < share) for share in (0.05, 0.5)], [0.05, 0.5], atol=ERROR)


@pytest.mark.statistical
def test_the_least_move_is_found_as_often_as_stated(covariance):
    axis = 4
    move = change_of_estimates(np.zeros(6), covariance).least_seen()[axis] * np.eye(6)[axis]
    p = [change_of_estimates(one, covariance).test(WHOLE).p_value for one in drawn(covariance, move)]
    assert_allclose(np.mean(np.array(p) < FALSE_ALARMS), POWER, atol=ERROR)


def test_move_and_covariance_are_those_of_the_difference(covariance):
    difference = np.arange(1, 7) * SCALE
    change = change_of_estimates(difference, covariance)
    assert_allclose(change.move, difference)
    assert_allclose(change.covariance, covariance, rtol=1e-9)
    whole = change.test(WHOLE)
    assert whole.degrees_of_freedom == 6
    assert_allclose(whole.distance**2, difference @ np.linalg.solve(covariance, difference))


def test_a_prior_that_shrinks_the_second_estimate_takes_nothing_from_the_move(covariance):
    seen = np.linalg.inv(covariance @ np.diag(SCALE**-2) + np.eye(6))
    difference = np.arange(1, 7) * SCALE
    shrunk = change_of_shrunk(seen @ difference, seen @ covariance @ seen.T, seen)
    assert_allclose(shrunk.move, difference, rtol=1e-6)
    assert_allclose(shrunk.covariance, covariance, rtol=1e-6)


def test_what_is_not_seen_is_told_and_not_tested(covariance):
    seen = np.diag([1.0, 1.0, 0.0, 1.0, 1.0, 1.0])
    difference = np.array([0.0, 0.0, 0.2, 0.0, 0.0, 0.0])
    change = change_of_shrunk(seen @ difference, seen @ covariance @ seen, seen)
    assert change.test(WHOLE).degrees_of_freedom == 5
    assert change.test("lever arm").degrees_of_freedom == 2
    assert change.least_seen()[2] == np.inf
    assert np.all(np.isfinite(change.least_seen()[[0, 1, 3, 4, 5]]))
    assert abs(change.move[2]) < 1e-9
    assert change.test(WHOLE).p_value > 0.99


def test_views_that_see_nothing_raise_no_alarm():
    change = change_of_shrunk(np.zeros(6), np.zeros((6, 6)), np.zeros((6, 6)))
    assert change.test(WHOLE).p_value == 1.0
    assert np.all(np.isinf(change.least_seen()))

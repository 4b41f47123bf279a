"""The optimum of models with levels: gradients end where Powell's method over all parameters does."""

import numpy as np
import pytest
from linepose.likelihood.robust import RobustSharedLikelihood
from linepose.likelihood.shared import SharedLikelihood
from scipy.optimize import minimize

from linepose.errors import EstimationError
from linepose.estimation.optimise import Search, bounded, laplace_covariance, minimise, optimise
from unit.likelihood.small_survey import CAMERA, POSE, Truth, make_survey

START = POSE + np.array([0.05, -0.05, 0.04, 0.03, -0.02, 0.02])


@pytest.fixture(scope="module")
def likelihood():
    return SharedLikelihood(make_survey(8, 6, Truth(0.5, 0.1, 1.0), seed=3), CAMERA)


@pytest.fixture(scope="module")
def found(likelihood):
    return optimise(likelihood, START)


def test_it_is_the_optimum_of_powells_method_over_all_parameters(likelihood, found):
    centre, half_width = likelihood.start(START), likelihood.half_widths(2.0, np.pi)

    def objective(unbounded):
        return min(-likelihood.log_likelihood(bounded(unbounded, centre, half_width)), 1e300)

    powell = minimize(objective, np.zeros(11), method="Powell", options={"xtol": 1e-5, "ftol": 1e-9})
    assert found.converged
    assert found.neg_log_likelihood == -likelihood.log_likelihood(found.parameters)
    # Powell stops a hair short of the minimum, or not: to 1e-3 in -log L, some hundredths of a sigma
    assert found.neg_log_likelihood < powell.fun + 1e-6
    assert found.neg_log_likelihood == pytest.approx(powell.fun, abs=1e-3)
    sigma = np.sqrt(np.diag(laplace_covariance(likelihood, found.parameters)))
    assert np.all(np.abs(found.parameters - bounded(powell.x, centre, half_width)) < 0.05 * sigma)
    assert found.n_evaluations < powell.nfev


def test_the_curvature_is_that_of_plain_second_differences(likelihood, found):
    covariance = laplace_covariance(likelihood, found.parameters)
    sigma = np.sqrt(np.diag(covariance))
    information = np.linalg.inv(covariance / np.outer(sigma, sigma))
    step = 0.02
    for i in range(11):
        move = np.zeros(11)
        move[i] = step * sigma[i] / np.sqrt(information[i, i])
        values = [-likelihood.log_likelihood(found.parameters + sign * move) for sign in (1, 0, -1)]
        second = (values[0] - 2 * values[1] + values[2]) / step**2
        # of 1, to the fourth derivative's share at a fiftieth of a sigma and to rounding, 1e-10 / step^2
        assert second == pytest.approx(1.0, abs=0.01)


def test_climbing_from_nearby_ends_at_the_same_optimum(likelihood, found):
    sigma = np.sqrt(np.diag(laplace_covariance(likelihood, found.parameters)))
    again = minimise(likelihood, found.parameters + 0.5 * sigma * np.random.default_rng(1).choice([-1, 1], 11), START)
    assert again.neg_log_likelihood == pytest.approx(found.neg_log_likelihood, abs=1e-4)
    assert again.n_evaluations < found.n_evaluations


def test_the_robust_model_starts_at_the_optimum_without_tails(likelihood):
    robust = RobustSharedLikelihood(likelihood.survey, CAMERA)
    assert type(robust.surrogate()) is SharedLikelihood
    end = optimise(robust, START)
    assert end.converged
    assert end.neg_log_likelihood < -robust.log_likelihood(optimise(likelihood, START).parameters)


def test_a_start_from_which_nothing_is_seen_is_not_called_converged(likelihood):
    away = np.array([*POSE[:3], 2.2, 2.1, -1.0])
    end = optimise(likelihood, away, Search(half_width_m=1e-3, half_width_deg=0.06))
    assert not end.converged
    with pytest.raises(EstimationError, match="undefined"):
        laplace_covariance(likelihood, end.parameters)

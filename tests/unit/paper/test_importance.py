import numpy as np
import pytest
from scipy.stats import genpareto, multivariate_normal

from linepose.errors import EstimationError
from linepose.paper.importance import WeightedSamples, importance_samples, pareto_smoothed

MEAN = np.array([0.1, -0.2, 0.3, 0.0, 0.5, -0.4])
FACTOR = np.tril(np.random.default_rng(4).normal(0, 0.4, (6, 6)), -1) + np.diag([1.0, 0.1, 2.0, 0.5, 0.01, 1.0])
COVARIANCE = FACTOR @ FACTOR.T


def gaussian(function_likelihood):
    target = multivariate_normal(MEAN, COVARIANCE)
    return function_likelihood(lambda rows: -target.logpdf(rows))


@pytest.mark.statistical
@pytest.mark.parametrize("scale", [0.6, 1.0, 2.5])
def test_known_target_from_a_wrong_proposal(function_likelihood, scale):
    random = np.random.default_rng(1)
    start = MEAN + 0.3 * FACTOR.sum(axis=1)
    samples = importance_samples(gaussian(function_likelihood), start, scale**2 * COVARIANCE, random, 4000)
    size = samples.effective_sample_size
    assert samples.weights.sum() == pytest.approx(1)
    assert size > 400
    assert samples.pareto_shape < 0.7
    sigma = np.sqrt(np.diag(COVARIANCE))
    # standard errors of a mean and of a variance from as many independent draws, five of them
    assert np.all(np.abs(samples.mean() - MEAN) < 5 * sigma / np.sqrt(size))
    assert np.all(np.abs(np.diag(samples.covariance()) / sigma**2 - 1) < 5 * np.sqrt(2 / size))


@pytest.mark.statistical
def test_resampled_draws_are_the_targets(function_likelihood):
    random = np.random.default_rng(2)
    samples = importance_samples(gaussian(function_likelihood), MEAN, 2 * COVARIANCE, random, 4000)
    drawn = samples.resample(random, 1000)
    whitened = np.linalg.solve(FACTOR, (drawn - MEAN).T)
    assert drawn.shape == (1000, 6)
    assert np.all(np.abs(whitened.mean(axis=1)) < 5 * np.sqrt(1 / 1000 + 1 / samples.effective_sample_size))


@pytest.mark.statistical
def test_weights_with_a_pareto_tail_are_found_out():
    ratios = np.log(genpareto.rvs(1.2, loc=1.0, size=20000, random_state=6))
    weights, shape = pareto_smoothed(ratios)
    assert shape > 0.9
    assert np.exp(weights).sum() == pytest.approx(1)
    assert np.exp(weights).max() <= np.exp(ratios - ratios.max()).max() / np.exp(ratios - ratios.max()).sum() * 1.5


def test_equal_weights_stay_equal():
    weights, _ = pareto_smoothed(np.full(100, -700.0))
    np.testing.assert_allclose(weights, -np.log(100))


def test_order_of_the_weights_stays():
    ratios = np.random.default_rng(3).normal(size=500)
    weights, _ = pareto_smoothed(ratios)
    assert np.all(np.diff(weights[np.argsort(ratios)]) >= 0)


def test_effective_sample_size_of_equal_and_of_single_weights():
    draws = np.zeros((4, 6))
    assert WeightedSamples(draws, np.full(4, 0.25), 0.0).effective_sample_size == pytest.approx(4)
    assert WeightedSamples(draws, np.array([1.0, 0, 0, 0]), 0.0).effective_sample_size == 1


def test_no_density_anywhere_is_told():
    with pytest.raises(EstimationError, match="zero at all draws"):
        pareto_smoothed(np.full(10, -np.inf))

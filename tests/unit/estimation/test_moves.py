import emcee
import numpy as np
import pytest

from linepose.errors import EstimationError
from linepose.estimation.moves import independence_move

SIGMA = np.array([1e-4, 2.0])


def skewed(samples):
    """A target that is not the proposal: a Gaussian, and the logarithm of a Gamma variable of shape 3."""
    first, second = samples[:, 0] / SIGMA[0], samples[:, 1]
    return -0.5 * first**2 + 3 * second - np.exp(second)


@pytest.mark.statistical
def test_it_samples_the_target_and_not_the_proposal():
    move = independence_move([1e-5, 0.8], np.diag([1.2e-4, 1.0]) ** 2)
    sampler = emcee.EnsembleSampler(64, 2, skewed, moves=move, vectorize=True)
    random = np.random.default_rng(3)
    sampler.random_state = np.random.RandomState(3).get_state()
    sampler.run_mcmc(random.normal(0, [1e-4, 0.1], (64, 2)), 1200)
    chain = sampler.get_chain()[200:]
    tau = emcee.autocorr.integrated_time(chain)
    assert np.all(tau < 5)
    count = chain.shape[0] * 64 / tau
    mean, variance = chain.mean(axis=(0, 1)), chain.var(axis=(0, 1))
    # digamma and trigamma of 3; sigma of a variance of kurtosis k is its value times sqrt((k - 1) / n), k at most 4
    expected_mean, expected_variance = np.array([0, 0.92278434]), np.array([SIGMA[0] ** 2, 0.39493407])
    assert np.all(np.abs(mean - expected_mean) < 4 * np.sqrt(expected_variance / count))
    assert np.all(np.abs(variance / expected_variance - 1) < 4 * np.sqrt(3 / count))


def test_a_singular_covariance_is_refused():
    with pytest.raises(EstimationError, match="longer warm-up"):
        independence_move([0.0, 0.0], [[1.0, 1.0], [1.0, 1.0]])

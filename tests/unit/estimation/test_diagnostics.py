import numpy as np
import pytest

from linepose.estimation.diagnostics import acceptance_fraction, diagnose_samples, split_r_hat


def autoregressive(rho, n_steps, n_walkers, n_parameters=2, seed=0):
    """Stationary chains of unit variance with autocorrelation rho^lag: autocorrelation time (1 + rho) / (1 - rho)."""
    rng = np.random.default_rng(seed)
    chain = np.empty((n_steps, n_walkers, n_parameters))
    chain[0] = rng.normal(size=chain.shape[1:])
    for step in range(1, n_steps):
        chain[step] = rho * chain[step - 1] + np.sqrt(1 - rho**2) * rng.normal(size=chain.shape[1:])
    return chain


def test_split_r_hat_of_two_short_chains_by_hand():
    samples = np.array([[1.0, 2.0], [3.0, 4.0], [5.0, 2.0], [9.0, 4.0]])[:, :, None]
    # halves (1 3), (2 4), (5 9), (2 4): their variances 2 2 8 2, mean 14 / 4; their means 2 3 7 3, variance 14.75 / 3
    expected = np.sqrt((1 / 2 * 14 / 4 + 14.75 / 3) / (14 / 4))
    np.testing.assert_allclose(split_r_hat(samples), [expected], rtol=1e-14)


def test_split_r_hat_leaves_the_odd_step_out():
    samples = autoregressive(0.5, 21, 6)
    np.testing.assert_array_equal(split_r_hat(samples), split_r_hat(samples[:20]))


@pytest.mark.statistical
def test_split_r_hat_of_mixed_chains_is_one():
    samples = autoregressive(0.0, 1000, 50)
    # var of 100 means times 500 is one up to sqrt(2 / 99); R-hat^2 - 1 is that less one, over 500
    assert np.abs(split_r_hat(samples) - 1).max() < 4 * np.sqrt(2 / 99) / 2 / 500


def test_split_r_hat_sees_walkers_that_stay_apart():
    samples = autoregressive(0.0, 200, 10) + np.repeat([0.0, 3.0], 5)[None, :, None]
    # variance between is that of means 0 and 3, ten each: 2.368; sqrt(1 + 2.368)
    assert split_r_hat(samples) == pytest.approx(np.sqrt(1 + 2.25 * 20 / 19), rel=0.05)


def test_split_r_hat_sees_a_drift_that_all_walkers_share():
    samples = autoregressive(0.0, 200, 10)
    samples[100:] += 3.0
    assert np.all(split_r_hat(samples) > 1.5)


@pytest.mark.statistical
@pytest.mark.parametrize("rho", [0.0, 0.5, 0.8])
def test_autocorrelation_time_of_an_autoregressive_chain(rho):
    n_steps, n_walkers = 2000, 40
    found = diagnose_samples(autoregressive(rho, n_steps, n_walkers))
    expected = (1 + rho) / (1 - rho)
    # Sokal: relative variance 2 (2 window + 1) / (steps * walkers) with a window of about 5 times, time >= 1
    tolerance = 4 * np.sqrt(2 * (2 * 5 * expected + 1) / (n_steps * n_walkers))
    np.testing.assert_allclose(found.autocorrelation_time, expected, rtol=tolerance + np.exp(-5))
    np.testing.assert_allclose(
        found.effective_sample_size, n_steps * n_walkers / found.autocorrelation_time, rtol=1e-14
    )


@pytest.mark.statistical
def test_long_mixed_chain_has_no_warning():
    samples = autoregressive(0.5, 2000, 40)
    found = diagnose_samples(samples)
    assert found.warning == ""
    np.testing.assert_allclose(found.sigma, samples.reshape(-1, 2).std(axis=0, ddof=1), rtol=1e-14)
    assert found.acceptance_fraction == 1.0


def test_short_chain_is_told_how_long_it_should_be():
    found = diagnose_samples(autoregressive(0.9, 100, 40))
    time = found.autocorrelation_time.max()
    needed = int(np.ceil(50 * time))
    assert found.warning.startswith(
        f"chain of 100 steps is short for an autocorrelation time of {time:.0f}: "
        f"set sampling.n_steps to {needed} or more"
    )


def test_unmixed_chain_is_told():
    samples = autoregressive(0.0, 400, 10) + np.repeat([0.0, 3.0], 5)[None, :, None]
    found = diagnose_samples(samples)
    assert found.warning.endswith(
        f"split R-hat {found.split_r_hat.max():.3f} is above 1.01: the walkers have not mixed: raise sampling.n_steps"
    )


@pytest.mark.statistical
def test_walker_that_never_moved_counts_as_no_sample():
    samples = autoregressive(0.0, 1000, 20)
    alone = diagnose_samples(samples[:, :18])
    samples[:, 18:] = samples[0, 18:]
    found = diagnose_samples(samples)
    assert found.warning.startswith("2 of 20 walkers never moved: raise sampling.n_burn_in and sampling.n_steps")
    np.testing.assert_array_equal(found.autocorrelation_time, alone.autocorrelation_time)
    np.testing.assert_array_equal(found.effective_sample_size, alone.effective_sample_size)
    assert found.acceptance_fraction == 18 / 20


@pytest.mark.filterwarnings("error")
def test_chain_that_stands_still_is_told():
    found = diagnose_samples(np.ones((10, 5, 6)))
    assert found.warning.startswith("5 of 5 walkers never moved")
    assert np.all(np.isinf(found.split_r_hat))
    assert found.effective_sample_size.tolist() == [0.0] * 6
    assert np.all(np.isfinite(found.autocorrelation_time))


def test_acceptance_is_the_share_of_moves():
    samples = np.zeros((5, 2, 3))
    samples[2:, 0, 1] = 1.0  # one move of four in any parameter
    samples[:, 1, 0] = [0, 1, 1, 2, 3]  # three of four
    assert acceptance_fraction(samples) == 0.5

import numpy as np
import pytest

from linepose.simulation import navigation_error
from linepose.simulation.settings import NavigationErrorSettings
from unit import navigation_errors

SIGMA = (0.01, 0.02, 0.03, 0.001, 0.002, 0.003)
N_STEPS = 200_000


def moments_tolerance(n_independent):
    """Four sigmas of a sample variance of unit variables: relative sqrt(2 / n) each."""
    return 4 * np.sqrt(2 / n_independent)


@pytest.mark.statistical
def test_gauss_markov_has_its_variance_and_correlation_at_uneven_times():
    rng = np.random.default_rng(3)
    time = np.cumsum(rng.uniform(0.0, 2.0, N_STEPS))
    values = navigation_error.unit_gauss_markov(rng, time, 5.0)
    # neighbours are correlated over 2 x 5 s of a series of N_STEPS x 1 s
    tolerance = moments_tolerance(N_STEPS / 10)
    np.testing.assert_allclose(np.mean(values**2, axis=0), 1.0, atol=tolerance)
    np.testing.assert_allclose(np.mean(values, axis=0), 0.0, atol=4 * np.sqrt(10 / N_STEPS))
    gap = np.diff(time)
    for low, high in ((0.0, 0.2), (1.8, 2.0)):
        some = (gap >= low) & (gap < high)
        product = np.mean(values[1:][some] * values[:-1][some], axis=0)
        np.testing.assert_allclose(product, np.exp(-(low + high) / 2 / 5.0), atol=moments_tolerance(N_STEPS / 100))


@pytest.mark.statistical
def test_white_and_view_parts_have_their_sigmas_and_reach():
    rng = np.random.default_rng(4)
    view = np.repeat(np.arange(4000), 5)
    time = np.arange(len(view), dtype=float)
    white = navigation_error.navigation_errors(rng, navigation_errors.white_per_line(SIGMA), time, view)
    np.testing.assert_allclose(white.std(axis=0) / SIGMA, 1.0, atol=moments_tolerance(len(view)) / 2)
    alike = navigation_error.navigation_errors(rng, navigation_errors.constant_in_view(SIGMA), time, view)
    np.testing.assert_array_equal(alike[::5], alike[4::5])
    np.testing.assert_allclose(alike[::5].std(axis=0) / SIGMA, 1.0, atol=moments_tolerance(4000) / 2)
    mixed = navigation_error.navigation_errors(rng, navigation_errors.mixed(SIGMA, 0.7), time, view)
    between = np.mean(mixed[::5] * mixed[4::5], axis=0) / np.square(SIGMA)
    np.testing.assert_allclose(between, 0.7, atol=4 * np.sqrt((1 + 0.7**2) / 4000))


def test_no_sigma_no_error():
    rng = np.random.default_rng(5)
    errors = navigation_error.navigation_errors(rng, NavigationErrorSettings(), np.arange(3.0), np.zeros(3, dtype=int))
    np.testing.assert_array_equal(errors, np.zeros((3, 6)))

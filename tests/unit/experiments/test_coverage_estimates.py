"""Where the truth is said to lie, of estimates of which everything is known."""

from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
from scipy.stats import binom, kstest

from linepose.errors import EstimationError
from linepose.experiments.coverage_estimates import judged, judged_optimum
from linepose.geometry.pose import POSE_COLUMNS
from linepose.geometry.rotations import matrix_from_rotation_vector, rotation_vector_from_matrix

TRUTH = np.array([0.2, -0.1, -0.8, 1.4, 1.4, -1.1])
ROOT = np.linalg.cholesky(np.diag([0.03, 0.05, 0.06, 0.016, 0.018, 0.009]) ** 2)
ROOT[5, 0], ROOT[4, 2] = 0.006, 0.009  # correlated
N = 400


def stepped(pose, steps):
    """Poses (S, 6) at steps (S, 6) of position and turn about body axes from a pose."""
    turned = matrix_from_rotation_vector(steps[:, 3:]) @ matrix_from_rotation_vector(pose[3:])
    return np.concatenate([pose[:3] + steps[:, :3], rotation_vector_from_matrix(turned)], axis=1)


def estimate(random, claimed, off=0.0):
    """An estimate that errs as ROOT says, with samples so many times as wide; its mode off their mean."""
    mean = stepped(TRUTH, (ROOT @ random.standard_normal(6))[None])[0]
    samples = stepped(mean, claimed * random.standard_normal((1000, 6)) @ ROOT.T)
    return SimpleNamespace(
        pose=stepped(mean, np.full((1, 6), off))[0],
        samples=pd.DataFrame(samples, columns=POSE_COLUMNS),
        diagnostics=SimpleNamespace(converged=True, heavy_tails=True, least_eigenvalue=0.9),
    )


@pytest.mark.statistical
@pytest.mark.parametrize("off", [0.0, 0.02])
def test_credibility_is_uniform_where_samples_are_as_wide_as_errors(off):
    random = np.random.default_rng(11)
    credibility = [judged(estimate(random, 1.0, off), TRUTH).credibility for _ in range(N)]
    assert kstest(credibility, "uniform").pvalue > 1e-3
    for nominal in (0.5, 0.68, 0.95):
        low, high = binom.interval(0.999, N, nominal)
        assert low <= np.sum(np.array(credibility) < nominal) <= high


@pytest.mark.statistical
def test_sigmas_are_those_of_the_samples_about_body_axes_and_errors_the_modes():
    random = np.random.default_rng(12)
    found = [judged(estimate(random, 1.0), TRUTH) for _ in range(N)]
    scaled = np.array([one.error / one.sigma for one in found])
    np.testing.assert_allclose(np.sqrt(np.mean(scaled**2, axis=0)), 1.0, atol=4 / np.sqrt(2 * N))
    np.testing.assert_allclose(found[0].sigma, np.sqrt(np.diag(ROOT @ ROOT.T)), rtol=4 / np.sqrt(2000))
    assert (found[0].converged, found[0].heavy_tails, found[0].least_eigenvalue) == (True, True, 0.9)


@pytest.mark.statistical
def test_samples_half_as_wide_are_found_out():
    random = np.random.default_rng(13)
    credibility = np.array([judged(estimate(random, 0.5), TRUTH).credibility for _ in range(N)])
    # chi-square with 6 degrees of freedom: four times the distance squared is below the 68 % point in 6 % of cases
    assert np.mean(credibility < 0.68) < 0.15


@pytest.mark.statistical
def test_optimum_of_a_normal_likelihood_has_chi_squares_credibility(function_likelihood):
    random, sigma = np.random.default_rng(14), np.array([0.03, 0.05, 0.06, 0.016, 0.018, 0.009])
    for claimed, least in ((1.0, 0.6), (0.5, 0.0)):
        found = []
        for _ in range(100):
            data = sigma * random.standard_normal(6)
            likelihood = function_likelihood(
                lambda p, data=data, claimed=claimed: 0.5 * np.sum(((p - data) / (claimed * sigma)) ** 2, axis=1)
            )
            found.append(judged_optimum(likelihood, np.zeros(6), np.zeros(6)))
        held = np.sum(np.array([one.credibility for one in found]) < 0.68)
        low, high = binom.interval(0.999, 100, 0.68 if least else 0.06)
        assert low <= held <= high
        np.testing.assert_allclose(found[0].sigma, claimed * sigma, rtol=0.01)


def test_open_direction_is_an_error(function_likelihood):
    likelihood = function_likelihood(lambda p: 0.5 * np.sum((p[:, 1:] / 0.1) ** 2, axis=1))
    with pytest.raises(EstimationError):
        judged_optimum(likelihood, np.zeros(6), np.zeros(6))

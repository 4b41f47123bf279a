"""Leaving out one of twelve direct measurements: known by the textbook."""

import numpy as np
import pytest

from linepose.errors import EstimationError
from linepose.experiments.jackknife import derivatives, jackknife_sigma

from .conftest import SIGMA, TRUE_POSE


def test_sigma_is_that_of_the_mean_whatever_the_model_says(gaussian):
    """For a mean the jackknife is the standard error of the measurements; that given is 10 times too small."""
    optimum = gaussian.means.mean(axis=0)
    found = jackknife_sigma(gaussian, optimum, np.diag(SIGMA**2) / 12 / 100)
    np.testing.assert_allclose(found, gaussian.means.std(axis=0, ddof=1) / np.sqrt(12), rtol=1e-6)


def test_derivatives_of_a_parabola(gaussian):
    away = gaussian.means.mean(axis=0) + 0.3 * SIGMA
    axes = np.linalg.cholesky(np.diag(SIGMA**2) + 0.5 * np.outer(SIGMA, SIGMA))
    gradient, hessian = derivatives(gaussian, away, axes)
    information = 12 * np.diag(SIGMA**-2)
    np.testing.assert_allclose(hessian, axes.T @ information @ axes, rtol=1e-6, atol=1e-6)
    np.testing.assert_allclose(gradient, axes.T @ information @ (0.3 * SIGMA), rtol=1e-6, atol=1e-6)


def test_an_open_direction_is_told(function_likelihood):
    flat = function_likelihood(lambda rows: np.sum(rows[:, :5] ** 2, axis=1))
    with pytest.raises(EstimationError, match="without observation 1 a direction of the pose is open"):
        jackknife_sigma(flat, np.zeros(6), np.eye(6))


def test_an_undefined_neighbourhood_is_told(function_likelihood):
    undefined = function_likelihood(lambda rows: np.where(rows[:, 0] > 0, np.inf, 1.0))
    with pytest.raises(EstimationError, match="undefined near the optimum"):
        jackknife_sigma(undefined, TRUE_POSE * 0, np.eye(6))

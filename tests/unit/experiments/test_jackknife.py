"""Leaving out one of twelve direct measurements: known by the textbook."""

import numpy as np
import pytest

from linepose.errors import EstimationError
from linepose.experiments.jackknife import derivatives, jackknife_sigma
from unit.experiments.conftest import SIGMA, TRUE_POSE


def test_sigma_is_that_of_the_mean_whatever_the_model_says(gaussian):
    """For a mean the jackknife is the standard error of the measurements, here of ones that lie twice as far apart."""
    gaussian.means = TRUE_POSE + 2 * (gaussian.means - TRUE_POSE)
    optimum = gaussian.means.mean(axis=0)
    found = jackknife_sigma(gaussian, optimum, np.diag(SIGMA**2) / 12)
    np.testing.assert_allclose(found, gaussian.means.std(axis=0, ddof=1) / np.sqrt(12), rtol=1e-6)


def test_derivatives_of_a_parabola(gaussian):
    away = gaussian.means.mean(axis=0) + 0.3 * SIGMA
    axes = np.linalg.cholesky(np.diag(SIGMA**2) + 0.5 * np.outer(SIGMA, SIGMA))
    gradient, hessian = derivatives(gaussian, away, axes)
    information = 12 * np.diag(SIGMA**-2)
    np.testing.assert_allclose(hessian, axes.T @ information @ axes, rtol=1e-6, atol=1e-6)
    np.testing.assert_allclose(gradient, axes.T @ information @ (0.3 * SIGMA), rtol=1e-6, atol=1e-6)


def test_a_step_is_bounded_where_the_rest_bends_the_other_way(gaussian, monkeypatch):
    """Without the first of twelve the curvature is negative: the step of a third of the whole's curvature is taken."""
    optimum, whole = gaussian.means.mean(axis=0), np.diag(SIGMA**2) / 12
    select, bent = gaussian.select, np.diag(12 / SIGMA**2)

    def bent_without_the_first(numbers):
        reduced = select(numbers)
        if 1 not in numbers:
            inner = reduced.log_likelihoods
            reduced.log_likelihoods = lambda rows: (
                inner(rows) + np.einsum("ki,ij,kj->k", rows - optimum, bent, rows - optimum)
            )
        return reduced

    expected = jackknife_sigma(gaussian, optimum, whole)
    monkeypatch.setattr(gaussian, "select", bent_without_the_first)
    found = jackknife_sigma(gaussian, optimum, whole)
    assert np.all(np.isfinite(found))
    # one of twelve steps is 11/12 over 0.3 times as long
    assert np.all(found < 3.1 * expected)


def test_an_undefined_neighbourhood_is_told(function_likelihood):
    undefined = function_likelihood(lambda rows: np.where(rows[:, 0] > 0, np.inf, 1.0))
    with pytest.raises(EstimationError, match="undefined near the optimum"):
        jackknife_sigma(undefined, TRUE_POSE * 0, np.eye(6))

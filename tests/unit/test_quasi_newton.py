import numpy as np
import pytest

from linepose.errors import InputError
from linepose.optimise import laplace_covariance
from linepose.quasi_newton import descend


def test_optimum_is_the_known_minimum(gaussian, pose_covariance, true_pose):
    found = descend(gaussian, true_pose + np.array([0.1, -0.1, 0.1, 0.03, 0.03, -0.03]))
    expected = gaussian.measured.mean(axis=0)
    distance = np.linalg.solve(np.linalg.cholesky(laplace_covariance(gaussian, expected)), found.parameters - expected)
    assert np.linalg.norm(distance) < 0.02  # gradient below 1e-3 a unit, a unit below twenty of the smallest sigmas
    assert found.converged


def test_no_optimum_is_told(function_likelihood):
    assert not descend(function_likelihood(lambda p: np.full(len(p), np.inf)), np.zeros(6)).converged


def test_start_must_be_finite(gaussian):
    with pytest.raises(InputError, match="start pose"):
        descend(gaussian, [np.nan] * 6)

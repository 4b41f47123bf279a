"""The marginal likelihood against an integral over every unknown by importance sampling, projection not linearised."""

import numpy as np
import pytest
from scipy.special import logsumexp

from linepose.geometry.rotations import matrix_from_euler
from linepose.likelihood.shared import SharedLikelihood
from unit.likelihood import dense_shared
from unit.likelihood.small_survey import CAMERA, POSE, Truth, make_survey

N_VIEWS, N_POINTS = 3, 2


def unknowns_of(survey, vector):
    """The function from (points, shared errors, white errors) (K, 60) to standardised residuals and prior terms."""
    a, b, g = np.exp(vector[6:9])
    r_cb = dense_shared.vector_matrix(vector[3:6]).T
    focal = vector[10] / CAMERA.pixel_pitch_m

    def squares(x):
        points = x[:, :6].reshape(-1, N_POINTS, 3)
        shared = x[:, 6:24].reshape(-1, N_VIEWS, 6)
        white = x[:, 24:].reshape(-1, N_VIEWS, N_POINTS, 6)
        parts = [x[:, 6:]]
        for i in range(N_VIEWS):
            mean_root = np.linalg.cholesky(survey.covariance[i].mean(axis=0))
            for k in range(N_POINTS):
                error = a * shared[:, i] @ mean_root.T
                error = error + b * white[:, i, k] @ np.linalg.cholesky(survey.covariance[i, k]).T
                position = survey.position_m[i, k] - error[:, :3]
                angles = survey.euler_rad[i, k] - error[:, 3:]
                r_wb = matrix_from_euler(angles)
                in_body = np.einsum("nji,nj->ni", r_wb, points[:, k] - position)
                q = (in_body - vector[:3]) @ r_cb.T
                u = survey.u_px[i, k] - vector[9] - focal * q[:, 0] / q[:, 2]
                parts.append(np.stack([u / 0.5, -focal * q[:, 1] / q[:, 2] / 0.5], axis=1) / g)
        return np.concatenate(parts, axis=1)

    return squares


def log_integral(survey, vector, n_draws, random):
    """Log of the integral and its Monte-Carlo sigma; the proposal is the Gaussian at the joint minimum."""
    squares = unknowns_of(survey, vector)
    lines, used = dense_shared.lines_of(survey)
    x = np.zeros(60)
    x[:6] = dense_shared.intersection(survey, CAMERA, vector, lines, used)
    for _ in range(12):
        step = 1e-6
        jacobian = (squares(x + step * np.eye(60)) - squares(x - step * np.eye(60))).T / (2 * step)
        x = x - np.linalg.lstsq(jacobian, squares(x[None])[0], rcond=None)[0]
    factor = np.linalg.cholesky(np.linalg.inv(jacobian.T @ jacobian))
    normal = random.normal(size=(n_draws, 60))
    log_weight = 0.5 * np.sum(normal**2, axis=1) - 0.5 * np.sum(squares(x + normal @ factor.T) ** 2, axis=1)
    # all constants but the (2 pi)s, which are the same in every call
    value = logsumexp(log_weight) - np.log(n_draws) + np.sum(np.log(np.diag(factor)))
    value -= 2 * N_VIEWS * N_POINTS * vector[8]
    ratio = np.exp(log_weight - log_weight.max())
    return value, np.std(ratio) / np.mean(ratio) / np.sqrt(n_draws)


@pytest.mark.statistical
def test_it_is_the_integral_over_points_and_errors():
    survey = make_survey(N_VIEWS, N_POINTS, Truth(0.5, 0.2, 1.0), seed=2)
    likelihood = SharedLikelihood(survey, CAMERA)
    random = np.random.default_rng(7)
    found, expected, sigmas = [], [], []
    for levels, shift in [((0.5, 0.2, 1.0), 0.0), ((0.2, 0.4, 1.5), 0.003), ((0.9, 0.1, 0.6), -0.003)]:
        vector = likelihood.start(POSE + shift)
        vector[6:9] = np.log(levels)
        value, sigma = log_integral(survey, vector, 20_000, random)
        expected.append(value + dense_shared.log_prior(CAMERA, vector))
        found.append(likelihood.log_likelihood(vector))
        sigmas.append(sigma)
    difference = np.diff(np.array(found) - expected)
    # Monte Carlo, and the projection's curvature over errors of a centimetre at two metres, (0.01 / 2) per residual
    allowed = 4 * np.hypot(sigmas[1:], sigmas[:-1]) + 0.01
    assert np.all(np.abs(np.diff(expected)) > 10 * allowed)
    assert np.all(np.abs(difference) < allowed)

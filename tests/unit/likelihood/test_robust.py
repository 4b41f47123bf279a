import numpy as np
import pytest
from scipy.optimize import minimize
from scipy.special import digamma, gammaln, logsumexp

from linepose.errors import EstimationError, InputError
from linepose.likelihood.robust import RobustPriors, RobustSharedLikelihood
from linepose.likelihood.shared import SharedLikelihood
from unit.likelihood import dense_shared, field_data
from unit.likelihood.small_survey import CAMERA, POSE, Truth, make_survey, without

NO_TAILS = RobustPriors(view_degrees_of_freedom=1e9, point_degrees_of_freedom=1e9)
LEVELS = (0.6, 0.2, 1.0)


def parameters_of(likelihood, levels=LEVELS):
    vector = likelihood.start(POSE)
    vector[6:9] = np.log(levels)
    return vector


def with_a_bad_view(survey, row):
    survey.position_m[row] += [0.12, -0.08, 0.05]
    return survey


def weight_share(weights, size, freedom=4.0):
    """Expected log-scale of the Gaussians less the divergence of the Gamma q(w) from its prior, 0 at weights of one."""

    def share(weight):
        shape, shape0, rate0 = (freedom + size) / 2, freedom / 2, freedom / 2
        rate = shape / weight
        divergence = (shape - shape0) * digamma(shape) - gammaln(shape) + gammaln(shape0)
        divergence += shape0 * (np.log(rate) - np.log(rate0)) + shape * (rate0 - rate) / rate
        return size / 2 * (digamma(shape) - np.log(rate)) - divergence

    return np.sum(share(weights) - share(1.0))


def test_without_tails_it_is_the_shared_error_model():
    survey = without(make_survey(6, 5, Truth(0.5), seed=2), (2, 3))
    gaussian, robust = SharedLikelihood(survey, CAMERA), RobustSharedLikelihood(survey, CAMERA, NO_TAILS)
    vector = parameters_of(gaussian)
    # a single sweep, so one linearisation fewer: 1e-5 of the residuals' squares
    assert robust.log_likelihood(vector) == pytest.approx(gaussian.log_likelihood(vector), abs=0.02)
    weights = robust.weights(vector)
    assert np.allclose(weights.view, 1, atol=1e-6)
    assert np.isnan(weights.point[2, 3])
    assert np.nanmax(np.abs(weights.point - 1)) < 1e-6


def test_the_bad_view_and_the_bad_point_have_the_low_weights():
    survey = with_a_bad_view(make_survey(12, 8, Truth(0.5), seed=4), 3)
    survey.u_px[7, 2] += 15
    likelihood = RobustSharedLikelihood(survey, CAMERA)
    weights = likelihood.weights(parameters_of(likelihood))
    assert np.argmin(weights.view) == 3
    assert weights.view[3] < 0.25 < np.delete(weights.view, 3).min()
    assert np.unravel_index(np.argmin(weights.point), weights.point.shape) == (7, 2)
    others = np.delete(weights.point.ravel(), 7 * 8 + 2)
    assert weights.point[7, 2] < 0.05 < others.min()


def test_a_view_that_says_nothing_keeps_its_weight():
    survey = make_survey(6, 4, Truth(0.5), seed=4)
    survey.covariance[2] = 0.0
    likelihood = RobustSharedLikelihood(survey, CAMERA)
    # within the tolerance of the sweeps, over one less their contraction
    assert likelihood.weights(parameters_of(likelihood)).view[2] == pytest.approx(1, abs=0.02)


def test_the_bound_is_a_marginal_likelihood_over_the_weights_from_below():
    """Weights drawn from their prior, the Gaussian model of each draw dense: the average is the exact marginal.

    Two views of one point, where the posterior of the weights is nearly the prior and plain averaging converges.
    """
    survey = make_survey(2, 1, Truth(0.5), seed=3)
    freedom = 4.0
    priors = RobustPriors(view_degrees_of_freedom=freedom, point_degrees_of_freedom=freedom)
    likelihood = RobustSharedLikelihood(survey, CAMERA, priors)
    vector = parameters_of(likelihood)
    lines, used = dense_shared.lines_of(survey)
    points = likelihood.residuals(vector).point_m.ravel()
    residual, design, by_body = dense_shared.linearised(survey, CAMERA, vector, lines, used, points)
    only_own, only_shared = vector.copy(), vector.copy()
    only_own[6], only_shared[7:9] = -60, -60
    own = dense_shared.covariance_of(survey, CAMERA, only_own, lines, used, by_body)
    shared = dense_shared.covariance_of(survey, CAMERA, only_shared, lines, used, by_body)
    random = np.random.default_rng(5)
    draws = []
    for _ in range(4000):
        view, line = random.gamma(freedom / 2, 2 / freedom, 2), random.gamma(freedom / 2, 2 / freedom, 2)
        covariance = own / np.repeat(line, 2) + shared / np.repeat(view, 2)
        information = design.T @ np.linalg.solve(covariance, design)
        move = np.linalg.solve(information, design.T @ np.linalg.solve(covariance, residual))
        left = residual - design @ move
        value = left @ np.linalg.solve(covariance, left)
        draws.append(-0.5 * (value + np.linalg.slogdet(covariance)[1] + np.linalg.slogdet(information)[1]))
    exact = logsumexp(draws) - np.log(len(draws)) + dense_shared.log_prior(CAMERA, vector)
    # the bound's own constant: 1 at weights of one stands for these terms of the Gamma distributions
    constant = 0.0
    for size in (6, 6, 2, 2):
        alpha, alpha0 = (freedom + size) / 2, freedom / 2
        constant += gammaln(alpha) - gammaln(alpha0) - alpha * np.log(alpha) + alpha0 * np.log(alpha0) + size / 2
    bound = likelihood.log_likelihood(vector) + constant
    monte_carlo = 4 * np.std(np.exp(np.array(draws) - max(draws))) / np.mean(np.exp(np.array(draws) - max(draws)))
    monte_carlo /= np.sqrt(len(draws))
    assert bound < exact + monte_carlo
    assert bound > exact - 1.5  # tight enough to be worth maximising: four weights, a third of a unit each


def test_a_bad_view_moves_the_pose_less_than_under_gaussian_errors():
    clean = make_survey(12, 6, Truth(0.4), seed=6)
    bad = with_a_bad_view(make_survey(12, 6, Truth(0.4), seed=6), 5)

    def pose(likelihood):
        start, scale = parameters_of(likelihood), np.array([*[0.03] * 3, *[0.01] * 3, *[0.3] * 3, 0.6, 3e-5])
        found = minimize(lambda step: -likelihood.log_likelihood(start + step * scale), np.zeros(11), method="BFGS")
        return (found.x * scale)[:6] / scale[:6]

    def moved(model):
        return np.linalg.norm(pose(model(bad, CAMERA)) - pose(model(clean, CAMERA)))

    assert moved(RobustSharedLikelihood) < 0.6 * moved(SharedLikelihood)


def test_rows_are_the_same_one_by_one():
    likelihood = RobustSharedLikelihood(with_a_bad_view(make_survey(6, 5, Truth(0.5), seed=8), 1), CAMERA)
    random = np.random.default_rng(1)
    rows = parameters_of(likelihood) + random.normal(size=(8, 11)) * likelihood.initial_walker_sigma(0.02, 0.01)
    assert np.array_equal(likelihood.log_likelihoods(rows), [likelihood.log_likelihood(row) for row in rows])


def test_the_larger_group_is_eliminated_without_changing_anything():
    """Few views of many points and many views of few: each weight set of one is that of the dense posterior."""
    for n_views, n_points in [(3, 9), (9, 3)]:
        survey = make_survey(n_views, n_points, Truth(0.5), seed=8)
        likelihood = RobustSharedLikelihood(survey, CAMERA)
        vector = parameters_of(likelihood)
        weights = likelihood.weights(vector)
        lines, used = dense_shared.lines_of(survey)
        points = likelihood.residuals(vector).point_m.ravel()
        residual, design, by_body = dense_shared.linearised(survey, CAMERA, vector, lines, used, points)
        by_errors = np.zeros((2 * len(lines), 6 * n_views))
        own = np.zeros((2 * len(lines), 2 * len(lines)))
        for row, (i, k) in enumerate(lines):
            pair = slice(2 * row, 2 * row + 2)
            root = np.linalg.cholesky(survey.covariance[i].mean(axis=0))
            by_errors[pair, 6 * i : 6 * i + 6] = LEVELS[0] * by_body[row] @ root
            own[pair, pair] = LEVELS[1] ** 2 * by_body[row] @ survey.covariance[i, used[k]] @ by_body[row].T
            own[pair, pair] += LEVELS[2] ** 2 * np.diag([CAMERA.sigmas.u_px**2, CAMERA.sigmas.v_px**2])
        by_all = np.hstack([design, by_errors])
        weighted = np.linalg.inv(own) * np.repeat([weights.point[i, used[k]] for i, k in lines], 2)
        information = by_all.T @ weighted @ by_all
        tail = slice(design.shape[1], None)
        information[tail, tail] += np.diag(np.repeat(weights.view, 6))
        covariance = np.linalg.inv(information)
        mean = covariance @ by_all.T @ weighted @ residual
        second = np.outer(mean, mean) + covariance
        left = residual - by_all @ mean
        own_second = np.outer(left, left) + by_all @ covariance @ by_all.T
        for view in range(n_views):
            block = slice(design.shape[1] + 6 * view, design.shape[1] + 6 * view + 6)
            expected = (4 + 6) / (4 + np.trace(second[block, block]))
            assert weights.view[view] == pytest.approx(expected, rel=0.01)
        for row, (i, k) in enumerate(lines):
            pair = slice(2 * row, 2 * row + 2)
            square = np.trace(np.linalg.solve(own[pair, pair], own_second[pair, pair]))
            assert weights.point[i, used[k]] == pytest.approx((4 + 2) / (4 + square), rel=0.01)
        value = -0.5 * (left @ weighted @ left + np.sum(np.repeat(weights.view, 6) * mean[tail] ** 2))
        value -= 0.5 * (np.linalg.slogdet(information)[1] + np.linalg.slogdet(own)[1])
        value += weight_share(weights.view, 6) + weight_share(weights.point.ravel(), 2)
        value += dense_shared.log_prior(CAMERA, vector)
        # to second order in the tolerances of the weights (3e-3, some 36 of them) and of the linearisation
        assert likelihood.log_likelihood(vector) == pytest.approx(value, abs=0.01)


def test_undefined_parameters_have_no_probability():
    likelihood = RobustSharedLikelihood(make_survey(4, 3, Truth(), seed=6), CAMERA)
    vector = parameters_of(likelihood)
    vector[10] = -vector[10]
    assert likelihood.log_likelihood(vector) == -np.inf
    behind = parameters_of(likelihood)
    behind[3:6] += [np.pi, 0, 0]
    assert likelihood.log_likelihood(behind) == -np.inf
    with pytest.raises(EstimationError, match="in front of the camera"):
        likelihood.weights(behind)


def test_degrees_of_freedom_must_be_positive():
    with pytest.raises(InputError, match="point_degrees_of_freedom"):
        RobustSharedLikelihood(make_survey(3, 2, Truth(), seed=6), CAMERA, RobustPriors(point_degrees_of_freedom=0.0))


@pytest.mark.field
@pytest.mark.skipif(not field_data.PRESENT, reason="no field data")
def test_field_the_views_removed_first_have_the_lowest_weights():
    likelihood = RobustSharedLikelihood(field_data.reverse_views(), field_data.CAMERA)
    vector = likelihood.start([0.140, 0.040, -0.726, -0.797, 0.789, -1.451])
    vector[6:] = [*np.log([0.73, 0.022, 1.78]), 324.07, 8.234e-3]
    weights = likelihood.weights(vector).view
    assert set(likelihood.survey.number[np.argsort(weights)[:2]]) == {8, 12}
    assert np.sort(weights)[2] > 0.5

import numpy as np
import pytest

from linepose.errors import EstimationError, InputError
from linepose.estimation.optimise import Search, bounded, laplace_covariance, minimise, optimise

SIGMA = np.array([0.03, 0.05, 0.06, 0.016, 0.018, 0.009])


def test_sine_transform_is_the_bounded_interval_of_lmfit():
    lower, upper = np.array([-1.8, -2.0]), np.array([2.2, 2.0])
    p = np.array([0.7, -2.5])
    expected = lower + (np.sin(p) + 1) * (upper - lower) / 2
    np.testing.assert_allclose(bounded(p, (lower + upper) / 2, (upper - lower) / 2), expected, rtol=1e-15)


def test_sine_transform_returns():
    centre, half_width = np.array([0.2, -0.8, 1.0]), np.array([2.0, np.pi, 0.1])
    wanted = centre + half_width * np.array([0.0, 0.99, -0.5])
    unbounded = np.arcsin((wanted - centre) / half_width)
    np.testing.assert_allclose(bounded(unbounded, centre, half_width), wanted, rtol=1e-15)


def test_start_is_the_middle_and_the_edge_is_never_passed():
    np.testing.assert_array_equal(bounded(np.zeros(6), SIGMA, 2.0), SIGMA)
    reached = bounded(np.linspace(-50, 50, 1001), 1.0, 2.0)
    assert reached.min() >= -1.0
    assert reached.max() <= 3.0


def test_search_of_the_paper():
    assert Search() == Search(half_width_m=2.0, half_width_deg=180.0, x_tolerance=1e-5, f_tolerance=1e-8)


def test_optimum_is_the_known_minimum(gaussian, pose_covariance, true_pose):
    found = optimise(gaussian, true_pose + 0.3)
    expected = gaussian.measured.mean(axis=0)
    # Powell ends when -log L changes by less than 1e-8 of itself, about 25 here: 5e-7 = d^2 / 2 is 1e-3 sigma a turn
    distance = np.linalg.solve(np.linalg.cholesky(pose_covariance), found.parameters - expected)
    assert np.linalg.norm(distance) < 0.01
    at_minimum = -gaussian.log_likelihood(expected)
    assert found.neg_log_likelihood == pytest.approx(at_minimum, abs=0.5 * 0.01**2)
    assert found.neg_log_likelihood == -gaussian.log_likelihood(found.parameters)
    assert found.converged


def test_evaluations_are_counted(function_likelihood):
    likelihood = function_likelihood(lambda p: np.sum((p / SIGMA) ** 2, axis=1))
    calls = []
    single = likelihood.log_likelihood
    likelihood.log_likelihood = lambda parameters: calls.append(1) or single(parameters)
    assert optimise(likelihood, np.full(6, 0.1)).n_evaluations == len(calls)


def test_search_stays_within_its_range(function_likelihood):
    likelihood = function_likelihood(lambda p: np.sum((p - 10.0) ** 2, axis=1))
    start = np.array([1.0, 2.0, 3.0, 0.1, 0.2, 0.3])
    found = optimise(likelihood, start, Search(half_width_m=0.5, half_width_deg=float(np.degrees(0.2))))
    reached = found.parameters - start
    assert np.all(reached <= np.repeat([0.5, 0.2], 3) + 1e-15)
    # the sine ends flat: where -log L changes by less than 1e-8 of itself, a search stops
    np.testing.assert_allclose(reached, np.repeat([0.5, 0.2], 3), rtol=1e-4)


def test_coarser_tolerances_take_fewer_evaluations(gaussian, true_pose):
    fine = optimise(gaussian, true_pose + 0.3)
    coarse = optimise(gaussian, true_pose + 0.3, Search(x_tolerance=0.1, f_tolerance=0.1))
    assert coarse.n_evaluations < fine.n_evaluations


@pytest.mark.filterwarnings("error")  # Powell's parabolas through infinite values warn, and lead anywhere
def test_undefined_half_of_the_range_is_left_alone(function_likelihood):
    def negative(p):
        return np.where(p[:, 0] < -0.05, np.inf, np.sum((p / SIGMA) ** 2, axis=1))

    found = optimise(function_likelihood(negative), np.full(6, 0.1))
    np.testing.assert_allclose(found.parameters, 0.0, atol=1e-3)
    assert found.converged


@pytest.mark.parametrize("nothing", [np.inf, np.nan])
def test_likelihood_that_is_nowhere_defined_does_not_converge(function_likelihood, nothing):
    assert not optimise(function_likelihood(lambda p: np.full(len(p), nothing)), np.zeros(6)).converged


def test_refuses_a_start_that_is_no_pose(gaussian):
    with pytest.raises(InputError) as error:
        optimise(gaussian, [0.0, 0.0, np.nan, 0.0, 0.0, 0.0])
    assert str(error.value) == (
        "start pose: found [0.0, 0.0, nan, 0.0, 0.0, 0.0], expected six finite numbers; replace what is not a number"
    )


def test_laplace_covariance_of_a_gaussian_is_its_own(gaussian, pose_covariance):
    found = laplace_covariance(gaussian, gaussian.measured.mean(axis=0))
    # second differences of 1e-4 from values near 25, each rounded to 25 eps: relative 4e-11, in units of sigma;
    # a few roundings each add up
    whitening = np.linalg.inv(np.linalg.cholesky(pose_covariance))
    np.testing.assert_allclose(whitening @ found @ whitening.T, np.eye(6), rtol=0, atol=1e-9)


def test_laplace_covariance_beside_the_optimum_is_the_same(gaussian, pose_covariance):
    beside = gaussian.measured.mean(axis=0) + 0.1 * np.sqrt(np.diag(pose_covariance))
    np.testing.assert_allclose(laplace_covariance(gaussian, beside), pose_covariance, rtol=1e-7)


def test_laplace_covariance_takes_the_curvature_at_the_optimum_only(function_likelihood):
    # cosh has unit curvature and unit fourth derivative: steps of 0.02 sigma add 0.02^2 / 12 of themselves
    likelihood = function_likelihood(lambda p: np.sum(np.cosh(p / SIGMA), axis=1))
    found = laplace_covariance(likelihood, np.zeros(6))
    np.testing.assert_allclose(found, np.diag(SIGMA**2), rtol=0.02**2 / 12 * 1.05, atol=1e-9 * SIGMA.max() ** 2)


def test_laplace_covariance_of_nearly_dependent_parameters(function_likelihood):
    # steps along the parameters, a hundredth of their own sigma long, would be many sigmas of the narrow direction
    turn = np.linalg.qr(np.random.default_rng(2).normal(size=(6, 6)))[0]
    widths = np.array([1e-4, 0.3, 0.01, 0.02, 0.05, 0.1])
    likelihood = function_likelihood(lambda p: np.sum(np.cosh(p @ turn / widths), axis=1))
    found = turn.T @ laplace_covariance(likelihood, np.zeros(6)) @ turn
    np.testing.assert_allclose(found / np.outer(widths, widths), np.eye(6), rtol=0, atol=1e-4)


@pytest.mark.parametrize("seed", range(12))
def test_direction_that_the_data_leave_open_is_an_error(function_likelihood, seed):
    flat = np.random.default_rng(seed).normal(size=6)
    flat /= np.linalg.norm(flat)
    likelihood = function_likelihood(lambda p: 50.0 + 450 * np.sum((p - np.outer(p @ flat, flat)) ** 2, axis=1))
    with pytest.raises(EstimationError) as error:
        laplace_covariance(likelihood, np.ones(6))
    assert str(error.value) == (
        "Laplace covariance: the curvature of the likelihood at the optimum is not positive definite; "
        "the observations leave a direction of the pose open: add views from other sides or with other tilts"
    )


def test_saddle_is_an_error(function_likelihood):
    likelihood = function_likelihood(lambda p: np.sum((p / SIGMA) ** 2 * [1, 1, 1, -1, 1, 1], axis=1))
    with pytest.raises(EstimationError, match="not positive definite"):
        laplace_covariance(likelihood, np.zeros(6))


@pytest.mark.parametrize("nothing", [np.inf, np.nan])
def test_undefined_neighbourhood_is_an_error(function_likelihood, nothing):
    likelihood = function_likelihood(lambda p: np.where(p[:, 2] > 1e-9, nothing, np.sum(p**2, axis=1)))
    with pytest.raises(EstimationError) as error:
        laplace_covariance(likelihood, np.zeros(6))
    assert str(error.value) == (
        "Laplace covariance: the likelihood is undefined at the optimum or beside it, where a point lies behind the "
        "camera; check the hand-measured pose and the observations"
    )


def test_gradients_climb_to_the_known_minimum(gaussian, pose_covariance, true_pose):
    found = minimise(gaussian, true_pose + np.array([0.1, -0.1, 0.1, 0.03, 0.03, -0.03]), true_pose)
    expected = gaussian.measured.mean(axis=0)
    distance = np.linalg.solve(np.linalg.cholesky(laplace_covariance(gaussian, expected)), found.parameters - expected)
    assert np.linalg.norm(distance) < 0.02  # gradient below 1e-3 a unit, which is some sigmas
    assert found.converged


def test_climb_without_an_optimum_is_told(function_likelihood):
    assert not minimise(function_likelihood(lambda p: np.full(len(p), np.inf)), np.zeros(6), np.zeros(6)).converged


def test_climb_starts_from_a_finite_pose(gaussian):
    with pytest.raises(InputError, match="start pose"):
        minimise(gaussian, np.zeros(6), [np.nan] * 6)

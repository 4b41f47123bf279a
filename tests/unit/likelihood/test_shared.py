import numpy as np
import pytest

from linepose.errors import EstimationError, InputError
from linepose.likelihood.shared import SharedLikelihood, SharedPriors
from unit.likelihood import dense_shared
from unit.likelihood.small_survey import CAMERA, DISTORTED, POSE, Truth, make_survey, without

RELATIVE = 1e-9  # the issue's; rounding of the dense form's solves is about 1e-12


def parameters_near(likelihood, seed=1, levels=(0.6, 0.2, 1.3), spread=0.01):
    random = np.random.default_rng(seed)
    vector = likelihood.start(POSE + random.normal(0, spread, 6))
    vector[6:9] = np.log(levels)
    vector[9] += random.normal(0, 1)
    vector[10] += random.normal(0, 5e-5)
    return vector


@pytest.mark.parametrize(("n_views", "n_points"), [(2, 1), (3, 2), (5, 15), (12, 4)])
@pytest.mark.parametrize("camera", [CAMERA, DISTORTED])
def test_it_is_the_dense_form(n_views, n_points, camera):
    survey = make_survey(n_views, n_points, Truth(0.5, 0.1, 1.0), seed=n_views, camera=camera)
    likelihood = SharedLikelihood(survey, camera)
    for seed in range(3):
        vector = parameters_near(likelihood, seed)
        expected = dense_shared.log_likelihood(survey, camera, vector)
        assert likelihood.log_likelihood(vector) == pytest.approx(expected, rel=RELATIVE)


def test_missing_points_and_views_of_one_point_are_the_dense_form():
    survey = without(make_survey(5, 4, Truth(0.5), seed=3), (0, 1), (1, 1), (1, 2), (1, 3), (3, 0))
    likelihood = SharedLikelihood(survey, CAMERA)
    vector = parameters_near(likelihood)
    expected = dense_shared.log_likelihood(survey, CAMERA, vector)
    assert likelihood.log_likelihood(vector) == pytest.approx(expected, rel=RELATIVE)


def test_a_point_on_one_ray_changes_nothing():
    survey = make_survey(4, 4, Truth(0.5), seed=3)
    single = without(survey, (0, 3), (1, 3), (2, 3))
    absent = without(single, (3, 3))
    vector = parameters_near(SharedLikelihood(survey, CAMERA))
    assert SharedLikelihood(single, CAMERA).log_likelihood(vector) == (
        SharedLikelihood(absent, CAMERA).log_likelihood(vector)
    )


def test_without_a_shared_error_the_lines_are_independent():
    """Level a = 0: a sum over points of small independent problems, each with its own 2 x 2 covariances."""
    survey = make_survey(5, 3, Truth(white=0.5), seed=5)
    likelihood = SharedLikelihood(survey, CAMERA)
    vector = parameters_near(likelihood)
    vector[6] = -40.0
    total = dense_shared.log_prior(CAMERA, vector)
    for point in range(3):
        others = [(view, k) for view in range(5) for k in range(3) if k != point]
        alone = without(survey, *others)
        total += SharedLikelihood(alone, CAMERA).log_likelihood(vector) - dense_shared.log_prior(CAMERA, vector)
    assert likelihood.log_likelihood(vector) == pytest.approx(total, rel=RELATIVE)
    vector[6] = 0.0
    assert abs(likelihood.log_likelihood(vector) - total) > 1.0


def test_without_a_white_error_the_lines_own_noise_is_the_pixel():
    survey = make_survey(5, 3, Truth(0.5), seed=5)
    likelihood = SharedLikelihood(survey, CAMERA)
    vector = parameters_near(likelihood)
    vector[7] = -40.0
    expected = dense_shared.log_likelihood(survey, CAMERA, vector)
    assert likelihood.log_likelihood(vector) == pytest.approx(expected, rel=RELATIVE)


def test_zero_covariance_leaves_the_navigation_levels_to_their_prior():
    survey = make_survey(4, 3, Truth(), seed=6)
    survey.covariance[:] = 0.0
    likelihood = SharedLikelihood(survey, CAMERA)
    first = parameters_near(likelihood)
    second = first.copy()
    second[6:8] += 1.0
    change = dense_shared.log_prior(CAMERA, second) - dense_shared.log_prior(CAMERA, first)
    assert likelihood.log_likelihood(second) - likelihood.log_likelihood(first) == pytest.approx(change, abs=1e-9)


def test_singular_covariance_is_the_dense_form():
    survey = make_survey(4, 3, Truth(), seed=6)
    direction = np.array([0.01, 0.0, 0.005, 0.0, 2e-3, 1e-3])
    survey.covariance[:] = np.outer(direction, direction)
    likelihood = SharedLikelihood(survey, CAMERA)
    vector = parameters_near(likelihood)
    expected = dense_shared.log_likelihood(survey, CAMERA, vector)
    assert likelihood.log_likelihood(vector) == pytest.approx(expected, rel=RELATIVE)


def test_negative_covariance_is_refused():
    survey = make_survey(3, 2, Truth(), seed=6)
    survey.covariance[1, 0] = -survey.covariance[1, 0]
    with pytest.raises(InputError, match=r"observation 2: .*positive semidefinite"):
        SharedLikelihood(survey, CAMERA)


def test_an_observed_point_without_covariance_is_refused():
    survey = make_survey(3, 2, Truth(), seed=6)
    survey.covariance[2, 1, 0, 0] = np.nan
    with pytest.raises(InputError, match="observation 3, point 1: found a covariance that is not finite"):
        SharedLikelihood(survey, CAMERA)


def test_a_survey_without_a_common_point_is_refused():
    survey = without(make_survey(2, 2, Truth(), seed=6), (0, 0), (1, 1))
    with pytest.raises(InputError, match="no point that two observations have"):
        SharedLikelihood(survey, CAMERA)


def test_a_prior_without_width_is_refused():
    with pytest.raises(InputError, match="level_log_sigma"):
        SharedLikelihood(make_survey(3, 2, Truth(), seed=6), CAMERA, SharedPriors(level_log_sigma=0.0))


def test_points_behind_the_camera_have_no_probability():
    survey = make_survey(4, 3, Truth(), seed=6)
    likelihood = SharedLikelihood(survey, CAMERA)
    backwards = likelihood.start(POSE)
    half_turn = dense_shared.vector_matrix(POSE[3:]) @ np.diag([1.0, -1.0, -1.0])
    angle = np.arccos((np.trace(half_turn) - 1) / 2)
    axis = np.array(
        [half_turn[2, 1] - half_turn[1, 2], half_turn[0, 2] - half_turn[2, 0], half_turn[1, 0] - half_turn[0, 1]]
    )
    backwards[3:6] = angle * axis / np.linalg.norm(axis)
    assert likelihood.log_likelihood(backwards) == -np.inf
    assert likelihood.log_likelihoods(np.stack([backwards, likelihood.start(POSE)]))[0] == -np.inf
    with pytest.raises(EstimationError, match="in front of the camera"):
        likelihood.residuals(backwards)


@pytest.mark.parametrize(("index", "value"), [(0, np.nan), (3, np.inf), (10, -8e-3), (6, 800.0), (8, 800.0)])
def test_undefined_parameters_have_no_probability(index, value):
    likelihood = SharedLikelihood(make_survey(4, 3, Truth(), seed=6), CAMERA)
    vector = likelihood.start(POSE)
    vector[index] = value
    assert likelihood.log_likelihood(vector) == -np.inf


def test_rows_are_the_same_one_by_one():
    likelihood = SharedLikelihood(make_survey(6, 5, Truth(0.5), seed=8), CAMERA)
    rows = np.stack([parameters_near(likelihood, seed) for seed in range(20)])
    assert np.array_equal(likelihood.log_likelihoods(rows), [likelihood.log_likelihood(row) for row in rows])


def test_selection_is_the_model_of_the_selected_views():
    survey = make_survey(6, 5, Truth(0.5), seed=8)
    likelihood = SharedLikelihood(survey, CAMERA, SharedPriors(level_median=0.7))
    vector = parameters_near(likelihood)
    again = SharedLikelihood(survey.select([2, 5, 6]), CAMERA, SharedPriors(level_median=0.7))
    assert likelihood.select([2, 5, 6]).log_likelihood(vector) == again.log_likelihood(vector)


def test_parameters_are_named_and_searched_within_their_priors():
    likelihood = SharedLikelihood(make_survey(3, 2, Truth(), seed=6), CAMERA)
    assert likelihood.n_parameters == len(likelihood.start(POSE)) == 11
    assert likelihood.parameter_names[9:] == ("principal_point_px", "focal_length_m")
    assert np.allclose(likelihood.half_widths(2.0, np.pi), [2] * 3 + [np.pi] * 3 + [4.5] * 3 + [6.0, 3e-4])
    assert np.allclose(likelihood.initial_walker_sigma(0.1, 0.01), [0.1] * 3 + [0.01] * 3 + [0.045] * 3 + [0.06, 3e-6])


def test_residuals_are_those_of_the_estimated_points():
    survey = without(make_survey(5, 4, Truth(0.5), seed=3), (0, 1))
    likelihood = SharedLikelihood(survey, CAMERA)
    vector = parameters_near(likelihood)
    found = likelihood.residuals(vector)
    lines, used = dense_shared.lines_of(survey)
    points = found.point_m.ravel()
    residual, design, by_body = dense_shared.linearised(survey, CAMERA, vector, lines, used, points)
    covariance = dense_shared.covariance_of(survey, CAMERA, vector, lines, used, by_body)
    information = design.T @ np.linalg.solve(covariance, design)
    spread = np.linalg.inv(information)
    # the estimate is at the minimum: what a further step would move is far below its sigma
    step = spread @ design.T @ np.linalg.solve(covariance, residual)
    assert np.all(np.abs(step) < 1e-3 * np.sqrt(np.diag(spread)))
    for row, (i, k) in enumerate(lines):
        pair = slice(2 * row, 2 * row + 2)
        length = np.linalg.norm(residual[pair])
        assert np.allclose(found.error_uv_px[i, k], residual[pair], rtol=0, atol=1e-9)
        assert found.error_px[i, k] == pytest.approx(length, rel=1e-9)
        along = residual[pair] / length
        assert found.sigma_px[i, k] == pytest.approx(np.sqrt(along @ covariance[pair, pair] @ along), rel=1e-9)
    for k in range(4):
        block = slice(3 * k, 3 * k + 3)
        assert np.allclose(found.point_covariance[k], spread[block, block], rtol=1e-7, atol=0)
    assert np.isnan(found.error_px[0, 1])

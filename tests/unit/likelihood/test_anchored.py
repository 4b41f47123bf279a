"""The anchored model: what it shares with the shared-error model, and what it does not reward."""

from dataclasses import replace

import dense_shared
import numpy as np
import pytest
from small_survey import CAMERA, POSE, Truth, make_survey, without

from linepose.errors import InputError
from linepose.likelihood.anchored import AnchoredLikelihood, body_rates
from linepose.likelihood.anchored_rows import anchored_log_determinant
from linepose.likelihood.shared import SharedLikelihood
from linepose.likelihood.shared_kernel import Levels
from linepose.rotations import matrix_from_rotation_vector, rotation_vector_from_matrix

LEVELS = (0.6, 0.2, 1.3)


def moving(survey):
    """The survey with times: every point one second after the one before."""
    times = 1_000_000 * np.arange(survey.n_points) * np.ones((survey.n_observations, 1), dtype=np.int64)
    return replace(survey, time_us=times.astype(np.int64))


def vector_of(likelihood, pose=POSE, levels=LEVELS):
    vector = likelihood.start(pose)
    vector[6:9] = np.log(levels)
    return vector


@pytest.mark.parametrize("timed", [True, False])
def test_determinants_are_the_dense_ones_at_the_anchor(timed):
    survey = without(make_survey(5, 6, Truth(0.5, 0.1), seed=2), (0, 1), (3, 0))
    survey = moving(survey) if timed else survey
    likelihood = AnchoredLikelihood(survey, CAMERA, POSE)
    lines, used = dense_shared.lines_of(survey)
    points = likelihood._anchor.points_m.ravel()
    vector = vector_of(likelihood)
    _, design, by_body = dense_shared.linearised(survey, CAMERA, vector, lines, used, points)
    covariance = dense_shared.covariance_of(survey, CAMERA, vector, lines, used, by_body)
    information = design.T @ np.linalg.solve(covariance, design)
    expected = np.linalg.slogdet(covariance)[1] + np.linalg.slogdet(information)[1]
    found = anchored_log_determinant(likelihood._arrays, likelihood._fixed, likelihood._anchor, Levels(*LEVELS))
    assert found == pytest.approx(expected, rel=1e-9)


def test_without_times_chi_squared_is_that_of_the_shared_error_model():
    survey = make_survey(5, 6, Truth(0.5, 0.1), seed=2)
    anchored, shared = AnchoredLikelihood(survey, CAMERA, POSE), SharedLikelihood(survey, CAMERA)
    for pose in (POSE, POSE + 0.02):
        vector = vector_of(shared, pose)
        difference = anchored.log_likelihood(vector) - shared.log_likelihood(vector)
        determinants = shared._weighted_marginal(vector)[0].log_determinant
        anchor = anchored_log_determinant(anchored._arrays, anchored._fixed, anchored._anchor, Levels(*LEVELS))
        assert difference == pytest.approx(0.5 * (determinants - anchor), abs=1e-9)


def test_rows_are_the_single_evaluations():
    likelihood = AnchoredLikelihood(moving(make_survey(4, 5, Truth(0.5), seed=3)), CAMERA, POSE)
    rows = vector_of(likelihood) + 0.01 * np.random.default_rng(1).standard_normal((7, 11)) * [*[1] * 10, 1e-3]
    np.testing.assert_array_equal(likelihood.log_likelihoods(rows), [likelihood.log_likelihood(row) for row in rows])


def test_body_rates_are_the_slopes_and_yaw_goes_round():
    survey = moving(make_survey(2, 4, Truth(0.0), seed=3))
    seconds = np.arange(4.0)
    position = np.stack([0.3 * seconds, -0.1 * seconds, 0 * seconds], axis=-1)
    yaw = (3.0 + 0.1 * seconds + np.pi) % (2 * np.pi) - np.pi
    survey.position_m[0], survey.euler_rad[0] = position, np.stack([0 * yaw, 0.02 * seconds, yaw], axis=-1)
    np.testing.assert_allclose(body_rates(survey)[0], [0.3, -0.1, 0, 0, 0.02, 0.1], atol=1e-12)
    assert np.all(np.isnan(body_rates(replace(survey, time_us=0 * survey.time_us))))


@pytest.mark.statistical
def test_chi_squared_pulls_the_pose_nowhere_under_white_navigation_errors():
    # The determinants of the shared-error model pull along the optical axis by the residuals over the distance.
    step, axis = 1e-4, np.zeros(11)
    axis[:3] = step * matrix_from_rotation_vector(POSE[3:])[:, 2]
    anchored, shared = [], []
    for seed in range(40):
        survey = make_survey(6, 6, Truth(0.0, 2.0, 0.2), seed)
        models = AnchoredLikelihood(survey, CAMERA, POSE), SharedLikelihood(survey, CAMERA)
        for model, slopes in zip(models, (anchored, shared), strict=True):
            vector = vector_of(model, levels=(1e-3, 2.0, 0.2))
            slopes.append((model.log_likelihood(vector + axis) - model.log_likelihood(vector - axis)) / (2 * step))
    error = np.std(anchored) / np.sqrt(40)
    assert abs(np.mean(anchored)) < 4 * error
    assert abs(np.mean(shared)) > 4 * error


def test_selection_keeps_the_anchor():
    survey = moving(make_survey(5, 4, Truth(0.5), seed=3))
    part = AnchoredLikelihood(survey, CAMERA, POSE).select([1, 2, 4])
    vector = vector_of(part)
    assert part.log_likelihood(vector) == AnchoredLikelihood(survey.select([1, 2, 4]), CAMERA, POSE).log_likelihood(
        vector
    )


def test_anchor_that_looks_away_is_told():
    about_y = matrix_from_rotation_vector(np.array([0.0, np.pi, 0.0]))  # each ray becomes its own opposite
    turned = POSE.copy()
    turned[3:] = rotation_vector_from_matrix(matrix_from_rotation_vector(POSE[3:]) @ about_y)
    with pytest.raises(InputError, match="anchor pose"):
        AnchoredLikelihood(make_survey(3, 3, Truth(0.0), seed=1), CAMERA, turned)

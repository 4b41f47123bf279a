"""The balanced model: the shared-error model whose determinants do not pull on the pose."""

from dataclasses import replace

import numpy as np
import pytest

from linepose.errors import InputError
from linepose.geometry.rotations import matrix_from_rotation_vector, rotation_vector_from_matrix
from linepose.likelihood.balanced import BalancedLikelihood, Reference, body_rates
from linepose.likelihood.balanced_rows import log_determinant_at
from linepose.likelihood.shared import SharedLikelihood
from linepose.likelihood.shared_kernel import Levels, optics_at
from unit.likelihood import dense_shared
from unit.likelihood.small_survey import CAMERA, POSE, Truth, make_survey, without

LEVELS = (0.6, 0.2, 1.3)
OTHERS = Levels(0.9, 0.05, 0.7)


def moving(survey):
    """The survey with times: every point one second after the one before."""
    times = 1_000_000 * np.arange(survey.n_points) * np.ones((survey.n_observations, 1), dtype=np.int64)
    return replace(survey, time_us=times.astype(np.int64))


def balanced_at(survey, levels=OTHERS, pose=POSE):
    return BalancedLikelihood(survey, CAMERA, lambda *_: Reference(pose, Levels(*levels)))


def vector_of(likelihood, pose=POSE, levels=LEVELS):
    vector = likelihood.start(pose)
    vector[6:9] = np.log(levels)
    return vector


@pytest.mark.parametrize("timed", [True, False])
def test_determinants_are_the_dense_ones(timed):
    # at the reference pose, where noise across the line is the camera's whether or not the body moves
    survey = without(make_survey(5, 6, Truth(0.5, 0.1), seed=2), (0, 1), (3, 0))
    survey = moving(survey) if timed else survey
    likelihood = balanced_at(survey)
    lines, used = dense_shared.lines_of(survey)
    vector = vector_of(likelihood)
    optics = optics_at(vector, likelihood._fixed)
    points = SharedLikelihood(survey, CAMERA).residuals(vector).point_m[used]
    _, design, by_body = dense_shared.linearised(survey, CAMERA, vector, lines, used, points.ravel())
    covariance = dense_shared.covariance_of(survey, CAMERA, vector, lines, used, by_body)
    information = design.T @ np.linalg.solve(covariance, design)
    expected = np.linalg.slogdet(covariance)[1] + np.linalg.slogdet(information)[1]
    found = log_determinant_at(likelihood._arrays, optics, Levels(*LEVELS), points)
    # the body moves past the point along which it was noisy: rates come from noisy poses, and so a little aslant
    assert found == pytest.approx(expected, rel=1e-9 if not timed else 2e-2)


def test_at_the_references_levels_chi_squared_alone_remains():
    survey = make_survey(5, 6, Truth(0.5, 0.1), seed=2)
    balanced, shared = balanced_at(survey, LEVELS), SharedLikelihood(survey, CAMERA)
    for pose in (POSE, POSE + 0.02):
        vector = vector_of(shared, pose)
        fit = shared._weighted_marginal(vector)[0]
        prior = shared.log_likelihood(vector) + 0.5 * (fit.chi_squared + fit.log_determinant)
        # the last determinants are linearised at the points found, one step after the first ones
        assert balanced.log_likelihood(vector) == pytest.approx(prior - 0.5 * fit.chi_squared, abs=0.05)


def test_other_levels_are_told_apart_as_in_the_shared_error_model():
    survey = make_survey(5, 6, Truth(0.5, 0.1), seed=2)
    balanced, shared = balanced_at(survey), SharedLikelihood(survey, CAMERA)
    more = vector_of(shared, levels=(0.7, 0.3, 1.0))
    gain = balanced.log_likelihood(more) - balanced.log_likelihood(vector_of(shared))
    assert gain == pytest.approx(shared.log_likelihood(more) - shared.log_likelihood(vector_of(shared)), abs=0.05)


def test_rows_are_the_single_evaluations():
    likelihood = balanced_at(moving(make_survey(4, 5, Truth(0.5), seed=3)))
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
@pytest.mark.parametrize(("white", "pixel"), [(2.0, 0.2), (1e-3, 1.0)])
def test_nothing_pulls_the_pose_along_the_optical_axis(white, pixel):
    # The determinants of the shared-error model do, where navigation errors are white: by residuals over distance.
    step, axis = 1e-4, np.zeros(11)
    axis[:3] = step * matrix_from_rotation_vector(POSE[3:])[:, 2]
    balanced, shared = [], []
    for seed in range(40):
        survey = make_survey(6, 6, Truth(0.0, white, pixel), seed)
        models = balanced_at(survey, (1e-3, white, pixel)), SharedLikelihood(survey, CAMERA)
        for model, slopes in zip(models, (balanced, shared), strict=True):
            vector = vector_of(model, levels=(1e-3, white, pixel))
            slopes.append((model.log_likelihood(vector + axis) - model.log_likelihood(vector - axis)) / (2 * step))
    error = np.std(balanced) / np.sqrt(40)
    assert abs(np.mean(balanced)) < 4 * error
    if white > pixel:
        assert abs(np.mean(shared)) > 4 * error


def test_selection_finds_a_reference_of_its_own():
    survey = moving(make_survey(5, 4, Truth(0.5), seed=3))
    asked = []

    def refer(part, camera):
        asked.append(part.n_observations)
        return Reference(POSE, OTHERS)

    part = BalancedLikelihood(survey, CAMERA, refer).select([1, 2, 4])
    vector = vector_of(part)
    assert asked == [5, 3]
    assert part.log_likelihood(vector) == balanced_at(survey.select([1, 2, 4])).log_likelihood(vector)


def test_reference_that_looks_away_is_told():
    about_y = matrix_from_rotation_vector(np.array([0.0, np.pi, 0.0]))  # each ray becomes its own opposite
    turned = POSE.copy()
    turned[3:] = rotation_vector_from_matrix(matrix_from_rotation_vector(POSE[3:]) @ about_y)
    with pytest.raises(InputError, match="reference pose"):
        balanced_at(make_survey(3, 3, Truth(0.0), seed=1), pose=turned)

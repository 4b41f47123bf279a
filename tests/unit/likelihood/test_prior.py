"""The pose's prior: against densities written out by another way, and on a posterior that is known in closed form."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from scipy.stats import multivariate_normal

from linepose.errors import InputError
from linepose.estimation.noise_models import likelihood_of
from linepose.estimation.optimise import laplace_covariance, optimise
from linepose.likelihood.prior import WithPrior, pose_prior
from unit.likelihood.surveys import DISTORTED_CAMERA, SYNTHETIC_POSE, synthetic_survey

CENTRE = np.array([0.2, -0.1, -0.8, -0.8, 0.75, -1.4])
COVARIANCE = np.diag([0.1, 0.1, 0.1, 0.03, 0.04, 0.05]) ** 2


def turned(pose, turn):
    """The pose with its rotation turned about the body's axes by a rotation vector."""
    rotation = Rotation.from_rotvec(turn) * Rotation.from_rotvec(pose[3:])
    return np.concatenate([pose[:3], rotation.as_rotvec()])


def test_near_its_centre_it_is_the_gaussian_of_position_and_rotation_vector():
    """To first order in the difference: at a tenth of a sigma the next order is 0.1 x 0.05 rad of it."""
    prior = pose_prior(CENTRE, COVARIANCE)
    step = 0.1 * np.sqrt(np.diag(COVARIANCE)) * np.array([1.0, -1.0, 0.5, 1.0, -0.7, 0.6])
    expected = multivariate_normal(np.zeros(6), COVARIANCE).logpdf(step)
    at_centre = multivariate_normal(np.zeros(6), COVARIANCE).logpdf(np.zeros(6))
    assert prior.log_density(CENTRE + step) == pytest.approx(expected - at_centre, rel=0.02)
    assert prior.log_density(CENTRE) == 0.0


def test_a_turn_about_a_body_axis_counts_in_sigmas_of_that_turn():
    prior = pose_prior(CENTRE, COVARIANCE)
    turn = np.array([0.02, -0.5, 0.3])
    squared = turn @ np.linalg.inv(prior.covariance[3:, 3:]) @ turn  # no correlation with the position here
    assert prior.log_density(turned(CENTRE, turn)) == pytest.approx(-0.5 * squared, rel=1e-12)


def test_near_half_a_turn_both_signs_of_the_vector_are_near_the_centre():
    """A rotation of pi + 0.01 about an axis has the vector of pi - 0.01 about the opposite one."""
    axis = np.array([0.6, 0.0, 0.8])
    centre = np.concatenate([CENTRE[:3], (np.pi - 0.005) * axis])
    prior = pose_prior(centre, COVARIANCE)
    beyond = np.concatenate([CENTRE[:3], -(np.pi - 0.005) * axis])
    np.testing.assert_allclose(prior.difference(beyond), [0, 0, 0, *(0.01 * axis)], atol=1e-12)
    assert prior.log_density(beyond) > -1.0


def test_batches_are_what_single_poses_are():
    prior = pose_prior(CENTRE, COVARIANCE)
    poses = CENTRE + 0.05 * np.random.default_rng(1).standard_normal((7, 6))
    np.testing.assert_allclose(prior.log_density(poses), [prior.log_density(pose) for pose in poses], rtol=1e-12)


@pytest.mark.parametrize("wrong", [np.zeros((6, 6)), np.full((6, 6), np.nan), -np.eye(6)])
def test_a_covariance_that_is_none_is_told(wrong):
    with pytest.raises(InputError, match="prior: found a covariance that is not positive definite"):
        pose_prior(CENTRE, wrong)


def test_posterior_of_gaussians_is_the_weighted_mean(gaussian):
    """Eight measurements of the pose with covariance C / 8 together, and a prior: exact in the position."""
    camera_pose = gaussian.measured.mean(axis=0)
    measured = gaussian.covariance / 8
    prior_covariance = np.diag([0.02, 0.03, 0.04, 0.01, 0.01, 0.01]) ** 2
    centre = camera_pose + np.array([0.02, -0.03, 0.04, 0.004, -0.005, 0.003])
    posterior = WithPrior(gaussian, pose_prior(centre, prior_covariance))
    found = optimise(posterior, centre)
    information = np.linalg.inv(measured) + np.linalg.inv(prior_covariance)
    expected = np.linalg.solve(
        information, np.linalg.solve(measured, camera_pose) + np.linalg.solve(prior_covariance, centre)
    )
    sigma = np.sqrt(np.diag(np.linalg.inv(information)))
    # the prior's turn is a rotation vector's difference to first order: 0.005 rad of 0.01, to 1 %
    np.testing.assert_allclose((found.parameters - expected) / sigma, 0.0, atol=0.02)
    covariance = laplace_covariance(posterior, found.parameters)
    np.testing.assert_allclose(
        covariance / np.outer(sigma, sigma), np.linalg.inv(information) / np.outer(sigma, sigma), atol=0.02
    )


def test_a_wide_prior_changes_nothing_and_a_narrow_one_decides():
    survey = synthetic_survey(6, 5, seed=1)
    data = likelihood_of("published", survey, DISTORTED_CAMERA)
    alone = optimise(data, SYNTHETIC_POSE)
    away = SYNTHETIC_POSE + np.array([0.05, -0.05, 0.05, 0.01, 0.01, 0.01])
    wide = likelihood_of("published", survey, DISTORTED_CAMERA, pose_prior(away, 1e8 * COVARIANCE))
    narrow = likelihood_of("published", survey, DISTORTED_CAMERA, pose_prior(away, 1e-10 * COVARIANCE))
    sigma = np.sqrt(np.diag(laplace_covariance(data, alone.parameters)))
    np.testing.assert_allclose(optimise(wide, SYNTHETIC_POSE).parameters / sigma, alone.parameters / sigma, atol=1e-2)
    np.testing.assert_allclose(optimise(narrow, away).parameters, away, atol=1e-5)


def test_what_is_not_the_prior_s_is_the_noise_model_s():
    survey = synthetic_survey(6, 5, seed=1)
    data = likelihood_of("published", survey, DISTORTED_CAMERA)
    both = likelihood_of("published", survey, DISTORTED_CAMERA, pose_prior(CENTRE, COVARIANCE))
    rows = SYNTHETIC_POSE + 1e-3 * np.random.default_rng(2).standard_normal((5, 6))
    expected = data.log_likelihoods(rows) + pose_prior(CENTRE, COVARIANCE).log_density(rows)
    np.testing.assert_array_equal(both.log_likelihoods(rows), expected)
    assert both.log_likelihood(rows[0]) == pytest.approx(expected[0], rel=1e-14)
    np.testing.assert_array_equal(both.residuals(rows[0]).error_px, data.residuals(rows[0]).error_px)
    chosen = [1, 2, 5, 6]
    apart = likelihood_of("published", survey.select(chosen), DISTORTED_CAMERA, pose_prior(CENTRE, COVARIANCE))
    assert both.select(chosen).log_likelihood(rows[0]) == apart.log_likelihood(rows[0])
    assert both.parameter_names == data.parameter_names
    behind = np.array([0.0, 0.0, 0.0, np.pi, 0.0, 0.0])
    assert both.without_cheirality().log_likelihood(behind) == pytest.approx(
        data.without_cheirality().log_likelihood(behind) + pose_prior(CENTRE, COVARIANCE).log_density(behind), rel=1e-12
    )

"""The compiled likelihood against the equations written plainly, and against the published numbers."""

from dataclasses import replace

import numba
import numpy as np
import pytest
from scipy.optimize import minimize

from linepose.errors import EstimationError, InputError
from linepose.geometry.camera import Camera
from linepose.geometry.camera_sigmas import CameraSigmas
from linepose.likelihood import kernel, layout
from linepose.likelihood.layout import LANES
from linepose.likelihood.prepare import survey_rows
from linepose.likelihood.published import PublishedLikelihood
from linepose.likelihood.rays import propagate_covariances, trace_rays
from linepose.likelihood.reprojection import reproject
from linepose.survey.observations import Survey
from unit.likelihood import reference
from unit.likelihood.surveys import DISTORTED_CAMERA, FIELD_CAMERA, INLIERS, SYNTHETIC_POSE, synthetic_survey, with_gaps

# Complex-step Jacobians are exact to rounding; inverting covariances of condition 1e4 to 1e6 leaves some 1e-11.
RELATIVE = 1e-9
PLAIN_CAMERA = Camera(focal_length_m=6e-3, pixel_pitch_m=8e-6, n_pixels=640, principal_point_px=322.0)


def turned(survey: Survey, yaw_rad: float) -> Survey:
    """Every body at one attitude and above its own place: rays of equal pixels are parallel."""
    euler = np.zeros_like(survey.euler_rad)
    euler[..., 2] = yaw_rad
    return replace(survey, euler_rad=euler, u_px=np.full_like(survey.u_px, 200.0))


def assert_same(survey: Survey, camera: Camera, pose: np.ndarray) -> None:
    likelihood, expected = PublishedLikelihood(survey, camera), reference.evaluate(survey, camera, pose)
    obtained = likelihood.residuals(pose)
    assert likelihood.log_likelihood(pose) == pytest.approx(expected.log_likelihood, rel=RELATIVE)
    np.testing.assert_allclose(obtained.error_px, expected.error_px, rtol=RELATIVE)
    np.testing.assert_allclose(obtained.sigma_px, expected.sigma_px, rtol=RELATIVE)
    for name in ("error_uv_px", "point_m", "point_covariance"):
        here, there = getattr(obtained, name), getattr(expected, name)
        np.testing.assert_allclose(here, there, rtol=RELATIVE, atol=RELATIVE * np.nanmax(np.abs(there)))


@pytest.mark.parametrize(
    ("observations", "points", "camera", "offset"),
    [
        (2, 1, DISTORTED_CAMERA, 0.0),
        (6, 5, DISTORTED_CAMERA, 0.05),
        (5, 16, PLAIN_CAMERA, -0.02),
        (4, 35, DISTORTED_CAMERA, 0.01),
    ],
)
def test_agrees_with_the_plain_equations(observations, points, camera, offset):
    survey = synthetic_survey(observations, points, seed=observations, camera=camera)
    assert_same(survey, camera, SYNTHETIC_POSE + offset)


def test_agrees_with_gaps_and_a_point_seen_once(caplog):
    gaps = [
        (0, 0),
        (3, 0),
        (2, 7),
        (0, 16),
        (1, 16),
        (2, 16),
        *((i, 18) for i in range(6)),
        *((i, 3) for i in range(7)),
    ]
    survey = with_gaps(synthetic_survey(7, 21, seed=1), gaps)
    assert_same(survey, DISTORTED_CAMERA, SYNTHETIC_POSE + 0.03)
    assert "3, 18" in caplog.text


def test_a_point_seen_once_changes_nothing():
    survey = synthetic_survey(5, 4, seed=3)
    without = with_gaps(survey, [(i, 2) for i in range(5)])
    once = with_gaps(survey, [(i, 2) for i in range(4)])
    pose = SYNTHETIC_POSE
    assert PublishedLikelihood(once, DISTORTED_CAMERA).log_likelihood(pose) == pytest.approx(
        PublishedLikelihood(without, DISTORTED_CAMERA).log_likelihood(pose), rel=1e-12
    )


@pytest.mark.parametrize("angle", [0.0, 1e-4, 0.0057, 0.0058])  # both sides of the switch to the series
def test_agrees_near_the_zero_rotation_vector(angle):
    pose = np.array([0.1, 0.2, -0.3, angle, -angle, angle])
    assert_same(synthetic_survey(4, 3, seed=5), DISTORTED_CAMERA, pose)


def test_batch_is_bit_identical_to_single_on_any_number_of_threads():
    likelihood = PublishedLikelihood(synthetic_survey(6, 20, seed=2), DISTORTED_CAMERA)
    poses = SYNTHETIC_POSE + np.random.default_rng(0).normal(0, 0.01, (1001, 6))
    single = np.array([likelihood.log_likelihood(pose) for pose in poses])
    threads = numba.get_num_threads()
    try:
        for count in range(1, threads + 1):
            numba.set_num_threads(count)
            np.testing.assert_array_equal(likelihood.log_likelihoods(poses), single)
    finally:
        numba.set_num_threads(threads)
    assert np.all(np.isfinite(single))
    assert likelihood.log_likelihoods(poses[:0]).shape == (0,)


def test_points_behind_the_camera_are_impossible_not_nan():
    likelihood = PublishedLikelihood(synthetic_survey(6, 5, seed=1), DISTORTED_CAMERA)
    pose = SYNTHETIC_POSE.copy()
    pose[2] += 20.0  # below the ground, looking down
    assert likelihood.log_likelihood(pose) == -np.inf
    assert likelihood.log_likelihoods([pose, SYNTHETIC_POSE])[0] == -np.inf
    assert np.isfinite(likelihood.log_likelihood(SYNTHETIC_POSE))


def test_mirrored_model_is_the_plain_equations_behind_the_camera():
    survey = synthetic_survey(6, 5, seed=1)
    pose = SYNTHETIC_POSE.copy()
    pose[2] += 20.0
    model = PublishedLikelihood(survey, DISTORTED_CAMERA).without_cheirality()
    plain = reference.evaluate(survey, DISTORTED_CAMERA, pose)
    expected = -0.5 * np.nansum((plain.error_px / plain.sigma_px) ** 2)
    assert model.log_likelihood(pose) == pytest.approx(expected, rel=RELATIVE)
    assert model.select(survey.number.tolist()).log_likelihoods([pose])[0] == pytest.approx(expected, rel=RELATIVE)
    assert model.log_likelihood(SYNTHETIC_POSE) == PublishedLikelihood(survey, DISTORTED_CAMERA).log_likelihood(
        SYNTHETIC_POSE
    )


def test_parallel_rays_say_nothing():
    survey = synthetic_survey(4, 3, seed=4)
    twin = replace(
        survey,
        u_px=np.vstack([survey.u_px, survey.u_px[:1]]),
        position_m=np.concatenate([survey.position_m, survey.position_m[:1] + 0.01]),
        number=np.arange(1, 6),
        **{
            name: np.concatenate([getattr(survey, name), getattr(survey, name)[:1]])
            for name in ("time_us", "euler_rad", "covariance", "nav_gap_s")
        },
    )
    assert_same(twin, DISTORTED_CAMERA, SYNTHETIC_POSE)


def test_only_parallel_rays_are_impossible():
    likelihood = PublishedLikelihood(turned(synthetic_survey(3, 2, seed=6), 0.3), DISTORTED_CAMERA)
    assert likelihood.log_likelihood(SYNTHETIC_POSE) == -np.inf
    with pytest.raises(EstimationError):
        likelihood.residuals(SYNTHETIC_POSE)


def test_no_error_is_no_nan():
    """A point right on the optical axis: the error has no direction of its own, and its variance is that along x."""
    survey = synthetic_survey(2, 1, seed=1)
    survey = replace(
        survey,
        u_px=np.full((2, 1), PLAIN_CAMERA.principal_point_px),
        position_m=np.zeros((2, 1, 3)),
        euler_rad=np.zeros((2, 1, 3)),
    )
    rows = survey_rows(survey, PLAIN_CAMERA, np.ones((2, 1)), np.zeros((1, 3)))[0]
    scratch, pose, axes, scores = kernel.workspace(2, 1), np.zeros(6), np.eye(3), np.zeros(2 * LANES)
    trace_rays(rows, pose, axes, scratch.rays[0])
    propagate_covariances(rows, pose, axes, scratch.rays[0])
    depth_m, point_variance = 2.0, 1e-4
    points = scratch.points[0]
    points[layout.E_D : layout.E_D + LANES] = depth_m
    points[layout.E_NN : layout.E_NN + LANES] = point_variance
    reproject(rows, pose, axes, scratch.rays[0], points, scratch.residuals[0], scores)
    error_x, error_y, variance = scratch.residuals[0].reshape(2, 3, LANES)[:, :, 0].T
    assert np.all(error_x == 0)
    assert np.all(error_y == 0)
    np.testing.assert_array_equal(scores, 0)
    # By hand: x / z with z = 2 m; the body's pitch moves the point by depth, x by depth / depth.
    by_body = np.array([1 / depth_m, 0, 0, 0, 1, 0])
    from_body = np.einsum("i,nij,j->n", by_body, survey.covariance[:, 0], by_body)
    focal_px, sigmas = PLAIN_CAMERA.focal_length_px, PLAIN_CAMERA.sigmas
    from_camera = (sigmas.u_px**2 + sigmas.principal_point_px**2) / focal_px**2
    np.testing.assert_allclose(variance, from_body + from_camera + point_variance / depth_m**2, rtol=1e-12)


def test_selecting_observations():
    survey = synthetic_survey(6, 5, seed=8)
    numbers = [5, 1, 3]
    whole = PublishedLikelihood(survey, DISTORTED_CAMERA)
    apart = PublishedLikelihood(survey.select(numbers), DISTORTED_CAMERA)
    assert whole.select(numbers).log_likelihood(SYNTHETIC_POSE) == apart.log_likelihood(SYNTHETIC_POSE)


def test_sigmas_of_the_distortion_count():
    survey = synthetic_survey(5, 6, seed=9)
    known = DISTORTED_CAMERA.replaced(sigmas=CameraSigmas(u_px=0.4, v_px=0.6))
    pose = SYNTHETIC_POSE
    sigma_known = PublishedLikelihood(survey, known).residuals(pose).sigma_px
    sigma_vague = PublishedLikelihood(survey, DISTORTED_CAMERA).residuals(pose).sigma_px
    assert np.median(sigma_vague / sigma_known) > 1


def test_a_pixel_without_navigation_is_named():
    survey = synthetic_survey(4, 3, seed=1)
    survey.covariance[2, 1] = np.nan
    with pytest.raises(InputError, match="observation 3, point 1"):
        PublishedLikelihood(survey, DISTORTED_CAMERA)


def test_a_survey_without_two_views_is_refused():
    survey = with_gaps(synthetic_survey(2, 2, seed=1), [(0, 0), (1, 1)])
    with pytest.raises(InputError, match="two views"):
        PublishedLikelihood(survey, DISTORTED_CAMERA)


@pytest.mark.field
def test_published_value(field_survey):
    likelihood = PublishedLikelihood(field_survey, FIELD_CAMERA).select(INLIERS)
    # Seven digits were published.
    assert -likelihood.log_likelihood([0.189, -0.142, -0.794, -0.822, 0.738, -1.429]) == pytest.approx(
        51.63227, abs=5e-6
    )


@pytest.mark.field
@pytest.mark.parametrize(
    ("numbers", "start", "minimum", "digit"),
    [
        (INLIERS, [0.1886, -0.1418, -0.7935, -0.8217, 0.7378, -1.4293], 51.574661, 1e-6),
        (range(1, 26), [0.1471, -0.1285, -0.6300, -0.8489, 0.7683, -1.4201], 236.7813, 1e-4),
    ],
)
def test_published_minimum(field_survey, numbers, start, minimum, digit):
    likelihood = PublishedLikelihood(field_survey, FIELD_CAMERA).select(list(numbers))
    found = minimize(
        lambda pose: -likelihood.log_likelihood(pose), start, method="Powell", options={"ftol": 1e-12, "xtol": 1e-7}
    )
    assert found.fun == pytest.approx(minimum, abs=digit / 2)
    np.testing.assert_allclose(found.x, start, atol=1e-4)


@pytest.mark.field
def test_agrees_with_the_plain_equations_on_the_field_data(field_survey):
    assert_same(field_survey.select(INLIERS), FIELD_CAMERA, np.array([0.189, -0.142, -0.794, -0.822, 0.738, -1.429]))


def test_synthetic_survey_is_seen_from_above():
    """Guards the tests above: the synthetic points do lie in front of the camera, and the model is at its noise."""
    survey = synthetic_survey(12, 10, seed=0)
    residuals = PublishedLikelihood(survey, DISTORTED_CAMERA).residuals(SYNTHETIC_POSE)
    assert 0 < np.nanmedian(residuals.error_px) < 20

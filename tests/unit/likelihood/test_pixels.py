"""Residuals in pixels against derivatives of the plain pixel error, and against the published alternative."""

import numpy as np
import pytest

from linepose.estimation.optimise import optimise
from linepose.likelihood.pixels import PixelLikelihood
from linepose.likelihood.published import PublishedLikelihood
from unit.likelihood.surveys import DISTORTED_CAMERA, FIELD_CAMERA, INLIERS, SYNTHETIC_POSE, synthetic_survey

CAMERA = DISTORTED_CAMERA.replaced(k1=0.0, k2=0.0)


def test_without_an_error_of_the_focal_length_it_changes_nothing():
    camera = CAMERA.replaced(sigmas=CAMERA.sigmas.replaced(focal_length_m=0.0))
    inner = PublishedLikelihood(synthetic_survey(6, 5, seed=1), camera)
    own = PixelLikelihood(inner)
    assert own.log_likelihood(SYNTHETIC_POSE) == pytest.approx(inner.log_likelihood(SYNTHETIC_POSE), rel=1e-12)


def test_variance_has_the_focal_length_act_on_the_reprojected_pixel():
    """Observed u - (f X/Z + u0): f acts through X/Z, where in the plane it acts through (u - u0) / f."""
    survey = synthetic_survey(6, 5, seed=2)
    pose = SYNTHETIC_POSE + 0.02
    inner = PublishedLikelihood(survey, CAMERA)
    plane, pixels = inner.residuals(pose), PixelLikelihood(inner).residuals(pose)
    f, sigma_f = CAMERA.focal_length_px, CAMERA.sigmas.focal_length_m / CAMERA.pixel_pitch_m
    x = (survey.u_px - CAMERA.principal_point_px) / f
    direction = plane.error_uv_px / plane.error_px[..., None]
    reprojected = np.stack([x, np.zeros_like(x)], axis=-1) - plane.error_uv_px / f
    in_plane = direction[..., 0] * x  # f de/df of e = |observed - reprojected|, through the observed ray; sign squared
    in_pixels = np.sum(direction * reprojected, axis=-1)
    expected = plane.sigma_px**2 + sigma_f**2 * (in_pixels**2 - in_plane**2)
    np.testing.assert_allclose(pixels.sigma_px**2, expected, rtol=1e-9)


@pytest.mark.field
def test_field_optimum_moves_as_documented(field_survey):
    """-log L of 51.574661 in the normalised plane and 51.580198 in pixels, where Powell's method stops."""
    inner = PublishedLikelihood(field_survey.select(INLIERS), FIELD_CAMERA)
    start = [0.2, 0.0, -0.8, -0.762, 0.762, -1.433]  # the hand-measured pose
    assert optimise(inner, start).neg_log_likelihood == pytest.approx(51.574661, abs=5e-6)
    assert optimise(PixelLikelihood(inner), start).neg_log_likelihood == pytest.approx(51.580198, abs=5e-6)


def test_rows_and_selection_agree_with_the_single_value():
    survey = synthetic_survey(6, 5, seed=3)
    own = PixelLikelihood(PublishedLikelihood(survey, CAMERA))
    assert own.log_likelihoods([SYNTHETIC_POSE, SYNTHETIC_POSE])[1] == own.log_likelihood(SYNTHETIC_POSE)
    some = PixelLikelihood(PublishedLikelihood(survey.select([2, 4, 5]), CAMERA))
    assert own.select([2, 4, 5]).log_likelihood(SYNTHETIC_POSE) == some.log_likelihood(SYNTHETIC_POSE)
    assert own.without_cheirality().log_likelihood(SYNTHETIC_POSE) == own.log_likelihood(SYNTHETIC_POSE)

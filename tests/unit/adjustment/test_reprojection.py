"""Reprojection errors of an adjustment against a pinhole worked out by hand, and their sigmas against a simulation."""

import numpy as np
import pytest

from linepose.adjustment import AdjustmentSettings, adjust
from linepose.adjustment.reprojection import reprojection
from linepose.geometry.rotations import matrix_from_euler, matrix_from_rotation_vector
from unit.adjustment import timed_survey

CAMERA = timed_survey.CAMERA
QUICK = AdjustmentSettings(line_period_s=timed_survey.LINE_S, n_draws=20, n_samples=50)


def test_errors_are_those_of_a_pinhole_with_distortion():
    survey = timed_survey.make_survey(6, 5, seed=3)
    found = adjust(survey, CAMERA, timed_survey.POSE, settings=QUICK)
    errors = reprojection(survey, CAMERA, found, timed_survey.LINE_S)
    mount, focal_px = matrix_from_rotation_vector(found.pose[3:]), found.focal_length_m / CAMERA.pixel_pitch_m
    for view in range(6):
        for point in range(5):
            body = matrix_from_euler(survey.euler_rad[view, point])
            in_body = body.T @ (found.points_m[point] - survey.position_m[view, point]) - found.pose[:3]
            x, y, z = mount.T @ in_body
            x, y = x / z, y / z
            u_px = found.principal_point_px + focal_px * x * (1 + CAMERA.k1 * x**2 + CAMERA.k2 * x**4)
            expected = [survey.u_px[view, point] - u_px, -focal_px * y]
            np.testing.assert_allclose(errors.error_uv_px[view, point], expected, atol=1e-9)
            assert errors.error_px[view, point] == pytest.approx(np.hypot(*expected), abs=1e-9)
    np.testing.assert_array_equal(errors.point_m, found.points_m)


def test_a_point_that_was_not_seen_has_no_error():
    survey = timed_survey.make_survey(6, 5, seed=3)
    survey.u_px[2, 1] = np.nan
    found = adjust(survey, CAMERA, timed_survey.POSE, settings=QUICK)
    errors = reprojection(survey, CAMERA, found, timed_survey.LINE_S)
    assert np.isnan(errors.error_px[2, 1])
    assert np.isnan(errors.sigma_px[2, 1])
    assert np.isfinite(errors.sigma_px).sum() == 29


@pytest.mark.statistical
def test_sigmas_are_as_large_as_the_errors():
    """Twelve surveys of 12 x 8 points: mean square of error over sigma, of about 20 independent errors a survey.

    Fitted points and pose take some of it; two thirds to five fourths hold it.
    """
    ratios = []
    for seed in range(12):
        survey = timed_survey.make_survey(12, 8, seed=100 + seed)
        found = adjust(survey, CAMERA, timed_survey.POSE, settings=QUICK)
        errors = reprojection(survey, CAMERA, found, timed_survey.LINE_S)
        # along the line and across it one after the other: of a 2D error the sigma in its direction is the larger
        ratios.append(np.nanmean((errors.error_px / errors.sigma_px) ** 2))
    assert 0.67 < np.mean(ratios) < 1.9

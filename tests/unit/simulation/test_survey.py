from dataclasses import replace

import numpy as np
import pytest

from linepose.geometry import camera as camera_module
from linepose.geometry import rotations
from linepose.simulation.board import world_points
from linepose.simulation.projection import exact_projections
from linepose.simulation.settings import ExtractionSettings, FaultSettings
from linepose.simulation.survey import faulty_observations, simulate_survey
from unit.navigation_errors import gauss_markov


def distances_of_rays_to_points(camera, pose, survey, points):
    rotation = rotations.matrix_from_rotation_vector(pose[3:])
    body = rotations.matrix_from_euler(survey.euler_rad)
    centres, directions = camera_module.rays(camera, rotation, pose[:3], body, survey.position_m, survey.u_px)
    directions /= np.linalg.norm(directions, axis=-1, keepdims=True)
    return np.linalg.norm(np.cross(points - centres, directions), axis=-1)


@pytest.mark.parametrize("lens", [{}, {"k1": -0.1, "k2": 0.05, "p2": 0.01, "tilt": 0.02, "smile": 0.1}])
def test_ray_of_each_true_pixel_meets_its_point(camera, settings, lens):
    bent = camera.replaced(**lens)
    survey, truth = simulate_survey(bent, settings, 0)
    assert np.all(np.isfinite(survey.u_px))
    # time stamps are whole microseconds, but the pose is taken at the exact time
    distances = distances_of_rays_to_points(bent, truth.pose, survey, world_points(settings.board))
    np.testing.assert_allclose(distances, 0.0, atol=1e-10)
    assert np.ptp(survey.u_px) > 100


def test_rotation_on_the_spot_sees_the_points_too(camera, spot_settings):
    survey, truth = simulate_survey(camera, spot_settings, 0)
    seen = np.isfinite(survey.u_px)
    assert seen.any()
    distances = distances_of_rays_to_points(camera, truth.pose, survey, truth.point_m)
    np.testing.assert_allclose(distances[seen], 0.0, atol=1e-10)


def test_same_seed_same_survey(camera, settings):
    noisy = replace(settings, extraction=ExtractionSettings(), navigation_error=gauss_markov([0.01] * 6, 30.0))
    first, again, other = (simulate_survey(camera, noisy, seed)[0] for seed in (7, 7, 8))
    for name in ("u_px", "time_us", "position_m", "euler_rad"):
        np.testing.assert_array_equal(getattr(first, name), getattr(again, name))
        assert not np.array_equal(getattr(first, name), getattr(other, name))


def test_reported_covariance_does_not_depend_on_the_error(camera, settings):
    noisy = replace(settings, navigation_error=gauss_markov([0.5] * 6, 30.0))
    expected = np.square([0.01, 0.013, 0.011, *np.deg2rad([0.24, 0.26, 0.11])])
    for one in (settings, noisy):
        covariance = simulate_survey(camera, one, 0)[0].covariance
        np.testing.assert_allclose(covariance, np.broadcast_to(np.diag(expected), covariance.shape))


@pytest.mark.statistical
def test_extraction_noise_has_its_sigmas(camera, settings):
    many = replace(
        settings,
        passes=settings.passes[:1] * 100,
        extraction=ExtractionSettings(sigma_u_px=0.3, sigma_line=2.0),
    )
    survey, truth = simulate_survey(camera, many, 11)
    tolerance = 4 / np.sqrt(2 * survey.u_px.size)
    assert np.std(survey.u_px - truth.u_px) / 0.3 == pytest.approx(1, abs=tolerance)
    late_s = (survey.time_us - settings.start_time_us) / 1e6 - truth.time_s
    assert np.std(late_s) * 133.0 / 2.0 == pytest.approx(1, abs=tolerance)


def with_fault(settings, **fault):
    return replace(settings, faults=(FaultSettings(observation=2, **fault),))


def test_swapped_points_carry_each_others_measurement(camera, settings):
    clean, _ = simulate_survey(camera, settings, 0)
    faulty, _ = simulate_survey(camera, with_fault(settings, swapped_points=((3, 4),)), 0)
    order = np.arange(15)
    order[[3, 4]] = [4, 3]
    for name in ("u_px", "time_us", "position_m", "euler_rad"):
        np.testing.assert_array_equal(getattr(faulty, name)[1], getattr(clean, name)[1, order])
        np.testing.assert_array_equal(getattr(faulty, name)[[0, 2]], getattr(clean, name)[[0, 2]])


def test_jump_moves_the_second_half_of_the_view(camera, settings):
    clean, truth = simulate_survey(camera, settings, 0)
    jump = {"jump_position_m": (0.1, 0.0, -0.2), "jump_euler_rad": (0.0, 0.02, 0.0)}
    faulty, _ = simulate_survey(camera, with_fault(settings, **jump), 0)
    moved = np.any(faulty.position_m != clean.position_m, axis=-1)
    assert not moved[[0, 2]].any()
    assert 0 < moved[1].sum() < 15
    assert truth.time_s[1, moved[1]].min() > truth.time_s[1, ~moved[1]].max()
    np.testing.assert_allclose((faulty.position_m - clean.position_m)[1, moved[1]], [[0.1, 0, -0.2]] * moved[1].sum())
    np.testing.assert_allclose((faulty.euler_rad - clean.euler_rad)[1, moved[1]], [[0, 0.02, 0]] * moved[1].sum())


def test_clock_offset_takes_the_pose_of_another_moment(camera, settings):
    clean, _ = simulate_survey(camera, settings, 0)
    faulty, _ = simulate_survey(camera, with_fault(settings, clock_offset_s=0.4), 0)
    np.testing.assert_allclose(faulty.time_us[1] - clean.time_us[1], 400_000, atol=1)
    np.testing.assert_array_equal(faulty.u_px, clean.u_px)
    # 0.1 m/s for 0.4 s
    moved = np.linalg.norm((faulty.position_m - clean.position_m)[1, :, :2], axis=-1)
    np.testing.assert_allclose(moved, 0.04, atol=1e-9)


def test_missing_points_are_not_seen_and_spoil_nothing(camera, settings):
    settings = with_fault(settings, missing_points=(0, 14))
    survey, truth = simulate_survey(camera, settings, 0)
    np.testing.assert_array_equal(np.argwhere(np.isnan(survey.u_px)), [[1, 0], [1, 14]])
    assert np.all(np.isfinite(truth.u_px))
    assert faulty_observations(settings) == ()
    assert faulty_observations(with_fault(settings, clock_offset_s=0.1)) == (2,)


def test_points_beyond_the_scan_line_are_not_seen(camera, settings):
    truth = exact_projections(camera.replaced(n_pixels=350), settings)
    assert np.all(truth.u_px[np.isfinite(truth.u_px)] <= 349.5)
    assert np.isnan(truth.u_px).any()

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from linepose.config.platform import load_platform
from linepose.errors import InputError
from linepose.likelihood.published import PublishedLikelihood
from linepose.simulation.noise_levels import NoiseLevels
from linepose.simulation.noisy_survey import draw_survey
from linepose.simulation.settings import ExtractionSettings
from linepose.simulation.survey import faulty_observations, simulate_survey

PLATFORMS = Path(__file__).parents[3] / "config" / "platforms"
SILENT = NoiseLevels(intrinsics_level=0.0)


@pytest.fixture(scope="module", params=["ladybird-sim", "shrimp-sim"])
def platform(request):
    return load_platform(PLATFORMS, request.param)


def residuals(survey, camera, pose):
    return PublishedLikelihood(survey, camera).residuals(pose).error_uv_px


def drawn(platform, levels, seed=1, settings=None, **options):
    """A survey with points as exact as time stamps are, unless settings say otherwise."""
    settings = settings or replace(platform.simulation, extraction=ExtractionSettings(0.0, 0.0))
    return draw_survey(platform.intrinsics(), settings, levels, np.random.default_rng(seed), **options)


def navigation_error(noisy, quiet):
    """Errors (N, M, 6) of a survey beside one without."""
    return np.concatenate([noisy.position_m - quiet.position_m, noisy.euler_rad - quiet.euler_rad], axis=-1)


def test_without_noise_the_truth_has_no_residuals(platform):
    survey, truth = drawn(platform, SILENT)
    error = residuals(survey, platform.intrinsics(), truth)
    assert np.nanmax(np.abs(error)) < 1e-4  # time stamps are whole microseconds
    expected = len(platform.simulation.passes) - len(faulty_observations(platform.simulation))
    assert survey.n_observations == expected == (16 if "0.0082" in str(platform.camera) else 14)


def test_noise_of_points_is_the_platforms_and_the_camera_is_off(platform):
    settings = platform.simulation
    exact, _ = drawn(platform, SILENT)
    noisy, _ = drawn(platform, SILENT, settings=settings)
    count = np.isfinite(exact.u_px).sum()
    assert np.nanstd(noisy.u_px - exact.u_px) == pytest.approx(settings.extraction.sigma_u_px, rel=4 / np.sqrt(count))
    moved, _ = drawn(platform, NoiseLevels())
    assert np.nanmedian(np.abs(moved.u_px - exact.u_px)) > 0.05


def test_shared_error_is_constant_in_a_view_and_of_the_reported_size(platform):
    quiet, _ = drawn(platform, SILENT)
    noisy, _ = drawn(platform, SILENT.replaced(shared_level=2.0))
    error = navigation_error(noisy, quiet)
    np.testing.assert_allclose(error - error[:, :1], 0, atol=1e-12)
    reported = np.sqrt(np.diag(quiet.covariance[0, 0]))
    scaled = np.std(error[:, 0] / reported, axis=0)
    assert np.all((scaled > 0.8) & (scaled < 3.8))  # 14 to 16 views: chi within a factor of 1.9


@pytest.mark.parametrize("level", ["shared_level", "white_level", "correlated_level"])
def test_attitude_errors_alone_are_smaller_where_they_are_said_to_be(platform, level):
    quiet, _ = drawn(platform, SILENT)
    full, _ = drawn(platform, SILENT.replaced(**{level: 1.0}))
    small, _ = drawn(platform, SILENT.replaced(**{level: 1.0}, attitude_level=0.4))
    expected = navigation_error(full, quiet) * np.repeat([1.0, 0.4], 3)
    np.testing.assert_allclose(navigation_error(small, quiet), expected, atol=1e-12)


def test_errors_of_the_platforms_file_are_the_simulators_own(platform):
    survey, truth = drawn(platform, SILENT.replaced(platform_error=True), 3, platform.simulation, with_faults=True)
    random = np.random.default_rng(3)
    random.standard_normal(2)  # of the camera
    simulated, behind = simulate_survey(platform.intrinsics(), platform.simulation, random)
    np.testing.assert_array_equal(survey.position_m, simulated.position_m)
    np.testing.assert_array_equal(survey.u_px, simulated.u_px)
    np.testing.assert_array_equal(truth, behind.pose)


def test_faulty_observations_stay_in_if_asked_for_and_the_others_are_the_same(platform):
    all_, _ = drawn(platform, SILENT, with_faults=True)
    good, truth = drawn(platform, SILENT)
    assert all_.n_observations == len(platform.simulation.passes)
    np.testing.assert_array_equal(all_.select(good.number.tolist()).u_px, good.u_px)
    assert np.nanmax(np.abs(residuals(all_, platform.intrinsics(), truth))) > 5.0


def test_levels_and_the_platforms_own_error_exclude_each_other():
    with pytest.raises(InputError, match="found levels and platform_error"):
        NoiseLevels(platform_error=True, white_level=1.0)

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from linepose.config.platform import load_platform
from linepose.likelihood.published import PublishedLikelihood
from linepose.simulation.noise_levels import NoiseLevels
from linepose.simulation.noisy_survey import draw_survey
from linepose.simulation.survey import faulty_observations, simulate_survey, without_faults

PLATFORMS = Path(__file__).parents[3] / "config" / "platforms"
SILENT = NoiseLevels(pixel_level=0.0, intrinsics_level=0.0)


@pytest.fixture(scope="module", params=["ladybird-sim", "shrimp-sim"])
def platform(request):
    return load_platform(PLATFORMS, request.param)


def residuals(survey, camera, pose):
    return PublishedLikelihood(survey, camera).residuals(pose).error_uv_px


def drawn(platform, levels, seed=1):
    return draw_survey(platform.intrinsics(), platform.simulation, levels, np.random.default_rng(seed))


def test_without_noise_the_truth_has_no_residuals(platform):
    survey, truth = drawn(platform, SILENT)
    error = residuals(survey, platform.intrinsics(), truth)
    assert np.nanmax(np.abs(error)) < 1e-4  # time stamps are whole microseconds
    expected = len(platform.simulation.passes) - len(faulty_observations(platform.simulation))
    assert survey.n_observations == expected == (16 if "0.0082" in str(platform.camera) else 14)


@pytest.mark.statistical
def test_pixel_noise_is_the_cameras(platform):
    camera = platform.intrinsics()
    survey, truth = drawn(platform, SILENT.replaced(pixel_level=1.0))
    error = residuals(survey, camera, truth)
    count = np.isfinite(error[..., 0]).sum()
    for axis, sigma in enumerate((camera.sigmas.u_px, camera.sigmas.v_px)):
        # 45 of some 200 to 240 numbers on both axes go into the points
        assert np.nanstd(error[..., axis]) == pytest.approx(sigma, rel=0.15 + 4 / np.sqrt(2 * count))


def test_noise_of_the_extraction_is_the_simulators(platform):
    settings = without_faults(platform.simulation)
    quiet = replace(settings, navigation_error=type(settings.navigation_error)())
    simulated, _ = simulate_survey(platform.intrinsics(), quiet, 3)
    survey, truth = draw_survey(
        platform.intrinsics(), quiet, NoiseLevels(intrinsics_level=0.0), np.random.default_rng(3)
    )
    ours, theirs = (np.nanstd(residuals(s, platform.intrinsics(), truth), axis=(0, 1)) for s in (survey, simulated))
    np.testing.assert_allclose(ours, theirs, rtol=0.3)


def test_shared_error_is_constant_in_a_view_and_of_the_reported_size(platform):
    quiet, _ = drawn(platform, SILENT)
    noisy, _ = drawn(platform, SILENT.replaced(shared_level=2.0))
    error = np.concatenate([noisy.position_m - quiet.position_m, noisy.euler_rad - quiet.euler_rad], axis=-1)
    np.testing.assert_allclose(error - error[:, :1], 0, atol=1e-12)
    reported = np.sqrt(np.diag(quiet.covariance[0, 0]))
    scaled = np.std(error[:, 0] / reported, axis=0)
    assert np.all((scaled > 0.8) & (scaled < 3.8))  # 14 to 16 views: chi within a factor of 1.9

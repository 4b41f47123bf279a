from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import yaml

from linepose.geometry import rotations
from linepose.geometry.camera import Camera
from linepose.geometry.camera_sigmas import CameraSigmas
from linepose.likelihood.published import PublishedLikelihood
from linepose.simulation.projection import exact_projections
from linepose.simulation.settings import NavigationErrorSettings, settings_from_dict
from linepose.simulation.survey import faulty_observations, simulate_survey
from linepose.simulation.trajectory import body_poses

PLATFORMS = Path(__file__).parents[3] / "config" / "platforms"
THRESHOLD_PX = 5.0


def platform(name):
    content = yaml.safe_load((PLATFORMS / f"{name}.yaml").read_text())
    section = dict(content["camera"])
    return Camera(**section | {"sigmas": CameraSigmas(**section["sigmas"])}), settings_from_dict(content["simulation"])


@pytest.mark.parametrize(
    ("name", "n_observations", "n_faulty", "range_m"),
    [("ladybird-sim", 25, 9, (3.1, 3.6)), ("shrimp-sim", 20, 6, (2.2, 7.4))],
)
def test_layout_is_the_published_one(name, n_observations, n_faulty, range_m):
    camera, settings = platform(name)
    truth = exact_projections(camera, settings)
    assert truth.u_px.shape == (n_observations, 15)
    assert np.all(np.isfinite(truth.u_px))
    assert len(faulty_observations(settings)) == n_faulty
    body, euler = body_poses(settings, truth.time_s)
    centres = body + rotations.matrix_from_euler(euler) @ truth.pose[:3]
    distance = np.linalg.norm(centres - truth.point_m, axis=-1)
    assert range_m[0] < distance.min() < distance.max() < range_m[1]
    tilt = np.degrees(np.abs(euler[..., :2]))
    if name == "ladybird-sim":
        assert np.flatnonzero(tilt[..., 0].mean(axis=1) > 3).tolist() == list(range(6))
    else:
        assert 15 < tilt.max() < 17.5


@pytest.mark.parametrize("name", ["ladybird-sim", "shrimp-sim"])
def test_each_planted_fault_shows_beyond_the_threshold(name):
    camera, settings = platform(name)
    quiet = replace(
        settings,
        navigation_error=NavigationErrorSettings(),
        extraction=replace(settings.extraction, sigma_u_px=0.0, sigma_line=0.0),
    )
    survey, truth = simulate_survey(camera, quiet, 0)
    faulty = faulty_observations(quiet)
    good = [int(number) for number in survey.number if number not in faulty]
    # the pose is taken at the exact time of each crossing, so only rounding remains
    errors = PublishedLikelihood(survey.select(good), camera).residuals(truth.pose).mean_error_px()
    np.testing.assert_allclose(errors, 0.0, atol=1e-5)
    for number in faulty:
        errors = PublishedLikelihood(survey.select([*good, number]), camera).residuals(truth.pose).mean_error_px()
        assert errors[-1] > THRESHOLD_PX, number

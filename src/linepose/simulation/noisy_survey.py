"""Surveys whose noise is known, drawn from a platform's simulated drive: what the coverage study estimates poses from.

The drive, the board, the noise of points and the reported covariances are the platform's. What is drawn for each survey
besides: navigation errors of given levels, in units of the reported sigmas; and the camera's true intrinsics, in units
of the camera's sigmas.
"""

from dataclasses import replace

import numpy as np

from linepose.arrays import Floats
from linepose.geometry.camera import Camera
from linepose.simulation.drawn_camera import drawn_camera
from linepose.simulation.noise_levels import NoiseLevels
from linepose.simulation.settings import NavigationErrorSettings, SimulationSettings
from linepose.simulation.survey import faulty_observations, simulate_survey
from linepose.survey.observations import Survey


def draw_survey(
    camera: Camera,
    settings: SimulationSettings,
    levels: NoiseLevels,
    random: np.random.Generator,
    *,
    with_faults: bool = False,
) -> tuple[Survey, Floats]:
    """A survey of the drive, and the true pose (6,); the camera is as it is believed to be.

    Without the observations that carry a planted fault, unless `with_faults`.
    """
    true_camera = drawn_camera(camera, levels.intrinsics_level, random)
    survey, truth = simulate_survey(true_camera, _with_levels(settings, levels), random)
    if not with_faults:
        faulty = set(faulty_observations(settings))
        survey = survey.select([number for number in survey.number if number not in faulty])
    return survey, truth.pose


def _with_levels(settings: SimulationSettings, levels: NoiseLevels) -> SimulationSettings:
    """The drive with the navigation errors of these levels."""
    if levels.platform_error:
        return settings
    position, euler = settings.reported_sigma.position_m, settings.reported_sigma.euler_rad

    def scaled(level: float, sigma: tuple[float, float, float]) -> tuple[float, float, float]:
        return (level * sigma[0], level * sigma[1], level * sigma[2])

    attitude = levels.attitude_level
    return replace(
        settings,
        navigation_error=NavigationErrorSettings(
            gauss_markov_position_m=scaled(levels.correlated_level, position),
            gauss_markov_euler_rad=scaled(attitude * levels.correlated_level, euler),
            correlation_time_s=levels.correlation_time_s,
            white_position_m=scaled(levels.white_level, position),
            white_euler_rad=scaled(attitude * levels.white_level, euler),
            view_position_m=scaled(levels.shared_level, position),
            view_euler_rad=scaled(attitude * levels.shared_level, euler),
        ),
    )

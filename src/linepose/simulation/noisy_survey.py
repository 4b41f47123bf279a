"""Surveys whose noise is known, drawn from a platform's simulated drive: what the coverage study estimates poses from.

The drive, the board and the reported covariances are the platform's, of the observations that carry no fault. What is
drawn for each survey: navigation errors of given levels, in units of the reported sigmas; the noise of a point along
and across the line; and the camera's true principal point and focal length, in units of the camera's sigmas. The noise
of a point is that of the platform's extraction, across the line in lines and so in time, or of the camera's sigmas in
pixels, which is what the noise models take it to be.
"""

import numpy as np

from linepose.arrays import Floats
from linepose.geometry import rotations
from linepose.geometry.camera import Camera
from linepose.simulation.faults import missing
from linepose.simulation.navigation_error import navigation_errors
from linepose.simulation.noise_levels import NoiseLevels
from linepose.simulation.projection import Truth, exact_projections, pixel_of_direction
from linepose.simulation.settings import NavigationErrorSettings, SimulationSettings
from linepose.simulation.survey import faulty_observations, reported_covariance
from linepose.simulation.trajectory import body_poses, time_us
from linepose.survey.observations import Survey

_RATE_STEP_S = 1e-3


def draw_survey(
    camera: Camera, settings: SimulationSettings, levels: NoiseLevels, random: np.random.Generator
) -> tuple[Survey, Floats]:
    """A survey of the drive's faultless observations, and the true pose (6,); the camera is as it is believed to be."""
    deviation = levels.intrinsics_level * random.standard_normal(2)
    true_camera = camera.replaced(
        principal_point_px=camera.principal_point_px + deviation[0] * camera.sigmas.principal_point_px,
        focal_length_m=camera.focal_length_m + deviation[1] * camera.sigmas.focal_length_m,
    )
    truth = exact_projections(true_camera, settings)
    noise_u, noise_v = random.standard_normal((2, *truth.u_px.shape))
    seen = np.isfinite(truth.u_px) & ~missing(settings)
    crossing_s = np.where(seen, truth.time_s, 0.0)
    if levels.pixel_level is None:
        line_s = settings.extraction.sigma_line / settings.image.line_rate_hz
        when_s, u_px = crossing_s + line_s * noise_v, truth.u_px + settings.extraction.sigma_u_px * noise_u
    else:  # the camera stands off by the noise when the point seems to cross: earlier or later than it does
        rate = np.where(seen, _pixels_per_second(true_camera, settings, truth, crossing_s), 1.0)
        when_s = crossing_s + levels.pixel_level * camera.sigmas.v_px * noise_v / rate
        u_px = _projection(true_camera, settings, truth, when_s)[0] + levels.pixel_level * camera.sigmas.u_px * noise_u
    when_s = np.where(seen, when_s, 0.0)
    position, euler = body_poses(settings, when_s)
    errors = _errors(random, settings, levels, when_s)
    survey = Survey(
        number=np.arange(1, len(u_px) + 1, dtype=np.int64),
        time_us=np.where(seen, time_us(settings, when_s), 0),
        u_px=np.where(seen, u_px, np.nan),
        position_m=position + errors[..., :3],
        euler_rad=euler + errors[..., 3:],
        covariance=np.broadcast_to(reported_covariance(settings.reported_sigma), (*u_px.shape, 6, 6)).copy(),
        nav_gap_s=np.zeros_like(u_px),
        origin_m=np.asarray(settings.origin_m, dtype=float),
    )
    faulty = set(faulty_observations(settings))
    return survey.select([number for number in survey.number if number not in faulty]), truth.pose


def _errors(random: np.random.Generator, settings: SimulationSettings, levels: NoiseLevels, time_s: Floats) -> Floats:
    """Navigation errors (N, M, 6) at the times (N, M) of all points."""
    order = np.argsort(time_s, axis=None, kind="stable")
    view = np.repeat(np.arange(time_s.shape[0]), time_s.shape[1])
    errors = np.empty((time_s.size, 6))
    errors[order] = navigation_errors(random, _scaled(settings, levels), time_s.ravel()[order], view[order])
    return errors.reshape(*time_s.shape, 6)


def _scaled(settings: SimulationSettings, levels: NoiseLevels) -> NavigationErrorSettings:
    def triple(level: float, sigma: tuple[float, float, float]) -> tuple[float, float, float]:
        return (level * sigma[0], level * sigma[1], level * sigma[2])

    position, euler = settings.reported_sigma.position_m, settings.reported_sigma.euler_rad
    return NavigationErrorSettings(
        gauss_markov_position_m=triple(levels.correlated_level, position),
        gauss_markov_euler_rad=triple(levels.correlated_level, euler),
        correlation_time_s=levels.correlation_time_s,
        white_position_m=triple(levels.white_level, position),
        white_euler_rad=triple(levels.white_level, euler),
        view_position_m=triple(levels.shared_level, position),
        view_euler_rad=triple(levels.shared_level, euler),
    )


def _pixels_per_second(camera: Camera, settings: SimulationSettings, truth: Truth, time_s: Floats) -> Floats:
    """How fast each point crosses the line (N, M), signed."""
    after, before = (_projection(camera, settings, truth, time_s + step)[1] for step in (_RATE_STEP_S, -_RATE_STEP_S))
    return (after - before) / (2 * _RATE_STEP_S)


def _projection(camera: Camera, settings: SimulationSettings, truth: Truth, time_s: Floats) -> tuple[Floats, Floats]:
    """Pixel along and across the line (N, M) of every point at its time (N, M)."""
    position, euler = body_poses(settings, time_s)
    offset = truth.point_m - position
    in_body = np.einsum("...ji,...j->...i", rotations.matrix_from_euler(euler), offset) - truth.pose[:3]
    in_camera = in_body @ rotations.matrix_from_rotation_vector(truth.pose[3:])
    along = pixel_of_direction(camera, in_camera[..., 0] / in_camera[..., 2])
    return along, camera.focal_length_px * in_camera[..., 1] / in_camera[..., 2]

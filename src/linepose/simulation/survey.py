"""A simulated survey at the level of observations: no images, but everything else that goes wrong."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from linepose.arrays import Floats
from linepose.geometry.camera import Camera
from linepose.simulation.faults import clock_offsets_s, id_of_label, jumps, missing
from linepose.simulation.navigation_error import navigation_errors
from linepose.simulation.projection import Truth, exact_projections
from linepose.simulation.settings import ReportedSettings, SimulationSettings
from linepose.simulation.trajectory import body_poses, time_us
from linepose.survey.observations import Survey


def simulate_survey(
    camera: Camera, settings: SimulationSettings, seed: int | np.random.Generator
) -> tuple[Survey, Truth]:
    """What extraction and association would make of the survey, and the truth behind it.

    The exact pixel and time of each point get the extraction's noise; the body pose is the true one at the reported
    time plus the navigation error and the planted faults; the covariance is the reported one. The same seed repeats
    every number; surveys of different seeds share the truth.
    """
    truth = exact_projections(camera, settings)
    rng = np.random.default_rng(seed)
    noise_u, noise_line = rng.standard_normal((2, *truth.u_px.shape))
    u_px = truth.u_px + settings.extraction.sigma_u_px * noise_u
    reported_s = truth.time_s + settings.extraction.sigma_line / settings.image.line_rate_hz * noise_line
    reported_s += clock_offsets_s(settings)[:, None]
    seen = np.isfinite(u_px) & ~missing(settings)
    when_s = np.where(np.isfinite(reported_s), reported_s, 0.0)
    position, euler = body_poses(settings, when_s)
    errors = _errors_of_points(rng, settings, when_s) + jumps(settings, when_s)
    source = id_of_label(settings)
    row = np.arange(len(u_px))[:, None]
    survey = Survey(
        number=np.arange(1, len(u_px) + 1, dtype=np.int64),
        time_us=np.where(seen, time_us(settings, when_s), 0)[row, source],
        u_px=np.where(seen, u_px, np.nan)[row, source],
        position_m=(position + errors[..., :3])[row, source],
        euler_rad=(euler + errors[..., 3:])[row, source],
        covariance=np.broadcast_to(reported_covariance(settings.reported_sigma), (*u_px.shape, 6, 6)).copy(),
        nav_gap_s=np.zeros_like(u_px),
        origin_m=np.asarray(settings.origin_m, dtype=float),
    )
    return survey, truth


def reported_covariance(reported: ReportedSettings) -> Floats:
    """Covariance of north, east, down (m), roll, pitch, yaw (rad) that the navigation system reports; (6, 6)."""
    return np.diag(np.square([*reported.position_m, *reported.euler_rad]))


def faulty_observations(settings: SimulationSettings) -> tuple[int, ...]:
    """Numbers of the observations that carry a fault which makes them wrong, in ascending order."""
    return tuple(sorted({fault.observation for fault in settings.faults if fault.spoils_observation}))


def without_faults(settings: SimulationSettings) -> SimulationSettings:
    """The same survey with nothing planted."""
    return replace(settings, faults=())


def _errors_of_points(rng: np.random.Generator, settings: SimulationSettings, time_s: NDArray[np.float64]) -> Floats:
    """Navigation errors at the times (N, M) of all points; (N, M, 6)."""
    order = np.argsort(time_s, axis=None, kind="stable")
    view = np.repeat(np.arange(time_s.shape[0]), time_s.shape[1])
    errors = np.empty((time_s.size, 6))
    errors[order] = navigation_errors(rng, settings.navigation_error, time_s.ravel()[order], view[order])
    return errors.reshape(*time_s.shape, 6)

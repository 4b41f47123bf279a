"""A simulated survey through its raw log, with the camera's clock off by as much all the time."""

from dataclasses import replace

import numpy as np
import pandas as pd

from linepose.estimation.noise_models import likelihood_of
from linepose.geometry.camera import Camera
from linepose.likelihood.clock_offset import ClockOffsetLikelihood, with_clock_offset
from linepose.simulation.projection import exact_projections
from linepose.simulation.record import navigation_log
from linepose.simulation.settings import SimulationSettings
from linepose.simulation.survey import reported_covariance, without_faults
from linepose.simulation.trajectory import time_us
from linepose.survey.navigation import NavigationCovariances, associate_covariances
from linepose.survey.navigation_log import NavigationLog, associate_poses, interpolated_pose
from linepose.survey.observations import EULER_COLUMNS, POSITION_COLUMNS, Survey, survey_from_table
from unit.navigation_errors import white_per_line

MAXIMUM_S = 0.1


def honest(settings: SimulationSettings) -> SimulationSettings:
    """The survey without faults, the log's error white and as large as reported: what the published model assumes."""
    reported = settings.reported_sigma
    sigma = [*reported.position_m, *reported.euler_rad]
    return replace(without_faults(settings), navigation_error=white_per_line(sigma), transfer_s=2.0)


def both_ways(settings: SimulationSettings) -> SimulationSettings:
    """Ten passes, every second forward and at twice the speed of the others."""
    passes = [
        replace(
            one, speed_m_s=(0.4 if k % 2 else -0.2), duration_s=(4.0 if k % 2 else 7.0), channel_roll_rad=0.08 * (k % 3)
        )
        for k, one in enumerate(settings.passes[7:17])
    ]
    return replace(honest(settings), passes=tuple(passes))


def one_way(settings: SimulationSettings) -> SimulationSettings:
    """The same passes, all in reverse and at one speed."""
    passes = [replace(one, speed_m_s=-0.2, duration_s=7.0) for one in both_ways(settings).passes]
    return replace(honest(settings), passes=tuple(passes))


def record(camera: Camera, settings: SimulationSettings, offset_s: float, seed: int) -> tuple[Survey, NavigationLog]:
    """The survey of a camera whose stamps are too early by an offset, and the log that it was associated with."""
    table = navigation_log(replace(settings, seed=seed))
    position, euler = (table[list(names)].to_numpy() for names in (POSITION_COLUMNS, EULER_COLUMNS))
    log = NavigationLog(table["time_us"].to_numpy(), position, euler)
    random = np.random.default_rng([seed, 9])
    truth = exact_projections(camera, settings)
    row, column = np.nonzero(np.isfinite(truth.u_px))
    noise_u, noise_line = random.standard_normal((2, len(row)))
    time_s = truth.time_s[row, column] + settings.extraction.sigma_line / settings.image.line_rate_hz * noise_line
    points = pd.DataFrame(
        {
            "observation": row + 1,
            "point": column,
            "time_us": time_us(settings, time_s - offset_s),
            "u_px": truth.u_px[row, column] + settings.extraction.sigma_u_px * noise_u,
        }
    )
    stamps = log.time_us[::100]
    reported = np.broadcast_to(reported_covariance(settings.reported_sigma), (len(stamps), 6, 6))
    points = associate_poses(points, log, interpolated_pose, 0.1)
    points = associate_covariances(points, NavigationCovariances(stamps, reported), 1.0)
    return survey_from_table(points), log


def likelihood(
    camera: Camera, survey: Survey, log: NavigationLog, maximum_s: float = MAXIMUM_S, noise_model: str = "published"
) -> ClockOffsetLikelihood:
    """The noise model of the survey with the offset, up to 100 ms unless said otherwise."""
    return with_clock_offset(survey, log, maximum_s, lambda one: likelihood_of(noise_model, one, camera))

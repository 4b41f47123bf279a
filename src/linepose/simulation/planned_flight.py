"""A flight as it is planned, without errors: which strip sees which point of the ground, when, and from which pose.

The body swings about its strips as simulated flights do: without swings, heights and the lever could not be told apart
at all. Where a level body would see a point is found in closed form; there the swings are counted.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np

from linepose.arrays import Floats
from linepose.geometry import rotations
from linepose.geometry.camera import Camera, carried_onto_line, pixel_from_normalised
from linepose.simulation.flight import FlightSettings, points_below, thinned
from linepose.simulation.settings import ReportedSettings
from linepose.simulation.strip_motion import StripMotion
from linepose.simulation.survey import reported_covariance
from linepose.survey.observations import Survey

_MARGIN: Final = 0.2  # of the sensor, by which swings move points
_SECANTS: Final = 4
_NEVER_S: Final = 1e-3  # by which a crossing is not found to: pitch swings faster than the strip is flown


@dataclass(frozen=True)
class PlannedFlight:
    """survey: M points in N strips, all where they are seen; points_m (M, 3)."""

    survey: Survey
    points_m: Floats


def planned_flight(
    settings: FlightSettings, camera: Camera, pose: Floats, reported: ReportedSettings, seed: int
) -> PlannedFlight:
    """What strips see of points on the ground with a camera at a pose (6,); the settings' errors are left out.

    There are fewer points than asked for, down to none, where too few are seen in as many strips as the settings want.
    """
    random = np.random.default_rng(seed)
    motion = StripMotion.drawn(settings.strips, settings.speed_m_s, settings.turn_s, random)
    points = points_below(settings, random)
    time_s, u_px = _crossings(motion, settings.speed_m_s, camera, pose, points)
    seen = thinned(np.isfinite(u_px), settings.most_strips, random)
    kept = np.flatnonzero(seen.sum(axis=0) >= settings.fewest_strips)[: settings.n_points]
    time_s, u_px, seen = time_s[:, kept], u_px[:, kept], seen[:, kept]
    row, column = np.nonzero(seen)
    stamp, body = np.zeros(seen.shape, dtype=np.int64), np.full((*seen.shape, 6), np.nan)
    stamp[row, column] = np.rint(1e6 * time_s[row, column]).astype(np.int64)
    body[row, column] = motion.body_poses(row, time_s[row, column])
    survey = Survey(
        number=np.arange(1, len(seen) + 1, dtype=np.int64),
        time_us=stamp,
        u_px=np.where(seen, u_px, np.nan),
        position_m=body[..., :3],
        euler_rad=body[..., 3:],
        covariance=np.broadcast_to(reported_covariance(reported), (*seen.shape, 6, 6)),
        nav_gap_s=np.zeros(seen.shape),
        origin_m=np.zeros(3),
    )
    return PlannedFlight(survey, points[kept])


def _crossings(
    motion: StripMotion, speed_m_s: float, camera: Camera, pose: Floats, points_m: Floats
) -> tuple[Floats, Floats]:
    """When strips' lines cross points (M, 3) (s), and at which pixel; (N, M) twice, NaN where they do not."""
    n, shape = len(motion.middle_m), (len(motion.middle_m), len(points_m))
    level = np.column_stack([motion.middle_m, np.zeros((n, 2)), motion.heading_rad])
    way, u_px = _ahead(camera, pose, level[:, None], points_m)
    since_s = motion.duration_s[:, None] / 2 + way / speed_m_s
    margin = _MARGIN * camera.n_pixels
    near = (u_px > -margin) & (u_px < camera.n_pixels + margin)
    near &= (since_s > -1.0) & (since_s < motion.duration_s[:, None] + 1.0)
    row, column = np.nonzero(near)
    time_s = motion.start_s[row] + since_s[row, column]
    way, at_px = _ahead(camera, pose, motion.body_poses(row, time_s), points_m[column])
    step = way / speed_m_s
    for _ in range(_SECANTS):
        before, time_s = way, time_s + step
        way, at_px = _ahead(camera, pose, motion.body_poses(row, time_s), points_m[column])
        with np.errstate(divide="ignore", invalid="ignore"):
            step = np.nan_to_num(-step * way / (way - before), posinf=0.0, neginf=0.0)
    since = time_s - motion.start_s[row]
    seen = (at_px > 0) & (at_px < camera.n_pixels - 1) & (since >= 0) & (since <= motion.duration_s[row])
    seen &= np.abs(way) < _NEVER_S * speed_m_s
    grids = np.full((2, *shape), np.nan)
    grids[:, row[seen], column[seen]] = time_s[seen], at_px[seen]
    return grids[0], grids[1]


def _ahead(camera: Camera, pose: Floats, body: Floats, points_m: Floats) -> tuple[Floats, Floats]:
    """How far a body at poses (..., 6) has to fly on until its line crosses points (..., 3) (m), and the pixel there.

    The pixel is NaN of a point behind the camera.
    """
    in_world = points_m - body[..., :3]
    in_body = np.einsum("...ji,...j->...i", rotations.matrix_from_euler(body[..., 3:]), in_world) - pose[:3]
    camera_in_body = rotations.matrix_from_rotation_vector(pose[3:])
    in_camera, ahead = in_body @ camera_in_body, camera_in_body[0]
    with np.errstate(divide="ignore", invalid="ignore"):
        way, at = carried_onto_line(camera, in_camera, ahead)
        u_px = pixel_from_normalised(camera, at[..., 0] / at[..., 2])
    return way, np.where(at[..., 2] > 0, u_px, np.nan)

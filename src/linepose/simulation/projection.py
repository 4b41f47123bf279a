"""Exactly when and where on the scan line each pattern point is seen."""

from dataclasses import dataclass
from functools import lru_cache
from typing import Final

import numpy as np
from scipy.optimize import elementwise

from linepose.arrays import Floats
from linepose.geometry import rotations
from linepose.geometry.camera import Camera, off_line, pixel_from_normalised
from linepose.simulation.board import world_points
from linepose.simulation.settings import SimulationSettings
from linepose.simulation.trajectory import body_poses, schedule

_N_BRACKETS: Final = 64  # a point crosses the line once in a pass; this finds the crossing on uneven ground
_STEP_S: Final = 1e-4  # for the rate at a crossing


@dataclass(frozen=True)
class Truth:
    """What a simulated survey conceals; N observations of M points.

    pose (6,) of the camera, point_m (M, 3), time_s and u_px (N, M) of each crossing and how fast the point moves across
    the line then, v_px_s (N, M), NaN where a point does not cross the line within the image, position_m and euler_rad
    (N, M, 3) of the body then, from the survey origin.
    """

    pose: Floats
    point_m: Floats
    time_s: Floats
    u_px: Floats
    v_px_s: Floats
    position_m: Floats
    euler_rad: Floats


@lru_cache(maxsize=8)
def exact_projections(camera: Camera, settings: SimulationSettings) -> Truth:
    """The truth of a survey without any noise or fault, by root finding on the trajectory."""
    points = world_points(settings.board)
    times = schedule(settings)
    pose = np.array(settings.true_pose)
    edges = np.linspace(times.start_s, times.end_s, _N_BRACKETS + 1, axis=1)  # (N, K + 1)
    in_camera = _in_camera(settings, edges[:, :, None], points)  # (N, K + 1, M, 3)
    across, ahead = off_line(camera, in_camera), in_camera[..., 2] > 0
    crossing = (np.sign(across[:, 1:]) != np.sign(across[:, :-1])) & ahead[:, 1:] & ahead[:, :-1]
    row, column = np.nonzero(np.any(crossing, axis=1))
    bracket = np.argmax(crossing, axis=1)[row, column]
    root = elementwise.find_root(
        lambda time, *point: off_line(camera, _in_camera(settings, time, np.stack(point, axis=-1))),
        (edges[row, bracket], edges[row, bracket + 1]),
        args=tuple(points[column].T),
    ).x
    at_root = _in_camera(settings, root, points[column])
    u = pixel_from_normalised(camera, at_root[..., 0] / at_root[..., 2])
    inside = (u >= -0.5) & (u <= camera.n_pixels - 0.5)
    around = _in_camera(settings, root[:, None] + [-_STEP_S, _STEP_S], points[column][:, None])
    rate = camera.focal_length_px * np.diff(off_line(camera, around) / around[..., 2])[:, 0] / (2 * _STEP_S)
    time_s, u_px, v_px_s = np.full((3, len(times.start_s), len(points)), np.nan)
    for grid, values in ((time_s, root), (u_px, u), (v_px_s, rate)):
        grid[row[inside], column[inside]] = values[inside]
    position, euler = body_poses(settings, np.where(np.isfinite(time_s), time_s, times.middle_s[:, None]))
    return Truth(pose, points, time_s, u_px, v_px_s, position, euler)


def _in_camera(settings: SimulationSettings, time_s: Floats, points: Floats) -> Floats:
    """Points (..., 3) in the camera frame of times (...), broadcast."""
    pose = np.asarray(settings.true_pose)
    position, euler = body_poses(settings, time_s)
    in_body = np.einsum("...ji,...j->...i", rotations.matrix_from_euler(euler), points - position) - pose[:3]
    return in_body @ rotations.matrix_from_rotation_vector(pose[3:])

"""Where points are to begin with: where their rays meet the ground, or nearest to their rays by least squares.

From the air rays are nearly parallel: at a pose that is a degree off they meet far above or below the ground, and the
search ends there. The feet of rays on flat ground lead to the estimate from far off.
"""

from typing import Final

import numpy as np

from linepose.adjustment.measurements import Measurements
from linepose.arrays import Floats
from linepose.errors import EstimationError, InputError
from linepose.geometry import camera as cameras
from linepose.geometry import rotations
from linepose.geometry.camera import Camera

_DAMPING: Final = 1e-3  # of the rays' directions: rays that are nearly parallel meet at the middle distance
_LEAST_DEPTH_M: Final = 0.1
_NAMED: Final = 5  # observations in a message
_FEW: Final = 0.34  # of the observations: these are wrong rather than the hand measurement
_DOWNWARD: Final = 0.7  # of every line of sight's unit vector, from which on a survey is one from above
_TURNS: Final = 2  # of feet and the heights known there
_LEAST_DOWNWARD: Final = 0.1  # of a single ray, whose foot is else too far away
_DEPTHS: Final = np.geomspace(0.3, 3000.0, 81)  # of the ground below the lowest camera (m), tried where none is known


def start_points(measurements: Measurements, camera: Camera, pose: Floats) -> Floats:
    """Points (K, 3) at a camera pose (6,): feet of their rays where the camera looks down, else where rays meet.

    Raises InputError for a camera that has no rays.
    """
    body_from_camera = rotations.matrix_from_rotation_vector(pose[3:])
    body = rotations.matrix_from_euler(measurements.body_pose[:, 3:])
    centre, direction = cameras.rays(
        camera, body_from_camera, pose[:3], body, measurements.body_pose[:, :3], measurements.u_px
    )
    length = np.linalg.norm(direction, axis=-1, keepdims=True)
    if not np.all(np.isfinite(length)):
        raise InputError(
            "camera",
            "intrinsic parameters whose rays are no numbers",
            "those of a camera that has seen these pixels",
            "correct focal_length_m, pixel_pitch_m, principal_point_px, and the distortion",
        )
    direction = direction / length
    if not looks_down(measurements, pose):
        return _met(measurements, centre, direction)
    return _feet(measurements, centre, direction)


def looks_down(measurements: Measurements, pose: Floats) -> bool:
    """Whether a camera at a pose (6,) looks down wherever it sees a point: a survey from above."""
    line_of_sight = rotations.matrix_from_rotation_vector(pose[3:])[:, 2]
    body = rotations.matrix_from_euler(measurements.body_pose[:, 3:])
    return bool(np.min(body[:, 2] @ line_of_sight) >= _DOWNWARD)


def _feet(measurements: Measurements, centre: Floats, direction: Floats) -> Floats:
    """Mean foot (K, 3) of each point's rays (L, 3) on flat ground, at the known heights or where feet lie closest."""
    points, n = measurements.point, measurements.n_points
    slope = direction / np.maximum(direction[:, 2:], _LEAST_DOWNWARD)
    count = np.bincount(points, minlength=n)

    def feet_at(down_m: float) -> tuple[Floats, float]:
        """Mean feet, and the mean square of what rays lie off them in units of the depth."""
        depth = down_m - centre[:, 2:]
        foot = centre + depth * slope
        mean = np.column_stack([np.bincount(points, foot[:, i], n) / count for i in range(3)])
        return mean, float(np.mean(((foot - mean[points]) / depth) ** 2))

    lowest = float(centre[:, 2].max())
    start = min((feet_at(lowest + depth) for depth in _DEPTHS), key=lambda one: one[1])[0]
    for _ in range(_TURNS):
        heights, known = measurements.known.heights(start)
        if not np.any(known):
            break
        start = feet_at(max(float(np.median(heights[known])), lowest + float(_DEPTHS[0])))[0]
        start[:, 2] = np.where(known, heights, start[:, 2])
    return start


def _met(measurements: Measurements, centre: Floats, direction: Floats) -> Floats:
    """Where rays (L, 3) of each point meet (K, 3).

    A point that would lie behind a camera that sees it is put on the mean of its rays, at the median distance of those
    that met.
    """
    points, n = measurements.point, measurements.n_points
    across = (1 + _DAMPING) * np.eye(3) - direction[:, :, None] * direction[:, None, :]
    normal, vector, count = np.zeros((n, 3, 3)), np.zeros((n, 3)), np.zeros(n)
    origin, along = np.zeros((n, 3)), np.zeros((n, 3))
    np.add.at(count, points, 1.0)
    np.add.at(origin, points, centre)
    np.add.at(along, points, direction)
    origin, along = origin / count[:, None], along / count[:, None]
    np.add.at(normal, points, across)
    plain = across - _DAMPING * np.eye(3)
    np.add.at(vector, points, np.einsum("lij,lj->li", plain, centre - origin[points]))
    met = origin + np.linalg.solve(normal, vector[..., None])[..., 0]
    depth = np.sum((met[points] - centre) * direction, axis=-1)
    least = np.full(n, np.inf)
    np.minimum.at(least, points, depth)
    good = least > _LEAST_DEPTH_M
    distance = float(np.median(depth[good[points]])) if np.any(good) else 1.0
    return np.where(good[:, None], met, origin + distance * along)


def behind_at_start(measurements: Measurements, pose: Floats, points_m: Floats) -> EstimationError:
    """What to say where points (K, 3) are not in front of a camera at a pose (6,): in which observations."""
    body_from_camera = rotations.matrix_from_rotation_vector(pose[3:])
    world_from_body = rotations.matrix_from_euler(measurements.body_pose[:, 3:])
    away = points_m[measurements.point] - measurements.body_pose[:, :3]
    in_body = np.einsum("lji,lj->li", world_from_body, away) - pose[:3]
    behind = in_body @ body_from_camera[:, 2] <= 0
    numbers = np.unique(measurements.number[measurements.view[behind]]).tolist()
    few = len(numbers) <= _FEW * measurements.n_views
    return EstimationError(
        f"adjustment: points lie behind the camera at the start in {len(numbers)} of {measurements.n_views} "
        f"observations ({', '.join(map(str, numbers[:_NAMED]))}{', ...' if len(numbers) > _NAMED else ''}); "
        + ("leave these out or correct their body poses" if few else "correct the hand-measured pose")
    )

"""Where points are to begin with: nearest to their rays in the sense of least squares."""

from typing import Final

import numpy as np

from linepose.adjustment.measurements import Measurements
from linepose.arrays import Floats
from linepose.errors import EstimationError
from linepose.geometry import camera as cameras
from linepose.geometry import rotations
from linepose.geometry.camera import Camera

_DAMPING: Final = 1e-3  # of the rays' directions: rays that are nearly parallel meet at the middle distance
_LEAST_DEPTH_M: Final = 0.1
_NAMED: Final = 5  # observations in a message
_FEW: Final = 0.34  # of the observations: these are wrong rather than the hand measurement


def start_points(measurements: Measurements, camera: Camera, pose: Floats) -> Floats:
    """Points (K, 3) at a camera pose (6,).

    Rays meet where they can; a point that would lie behind a camera that sees it is put on the mean of its rays, at the
    median distance of those that met.
    """
    body = rotations.matrix_from_euler(measurements.body_pose[:, 3:])
    centre, direction = cameras.rays(
        camera,
        rotations.matrix_from_rotation_vector(pose[3:]),
        pose[:3],
        body,
        measurements.body_pose[:, :3],
        measurements.u_px,
    )
    direction = direction / np.linalg.norm(direction, axis=-1, keepdims=True)
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

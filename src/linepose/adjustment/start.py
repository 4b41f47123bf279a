"""Where points are to begin with: nearest to their rays in the sense of least squares."""

from typing import Final

import numpy as np

from linepose.adjustment.measurements import Measurements
from linepose.arrays import Floats
from linepose.geometry import camera as cameras
from linepose.geometry import rotations
from linepose.geometry.camera import Camera

_DAMPING: Final = 1e-3  # of the rays' directions: rays that are nearly parallel meet at the middle distance
_LEAST_DEPTH_M: Final = 0.1


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

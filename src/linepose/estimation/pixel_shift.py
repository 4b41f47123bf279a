"""How far a pixel's place moves between two cameras on one body, on a surface across the first one's optical axis."""

from dataclasses import dataclass
from typing import Final

import numpy as np

from linepose.arrays import Floats
from linepose.geometry.camera import Camera, normalised_from_pixel
from linepose.geometry.rotations import matrix_from_rotation_vector

_STEPS: Final = np.array([1e-4] * 3 + [1e-5] * 3 + [1e-2, 1e-7])  # for derivatives: of a move (m, rad), px, m


@dataclass(frozen=True, eq=False)
class Mounted:
    """A camera and its pose (6,) in the body, with a rotation vector."""

    camera: Camera
    pose: Floats


def pixel_shift(first: Mounted, second: Mounted, pixel: float, range_m: float) -> Floats:
    """What leads from the first camera's place to the second's, along its line and across it (2,) (m).

    The surface is a plane at this range, square to the first camera's optical axis. NaN where the second camera's ray
    does not meet it.
    """
    turn = matrix_from_rotation_vector(first.pose[3:]).T
    centre = turn @ (second.pose[:3] - first.pose[:3])
    ray = turn @ matrix_from_rotation_vector(second.pose[3:]) @ _ray(second.camera, pixel)
    if ray[2] <= 0 or centre[2] >= range_m:
        return np.full(2, np.nan)
    place = centre + (range_m - centre[2]) / ray[2] * ray
    return (place - range_m * _ray(first.camera, pixel))[:2]


def shift_covariance(
    first: Mounted, second: Mounted, pixel: float, range_m: float, difference_covariance: Floats
) -> Floats:
    """Covariance (2, 2) of the shift, from that of the difference (8, 8).

    The difference is that of the poses, m and turn about body axes, of the principal points (px) and the focal lengths
    (m).
    """
    slopes = np.empty((2, len(_STEPS)))
    for axis, step in enumerate(_STEPS):
        ends = [pixel_shift(first, _moved(second, sign * step, axis), pixel, range_m) for sign in (1.0, -1.0)]
        slopes[:, axis] = (ends[0] - ends[1]) / (2 * step)
    return slopes @ difference_covariance @ slopes.T


def _ray(camera: Camera, pixel: float) -> Floats:
    return np.array([float(normalised_from_pixel(camera, pixel)), 0.0, 1.0])


def _moved(mounted: Mounted, step: float, axis: int) -> Mounted:
    """The camera after a step along or about one body axis, or of its principal point (px) or focal length (m)."""
    from scipy.spatial.transform import Rotation

    camera, pose = mounted.camera, mounted.pose
    move = step * np.eye(len(_STEPS))[axis]
    turned = Rotation.from_rotvec(move[3:6]) * Rotation.from_rotvec(pose[3:])
    return Mounted(
        camera.replaced(
            principal_point_px=camera.principal_point_px + move[6], focal_length_m=camera.focal_length_m + move[7]
        ),
        np.concatenate([pose[:3] + move[:3], turned.as_rotvec()]),
    )

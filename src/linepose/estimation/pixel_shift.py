"""How far a pixel's place moves between two cameras on one body, on a surface across the first one's optical axis."""

from dataclasses import dataclass
from typing import Final

import numpy as np

from linepose.arrays import Floats
from linepose.geometry.camera import Camera, normalised_from_pixel
from linepose.geometry.rotations import matrix_from_rotation_vector

_STEPS: Final = np.array([1e-4] * 3 + [1e-5] * 3)  # of a move, for derivatives (m, rad)


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
    """Covariance (2, 2) of the shift, from that of the poses' difference (6, 6): m, and turn about body axes."""
    slopes = np.empty((2, 6))
    for axis, step in enumerate(_STEPS):
        ends = [
            pixel_shift(first, Mounted(second.camera, _moved(second.pose, sign * step, axis)), pixel, range_m)
            for sign in (1.0, -1.0)
        ]
        slopes[:, axis] = (ends[0] - ends[1]) / (2 * step)
    return slopes @ difference_covariance @ slopes.T


def _ray(camera: Camera, pixel: float) -> Floats:
    return np.array([float(normalised_from_pixel(camera, pixel)), 0.0, 1.0])


def _moved(pose: Floats, step: float, axis: int) -> Floats:
    """The pose (6,) after a step along or about one body axis."""
    from scipy.spatial.transform import Rotation

    move = step * np.eye(6)[axis]
    turned = Rotation.from_rotvec(move[3:]) * Rotation.from_rotvec(pose[3:])
    return np.concatenate([pose[:3] + move[:3], turned.as_rotvec()])

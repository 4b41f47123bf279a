"""How far a pixel's place moves between two cameras on one body, on a surface across the first one's optical axis."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from linepose.arrays import Floats
from linepose.geometry.camera import Camera, pixel_directions
from linepose.geometry.rotations import matrix_from_rotation_vector

_POSE_STEPS: Final = (1e-4,) * 3 + (1e-5,) * 3  # for derivatives, of a move (m, rad)
_STEPS: Final = {"principal_point_px": 1e-2, "focal_length_m": 1e-7}  # and of the intrinsics (px, m)
_COEFFICIENT_STEP: Final = 1e-5


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
    first: Mounted, second: Mounted, pixel: float, range_m: float, difference_covariance: Floats, names: Sequence[str]
) -> Floats:
    """Covariance (2, 2) of the shift, from that of the difference (6 + I, 6 + I).

    The difference is that of the poses, m and turn about body axes, and of the intrinsics that `names` says, I of them.
    """
    steps = [*_POSE_STEPS, *(_STEPS.get(name, _COEFFICIENT_STEP) for name in names)]
    slopes = np.empty((2, len(steps)))
    for axis, step in enumerate(steps):
        name = names[axis - 6] if axis >= 6 else None
        ends = [pixel_shift(first, _moved(second, sign * step, axis, name), pixel, range_m) for sign in (1.0, -1.0)]
        slopes[:, axis] = (ends[0] - ends[1]) / (2 * step)
    return slopes @ difference_covariance @ slopes.T


def _ray(camera: Camera, pixel: float) -> Floats:
    return pixel_directions(camera, pixel)


def _moved(mounted: Mounted, step: float, axis: int, name: str | None) -> Mounted:
    """The camera after a step along or about one body axis, or of the intrinsic of this name."""
    from scipy.spatial.transform import Rotation

    camera, pose = mounted.camera, mounted.pose
    if name is not None:
        return Mounted(camera.replaced(**{name: getattr(camera, name) + step}), pose)
    move = step * np.eye(6)[axis]
    turned = Rotation.from_rotvec(move[3:]) * Rotation.from_rotvec(pose[3:])
    return Mounted(camera, np.concatenate([pose[:3] + move[:3], turned.as_rotvec()]))

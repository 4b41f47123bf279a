"""A survey as it would have been: the vehicle drives along its heading until each point crosses the scan line."""

from dataclasses import replace
from typing import Final, NamedTuple

import numpy as np

from linepose.arrays import Floats
from linepose.geometry.camera import Camera, carried_onto_line, pixel_from_normalised
from linepose.geometry.rotations import matrix_from_euler, matrix_from_rotation_vector
from linepose.survey.observations import Survey

_NEVER_CROSSES: Final = 0.1  # sine of the angle between heading and scan plane below which a point is not swept over


class Crossing(NamedTuple):
    """Where the body is as points cross the line: position_m (..., 3), u_px (...), distance_m (...) along the axis.

    u_px is NaN where a point does not cross in front of the camera and on the sensor.
    """

    position_m: Floats
    u_px: Floats
    distance_m: Floats


def crossing(camera: Camera, pose: Floats, position_m: Floats, euler_rad: Floats, point_m: Floats) -> Crossing:
    """Where a body at positions (..., 3) with Euler angles (..., 3) sees points (..., 3) after driving on or back.

    `pose` (6,) is the camera in the body frame. The body is moved along its forward axis until it sees the point.
    """
    seen_from = in_camera(pose, position_m, euler_rad, point_m)
    ahead = matrix_from_rotation_vector(pose[3:6]).T[:, 0]  # the body's forward axis in the camera
    sweeps = abs(ahead[1]) >= _NEVER_CROSSES
    with np.errstate(divide="ignore", invalid="ignore"):
        step, moved = (
            carried_onto_line(camera, seen_from, ahead) if sweeps else (np.zeros_like(seen_from[..., 1]), seen_from)
        )
        depth = moved[..., 2]
        u_px = pixel_from_normalised(camera, moved[..., 0] / depth)
    seen = sweeps & (depth > 0) & (u_px >= -0.5) & (u_px <= camera.n_pixels - 0.5)
    forward = matrix_from_euler(euler_rad)[..., :, 0]
    return Crossing(position_m + step[..., None] * forward, np.where(seen, u_px, np.nan), depth)


def in_camera(pose: Floats, position_m: Floats, euler_rad: Floats, point_m: Floats) -> Floats:
    """Points (..., 3) of the world in the camera's frame (m), for bodies at positions (..., 3) with angles (..., 3)."""
    to_body = np.swapaxes(matrix_from_euler(euler_rad), -1, -2)
    in_body = np.einsum("...ij,...j->...i", to_body, point_m - position_m) - pose[:3]
    return np.asarray(in_body @ matrix_from_rotation_vector(pose[3:6]))


def replayed(survey: Survey, camera: Camera, pose: Floats, point_m: Floats) -> Survey:
    """The survey whose pixels are exactly what `pose` (6,) sees of points (M, 3), its covariances kept.

    Points that were not observed stay so.
    """
    at = crossing(camera, pose, survey.position_m, survey.euler_rad, np.broadcast_to(point_m, survey.position_m.shape))
    seen = np.isfinite(survey.u_px) & np.isfinite(at.u_px)
    return replace(survey, position_m=at.position_m, u_px=np.where(seen, at.u_px, np.nan))

"""Where a target stands in the world, from its points in one scan and the camera's pose at hand.

The target's shape is used, not its size: what is asked for is the plane that it lies in, the way it is turned, and
whether its points lie as it is described.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.optimize import least_squares

from linepose.arrays import Floats
from linepose.geometry import rotations
from linepose.geometry.camera import Camera, pixel_directions
from linepose.inputs.rectified.rectify import LinePoses
from linepose.inputs.rectified.surface import Surface

_MOST_EVALUATIONS: Final = 60


@dataclass(frozen=True)
class BoardPose:
    """A target's origin (3,), axes (3, 3) board to world, size over the described one, and misfits (n,) in px."""

    origin_m: Floats
    matrix: Floats
    scale: float
    misfit_px: Floats

    def world(self, board_m: Floats) -> Floats:
        """World points (n, 3) of board points (n, 2)."""
        return self.origin_m + self.scale * board_m @ self.matrix[:, :2].T


def fit_board_pose(
    board_m: Floats, position: Floats, poses: LinePoses, camera: Camera, surfaces: list[Surface]
) -> BoardPose | None:
    """The pose of least squares of board points (n, 2) at positions (n, 2) of u and line, from planes to start from.

    None where no plane can be started from.
    """
    at = poses.at(position[:, 1])
    rays = pixel_directions(camera, position[:, 0])
    starts = [start for start in (_start(board_m, rays, at, one) for one in surfaces) if start is not None]
    fits = [_fitted(board_m, rays, at, camera.focal_length_px, *start) for start in starts]
    return min(fits, key=_squared, default=None)


def _squared(fit: BoardPose) -> float:
    return float(np.sum(fit.misfit_px**2))


def _start(board_m: Floats, rays: Floats, at: LinePoses, surface: Surface) -> tuple[Floats, Floats, float] | None:
    """Origin, matrix and scale of a board in a plane: where the rays of its points meet it."""
    direction = np.einsum("nij,nj->ni", at.matrix, rays)
    normal = np.cross(*surface.axes)
    with np.errstate(divide="ignore", invalid="ignore"):
        depth = ((surface.origin_m - at.centre_m) @ normal) / (direction @ normal)
    if not np.all(np.isfinite(depth) & (depth > 0)):
        return None
    seen = surface.from_world(at.centre_m + depth[:, None] * direction)
    there, here = seen - seen.mean(axis=0), board_m - board_m.mean(axis=0)
    u, values, vt = np.linalg.svd(there.T @ here)
    flip = np.array([1.0, np.sign(np.linalg.det(u @ vt))])
    turn = (u * flip) @ vt
    scale = float(values @ flip / np.sum(here**2))
    if scale <= 0:
        return None
    first, second = turn.T @ surface.axes
    matrix = np.stack([first, second, np.cross(first, second)], axis=-1)
    origin = surface.to_world(seen.mean(axis=0) - scale * turn @ board_m.mean(axis=0))
    return origin, matrix, scale


def _fitted(
    board_m: Floats, rays: Floats, at: LinePoses, focal_length_px: float, origin: Floats, matrix: Floats, scale: float
) -> BoardPose:
    size = max(scale * float(np.ptp(board_m, axis=0).max()), 1e-9)

    def pose(parameters: Floats) -> tuple[Floats, Floats, float]:
        turned = rotations.matrix_from_rotation_vector(parameters[3:6]) @ matrix
        return origin + size * parameters[:3], turned, scale * float(np.exp(parameters[6]))

    def misfit(parameters: Floats) -> Floats:
        at_origin, turned, scaled = pose(parameters)
        offset = at_origin + scaled * board_m @ turned[:, :2].T - at.centre_m
        across, along, ahead = np.einsum("nij,ni->jn", at.matrix, offset)
        ahead = np.where(np.abs(ahead) > 1e-9, ahead, 1e-9)
        return focal_length_px * np.stack([across / ahead - rays[:, 0], along / ahead - rays[:, 1]], axis=-1).ravel()

    found = least_squares(misfit, np.zeros(7), method="trf", max_nfev=_MOST_EVALUATIONS)
    return BoardPose(*pose(found.x), np.linalg.norm(misfit(found.x).reshape(-1, 2), axis=-1))

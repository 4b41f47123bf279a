"""The line-scan camera: from a pixel to a ray and back.

Pixel u counts along the scan line from 0; its centre is at the whole number. The line has v = 0. The normalised
image plane lies at z = 1 in front of the camera, with x along the scan line. Radial distortion acts on x alone.
"""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from linepose.arrays import Floats


@dataclass(frozen=True)
class CameraSigmas:
    """One standard deviation of each camera quantity; units in the names, k1 and k2 have none."""

    u_px: float = 0.5
    v_px: float = 0.5
    principal_point_px: float = 2.0
    focal_length_m: float = 1e-4
    k1: float = 0.0
    k2: float = 0.0


@dataclass(frozen=True)
class Camera:
    """Intrinsic parameters of a line-scan camera and how well they are known."""

    focal_length_m: float
    pixel_pitch_m: float
    n_pixels: int
    principal_point_px: float
    k1: float = 0.0
    k2: float = 0.0
    sigmas: CameraSigmas = field(default_factory=CameraSigmas)

    @property
    def focal_length_px(self) -> float:
        """Focal length in pixels: what turns a distance in the normalised plane into one in pixels."""
        return self.focal_length_m / self.pixel_pitch_m


def undistort(x: ArrayLike, k1: float, k2: float) -> Floats:
    """Ideal normalised x of a distorted one, in the closed form the paper's authors use; (...) to (...).

    `x / (1 + k1 r^2 + k2 r^4)` with `r = x (1 - k1 x^2 - k2 x^4)`: the inverse of `distort` to second order in k.
    """
    x = np.asarray(x, dtype=float)
    r2 = (x * (1 - k1 * x**2 - k2 * x**4)) ** 2
    return x / (1 + k1 * r2 + k2 * r2**2)


def distort(x: ArrayLike, k1: float, k2: float) -> Floats:
    """Distorted normalised x of an ideal one, `x (1 + k1 x^2 + k2 x^4)`; (...) to (...)."""
    x = np.asarray(x, dtype=float)
    return x * (1 + k1 * x**2 + k2 * x**4)


def normalised_from_pixel(camera: Camera, u_px: ArrayLike) -> Floats:
    """Normalised x of pixels u on the line, distortion removed; (...) to (...)."""
    u = np.asarray(u_px, dtype=float)
    return undistort((u - camera.principal_point_px) / camera.focal_length_px, camera.k1, camera.k2)


def pixel_from_normalised(camera: Camera, x: ArrayLike) -> Floats:
    """Pixel u of normalised x, distortion applied; (...) to (...)."""
    return distort(x, camera.k1, camera.k2) * camera.focal_length_px + camera.principal_point_px


def rays(
    camera: Camera,
    pose_matrix: ArrayLike,
    lever_arm_m: ArrayLike,
    body_matrix: ArrayLike,
    body_position_m: ArrayLike,
    u_px: ArrayLike,
) -> tuple[Floats, Floats]:
    """Centres and directions (not of unit length) of pixels' rays in the world; (...) pixels to (..., 3) twice.

    `c = p_wb + R_wb r`, `d = R_wb R_bc [x, 0, 1]` (Eq. 11), with R_wb (..., 3, 3), p_wb (..., 3).
    """
    x = normalised_from_pixel(camera, u_px)
    in_camera = np.stack([x, np.zeros_like(x), np.ones_like(x)], axis=-1)
    r_wb = np.asarray(body_matrix, dtype=float)
    centres = np.asarray(body_position_m, dtype=float) + r_wb @ np.asarray(lever_arm_m, dtype=float)
    directions = np.einsum("...ij,jk,...k->...i", r_wb, np.asarray(pose_matrix, dtype=float), in_camera)
    return centres, directions

"""The line-scan camera: from a pixel to a ray and back.

Pixel u counts along the scan line from 0; its centre is at the whole number. The line has v = 0. The normalised
image plane lies at z = 1 in front of the camera, with x along the scan line. Radial distortion acts on x alone.
"""

import numpy as np
from numpy.typing import ArrayLike
from pydantic import Field, NonNegativeFloat, PositiveFloat

from linepose.arrays import Floats
from linepose.settings import Settings


class CameraSigmas(Settings):
    """One standard deviation of each camera quantity; units in the names, k1 and k2 have none.

    Examples
    --------
    >>> import linepose
    >>> linepose.CameraSigmas(u_px=0.3).focal_length_m
    0.0001
    """

    u_px: PositiveFloat = Field(0.5, ge=1e-6, le=1e6, description="Of a point's position along the scan line (px).")
    v_px: PositiveFloat = Field(0.5, ge=1e-6, le=1e6, description="Of a point's position across the scan line (px).")
    principal_point_px: NonNegativeFloat = Field(2.0, le=1e6, description="Of the principal point (px).")
    focal_length_m: NonNegativeFloat = Field(1e-4, le=1e3, description="Of the focal length (m).")
    k1: NonNegativeFloat = Field(0.0, description="Of the first radial distortion coefficient (no unit).")
    k2: NonNegativeFloat = Field(0.0, description="Of the second radial distortion coefficient (no unit).")


class Camera(Settings):
    """Intrinsic parameters of a line-scan camera and how well they are known.

    Examples
    --------
    >>> import linepose
    >>> camera = linepose.Camera(focal_length_m=8e-3, pixel_pitch_m=8e-6, n_pixels=640, principal_point_px=319.5)
    >>> round(camera.focal_length_px)
    1000
    """

    focal_length_m: PositiveFloat = Field(description="Focal length (m).")
    pixel_pitch_m: PositiveFloat = Field(description="Width of a pixel on the sensor (m).")
    n_pixels: int = Field(gt=0, le=1_000_000, description="Pixels of a scan line.")
    principal_point_px: float = Field(
        description="Where the optical axis meets the line (px from the centre of the first pixel)."
    )
    k1: float = Field(0.0, description="First radial distortion coefficient (no unit).")
    k2: float = Field(0.0, description="Second radial distortion coefficient (no unit).")
    sigmas: CameraSigmas = Field(CameraSigmas(), description="One standard deviation of each.")

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

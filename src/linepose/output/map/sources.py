"""What errs when a pixel is put on the map, and how much: the covariances that are carried to the ground."""

from collections.abc import Collection
from dataclasses import dataclass
from functools import cache
from typing import Final, Literal

import numpy as np

from linepose.adjustment.levels import Levels
from linepose.arrays import Floats
from linepose.geometry import lens
from linepose.geometry.camera import Camera, normalised_from_pixel
from linepose.geometry.rotations import (
    left_jacobian_so3,
    matrix_from_euler,
    matrix_from_rotation_vector,
    skew,
    small_rotation_by_euler,
)
from linepose.pipeline.adjusted_intrinsics import AdjustedIntrinsics

Source = Literal["pose", "intrinsics", "navigation", "pixel", "ground"]
SOURCES: Final[tuple[Source, ...]] = ("pose", "intrinsics", "navigation", "pixel", "ground")

_HELD: Final = 0.95
_RATIOS: Final = 257
_ANGLES: Final = 720


@dataclass(frozen=True, eq=False)
class MountedCamera:
    """A camera's intrinsics, its pose (6,) on the body and that pose's covariance (6, 6).

    `levels` scale what the navigation reports, and the pixel's noise, where an adjustment has estimated them;
    `intrinsics` tell how these err, and the pose with them, where it has estimated them.
    """

    camera: Camera
    pose: Floats
    covariance: Floats
    levels: Levels | None = None
    intrinsics: AdjustedIntrinsics | None = None

    @property
    def intrinsics_names(self) -> tuple[str, ...]:
        """The intrinsics that err, I of them."""
        if self.intrinsics is not None:
            return self.intrinsics.names
        return ("principal_point_px", "focal_length_m", *self.camera.uncertain_coefficients)

    @property
    def intrinsics_covariance(self) -> Floats:
        """Covariance (I, I) of the intrinsics: principal point (px), focal length (m), coefficients of the lens."""
        if self.intrinsics is not None:
            return self.intrinsics.covariance
        return np.diag([getattr(self.camera.sigmas, name) ** 2 for name in self.intrinsics_names])

    @property
    def with_intrinsics(self) -> Floats:
        """Covariance (6, I) of the pose, position (m) and small turn about body axes (rad), with the intrinsics."""
        return np.zeros((6, len(self.intrinsics_names))) if self.intrinsics is None else self.intrinsics.with_pose

    @property
    def turn(self) -> Floats:
        """Rotation (3, 3) from camera to body."""
        return matrix_from_rotation_vector(self.pose[3:])

    def scaled(self, reported: Floats) -> Floats:
        """Covariances (L, 6, 6) of the navigation's errors, where it reports these."""
        if self.levels is None:
            return reported
        one = self.levels
        scale = np.array([1.0, 1.0, 1.0, one.attitude, one.attitude, one.attitude])
        return reported * np.outer(scale, scale) * (one.drift**2 + one.white**2 + one.constant**2)


def pixel_variances(mounted: MountedCamera, sources: Collection[Source], sigma_ground_m: float) -> Floats:
    """Variances (P, 4) of each pixel: of normalised x and y, of the ground's height (m^2), and of x with y."""
    camera = mounted.camera
    sigmas, focal = camera.sigmas, camera.focal_length_px
    variances = np.zeros((camera.n_pixels, 4))
    if "intrinsics" in sources:
        by = by_intrinsics(camera, mounted.intrinsics_names)
        of_ray = by @ mounted.intrinsics_covariance @ np.swapaxes(by, 1, 2)
        variances[:, 0], variances[:, 1], variances[:, 3] = of_ray[:, 0, 0], of_ray[:, 1, 1], of_ray[:, 0, 1]
    if "pixel" in sources:
        x = normalised_pixels(camera)
        along_px = sigmas.u_px * (1.0 if mounted.levels is None else mounted.levels.pixel)
        along = (along_px / (focal * lens.distortion_slope(x, camera.lens))) ** 2
        bend = lens.across_slope(x, camera.lens)
        variances[:, 0] += along
        variances[:, 3] += bend * along
        # of a late line that an adjustment has found, the covariance of the line tells instead
        late = (sigmas.v_px / focal) ** 2 if mounted.levels is None else 0.0
        variances[:, 1] += bend**2 * along + late
    if "ground" in sources:
        variances[:, 2] = sigma_ground_m**2
    return variances


def line_covariances(
    mounted: MountedCamera, euler_rad: Floats, reported: Floats, motion: Floats, sources: Collection[Source]
) -> Floats:
    """Covariances (L, 6, 6) of the camera's centre (m) and of a small turn of it (rad), both in world axes.

    `euler_rad` (L, 3): roll, pitch, yaw of the body; `reported` (L, 6, 6): what the navigation says of itself; `motion`
    (L, 6): of the body from line to line, position (m) and Euler angles (rad), by which a pixel that is late is wrong.
    """
    body = matrix_from_euler(euler_rad)
    total = np.zeros((len(euler_rad), 6, 6))
    if "pose" in sources:
        by_pose = np.zeros_like(total)
        by_pose[:, :3, :3] = body
        by_pose[:, 3:, 3:] = body @ left_jacobian_so3(mounted.pose[3:])
        total += by_pose @ mounted.covariance @ np.swapaxes(by_pose, -1, -2)
    is_late = "pixel" in sources and mounted.levels is not None
    if "navigation" in sources or is_late:
        of_body = np.zeros_like(total)
        if "navigation" in sources:
            of_body += mounted.scaled(reported)
        if is_late and mounted.levels is not None:
            of_body += mounted.levels.lateness**2 * motion[:, :, None] * motion[:, None, :]
        turn = small_rotation_by_euler(euler_rad)
        by_body = np.zeros_like(total)
        by_body[:, :3, :3] = np.eye(3)
        by_body[:, :3, 3:] = -skew(body @ mounted.pose[:3]) @ turn
        by_body[:, 3:, 3:] = turn
        total += by_body @ of_body @ np.swapaxes(by_body, -1, -2)
    return total


def line_with_intrinsics(mounted: MountedCamera, euler_rad: Floats, sources: Collection[Source]) -> Floats:
    """Covariances (L, 6, I) of the camera's centre and small turn, in world axes, with the intrinsics.

    Pose and intrinsics of an adjustment err together: apart, each alone counts.
    """
    with_intrinsics = mounted.with_intrinsics
    if "pose" not in sources or "intrinsics" not in sources:
        return np.zeros((len(euler_rad), *with_intrinsics.shape))
    body = matrix_from_euler(euler_rad)
    return np.concatenate([body @ with_intrinsics[:3], body @ with_intrinsics[3:]], axis=1)


def by_intrinsics(camera: Camera, names: tuple[str, ...]) -> Floats:
    """Derivatives (P, 2, I) of each pixel's normalised x and y by the intrinsics of these names."""
    x, optics, focal = normalised_pixels(camera), camera.lens, camera.focal_length_px
    distorted = (np.arange(camera.n_pixels) - camera.principal_point_px) / focal
    by_s, by_y = lens.by_coefficients(x, names[2:])
    moves = np.column_stack([np.full(camera.n_pixels, 1 / focal), distorted / camera.focal_length_m, by_s])
    by_x = -moves / lens.distortion_slope(x, optics)[:, None]
    bends = np.column_stack([np.zeros((camera.n_pixels, 2)), by_y])
    return np.stack([by_x, bends + lens.across_slope(x, optics)[:, None] * by_x], axis=1)


def normalised_pixels(camera: Camera) -> Floats:
    """Normalised x (P,) of every pixel's centre."""
    return normalised_from_pixel(camera, np.arange(camera.n_pixels))


def bend_of(camera: Camera, x: Floats) -> Floats:
    """Y (P,) of the line at x (P,); none where it is straight."""
    return lens.across(x, camera.lens) if not camera.lens.is_straight else np.empty(0)


@cache
def radii_of_95() -> Floats:
    """Radius that holds 95 % of a normal error in the plane whose larger sigma is 1, by the ratio of the two (R,).

    In polar coordinates: the share beyond a radius is the mean of `exp(-r^2 / 2 q)` over angles of the ellipse's
    density, whose root is found by bisection.
    """
    ratio = np.linspace(0.0, 1.0, _RATIOS)[:, None]
    angle = (np.arange(_ANGLES) + 0.5) * (np.pi / 2 / _ANGLES)
    variance = np.cos(angle) ** 2 + (ratio * np.sin(angle)) ** 2  # along the direction of standard normal draws
    low, high = np.full(_RATIOS, 1.9), np.full(_RATIOS, 2.5)
    for _ in range(50):
        middle = (low + high) / 2
        beyond = np.mean(np.exp(-(middle[:, None] ** 2) / (2 * variance)), axis=1)
        low, high = np.where(beyond > 1 - _HELD, middle, low), np.where(beyond > 1 - _HELD, high, middle)
    return (low + high) / 2

"""The line-scan camera: from a pixel to a ray and back.

Pixel u counts along the scan line from 0; its centre is at the whole number. The normalised image plane lies at z = 1
in front of the camera, with x along the scan line and y across it. What the lens does stands in `lens`: the ray of a
pixel is (x, y, 1), y being zero but for a line that is tilted or bent.
"""

from collections.abc import Mapping
from typing import Annotated, Any, Final

import numpy as np
from numpy.typing import ArrayLike
from pydantic import Field, PositiveFloat, model_validator

from linepose.arrays import Floats
from linepose.geometry import lens as lenses
from linepose.geometry.camera_sigmas import CameraSigmas
from linepose.geometry.focal_length import LARGEST_FIELD_DEG, SMALLEST_FIELD_DEG, in_metres
from linepose.geometry.lens import COEFFICIENTS, LARGEST_COEFFICIENT, Lens
from linepose.geometry.view_angles import ViewAngles, fault_of_width, knots
from linepose.settings import Settings, SettingsError

_MOST_CARRIES: Final = 12  # each leaves a share of the bend that is its slope
_SAME: Final = 1e-6  # of normalised x
_NO_KNOTS: Final = np.empty(0)
_Coefficient = Annotated[float, Field(ge=-LARGEST_COEFFICIENT, le=LARGEST_COEFFICIENT)]


class Camera(Settings):
    """Intrinsic parameters of a line-scan camera and how well they are known.

    The focal length is given in metres, or told by the field of view or by a table of view angles.

    Examples
    --------
    >>> import linepose
    >>> camera = linepose.Camera(focal_length_m=8e-3, pixel_pitch_m=8e-6, n_pixels=640, principal_point_px=319.5)
    >>> round(camera.focal_length_px)
    1000
    >>> wide = linepose.Camera(field_of_view_deg=90, n_pixels=2000, principal_point_px=999.5)
    >>> round(wide.focal_length_px)
    1000
    """

    focal_length_m: PositiveFloat = Field(description="Focal length (m); or field_of_view_deg, or view_angles.")
    field_of_view_deg: float | None = Field(
        None,
        ge=SMALLEST_FIELD_DEG,
        le=LARGEST_FIELD_DEG,
        description="In place of focal_length_m: angle between the outer edges of the first and last pixel, without "
        "distortion and about the line's middle (deg).",
    )
    view_angles: ViewAngles | None = Field(
        None,
        description="In place of focal_length_m and principal_point_px: a CSV beside the platform's file with the view "
        "angle of each pixel (columns pixel, across_deg, and along_deg where the line is not straight), or these as "
        "lists.",
    )
    pixel_pitch_m: float = Field(
        ge=1e-9,
        le=0.1,
        description="Width of a pixel on the sensor (m); may be left out with field_of_view_deg or view_angles.",
    )
    n_pixels: int = Field(gt=0, le=1_000_000, description="Pixels of a scan line.")
    principal_point_px: float = Field(
        description="Where the optical axis meets the line (px from the centre of the first pixel); or view_angles."
    )
    k1: _Coefficient = Field(0.0, description="First radial distortion coefficient (no unit).")
    k2: _Coefficient = Field(0.0, description="Second radial distortion coefficient (no unit).")
    k3: _Coefficient = Field(0.0, description="Third radial distortion coefficient (no unit).")
    p2: _Coefficient = Field(
        0.0, description="Tangential distortion coefficient along the line, OpenCV's p2 (no unit)."
    )
    tilt: _Coefficient = Field(0.0, description="Slope of the line across a straight one (no unit).")
    smile: _Coefficient = Field(
        0.0, description="Bend of the line: y = tilt x + smile x^2 in the normalised plane (no unit)."
    )
    sigmas: CameraSigmas = Field(CameraSigmas(), description="One standard deviation of each.")

    @model_validator(mode="before")
    @classmethod
    def _with_focal_length(cls, values: Any) -> Any:
        """The focal length in metres, and its sigma, of a camera that is told by angles."""
        if not isinstance(values, Mapping):
            return values
        return in_metres(values)

    @model_validator(mode="after")
    def _sees_the_whole_line(self) -> "Camera":
        fault = None if self.view_angles is None else fault_of_width(self.view_angles.pixel, self.n_pixels)
        if fault is not None:
            raise SettingsError(fault.found, fault.expected, fault.remedy, "view_angles")
        return self

    @property
    def focal_length_px(self) -> float:
        """Focal length in pixels: what turns a distance in the normalised plane into one in pixels."""
        return self.focal_length_m / self.pixel_pitch_m

    @property
    def lens(self) -> Lens:
        """What the lens does to the line."""
        table = (_NO_KNOTS,) * 5 if self.view_angles is None else knots(self.view_angles)
        return Lens(self.k1, self.k2, self.k3, self.p2, self.tilt, self.smile, *table)

    @property
    def uncertain_coefficients(self) -> tuple[str, ...]:
        """Names of the lens's coefficients that are not known exactly."""
        return tuple(name for name in COEFFICIENTS if getattr(self.sigmas, name) > 0)

    def straightened(self) -> "Camera":
        """The camera with neither tilt nor bend of its line."""
        table = self.view_angles and self.view_angles.replaced(along_deg=())
        sigmas = self.sigmas.replaced(tilt=0.0, smile=0.0)
        return self.replaced(tilt=0.0, smile=0.0, view_angles=table, sigmas=sigmas)

    def mirrored(self) -> "Camera":
        """The camera whose pixels are counted from the other end, turned half about its axis."""
        return self.replaced(
            principal_point_px=self.n_pixels - 1 - self.principal_point_px,
            p2=-self.p2,
            smile=-self.smile,
            view_angles=self.view_angles and self.view_angles.mirrored(self.n_pixels),
        )


def normalised_from_pixel(camera: Camera, u_px: ArrayLike) -> Floats:
    """Normalised x of pixels u on the line, distortion removed; (...) to (...), NaN where the lens sees nothing."""
    u = np.asarray(u_px, dtype=float)
    return lenses.undistort((u - camera.principal_point_px) / camera.focal_length_px, camera.lens)


def pixel_from_normalised(camera: Camera, x: ArrayLike) -> Floats:
    """Pixel u of normalised x, distortion applied; (...) to (...).

    NaN beyond where the lens turns back: far outside the field of view a polynomial falls onto the line again.
    """
    lens, ideal = camera.lens, np.asarray(x, dtype=float)
    with np.errstate(over="ignore", invalid="ignore"):
        s = lenses.distort(ideal, lens)
        if not lens.is_ideal:
            s = np.where(np.abs(lenses.undistort(s, lens) - ideal) < _SAME * (1 + np.abs(ideal)), s, np.nan)
    return s * camera.focal_length_px + camera.principal_point_px


def pixel_directions(camera: Camera, u_px: ArrayLike) -> Floats:
    """Directions (x, y, 1) of pixels' rays in the camera's axes; (...) to (..., 3)."""
    x = normalised_from_pixel(camera, u_px)
    return np.stack([x, lenses.across(x, camera.lens) + np.zeros_like(x), np.ones_like(x)], axis=-1)


def off_line(camera: Camera, in_camera: Floats) -> Floats:
    """How far points (..., 3) in the camera's axes lie off what the line sees, along the camera's y (m); (...)."""
    lens = camera.lens
    if lens.is_straight:
        return in_camera[..., 1]
    with np.errstate(divide="ignore", invalid="ignore"):
        return in_camera[..., 1] - in_camera[..., 2] * lenses.across(in_camera[..., 0] / in_camera[..., 2], lens)


def carried_onto_line(camera: Camera, in_camera: Floats, ahead: Floats) -> tuple[Floats, Floats]:
    """How far along a direction (3,) points (..., 3) have to be carried back until the line sees them, and where then.

    All in the camera's axes (m); (...) and (..., 3).
    """
    lens = camera.lens
    step = in_camera[..., 1] / ahead[1]
    at = in_camera - step[..., None] * ahead
    for _ in range(0 if lens.is_straight else _MOST_CARRIES):
        bend = lenses.across(at[..., 0] / at[..., 2], lens)
        step = (in_camera[..., 1] - bend * in_camera[..., 2]) / (ahead[1] - bend * ahead[2])
        at = in_camera - step[..., None] * ahead
    return step, at


def straight_and_certain(camera: Camera) -> Camera:
    """The camera as the paper's equations can have it: a straight line, and sigmas of k1 and k2 alone."""
    straight = camera.straightened()
    return straight.replaced(sigmas=straight.sigmas.replaced(k3=0.0, p2=0.0))


def rays(
    camera: Camera,
    pose_matrix: ArrayLike,
    lever_arm_m: ArrayLike,
    body_matrix: ArrayLike,
    body_position_m: ArrayLike,
    u_px: ArrayLike,
) -> tuple[Floats, Floats]:
    """Centres and directions (not of unit length) of pixels' rays in the world; (...) pixels to (..., 3) twice.

    `c = p_wb + R_wb r`, `d = R_wb R_bc [x, y, 1]` (Eq. 11), with R_wb (..., 3, 3), p_wb (..., 3).
    """
    in_camera = pixel_directions(camera, u_px)
    r_wb = np.asarray(body_matrix, dtype=float)
    centres = np.asarray(body_position_m, dtype=float) + r_wb @ np.asarray(lever_arm_m, dtype=float)
    directions = np.einsum("...ij,jk,...k->...i", r_wb, np.asarray(pose_matrix, dtype=float), in_camera)
    return centres, directions

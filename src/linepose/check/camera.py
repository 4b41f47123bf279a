"""Whether the camera's numbers can be those of a line-scan camera: a wrong unit shows in the field of view."""

from collections.abc import Collection
from typing import Final

import numpy as np

from linepose.arrays import Floats
from linepose.check.finding import Finding, error, ok, warning
from linepose.geometry.camera import Camera, normalised_from_pixel, pixel_directions

_FIELD_OF_VIEW_DEG: Final = (3.0, 140.0)
_PITCH_M: Final = (1e-6, 1e-4)
_FOCAL_M: Final = (1e-3, 0.5)
_OFF_CENTRE: Final = 0.1  # of the line: how far the principal point may lie from its middle
_OFF_STRAIGHT: Final = 0.05  # of the line
_LARGEST_STEP: Final = 5.0  # of angle a pixel, in medians: at most 3 times where a lens sees 140 deg without distortion
_SUBJECT: Final = "camera"


def camera_findings(camera: Camera, keys: Collection[str]) -> list[Finding]:
    """Findings on focal length, pixel pitch, field of view, distortion and principal point.

    `keys` are those of the platform's file that tell the camera.
    """
    findings = []
    if "focal_length_m" in keys and not _FOCAL_M[0] <= camera.focal_length_m <= _FOCAL_M[1]:
        found = f"camera.focal_length_m is {camera.focal_length_m:g} m"
        findings.append(error(_SUBJECT, found, "give it in metres: 8.2 mm is 8.2e-3"))
    if "pixel_pitch_m" in keys and not _PITCH_M[0] <= camera.pixel_pitch_m <= _PITCH_M[1]:
        found = f"camera.pixel_pitch_m is {camera.pixel_pitch_m:g} m"
        findings.append(error(_SUBJECT, found, "give it in metres: 7.4 um is 7.4e-6"))
    if findings:
        return findings
    findings += [_field_finding(camera, keys), *_step_findings(camera)]
    lost = np.flatnonzero(~np.isfinite(normalised_from_pixel(camera, np.arange(camera.n_pixels))))
    if len(lost):
        found = f"the lens turns back on itself at {len(lost)} of {camera.n_pixels} pixels, from pixel {lost[0]}"
        findings.append(error(_SUBJECT, found, "correct camera.k1, k2, k3 and p2: normalised x, no pixels"))
    off_px = camera.focal_length_px * float(np.nanmax(np.abs(_off_straight(camera))))
    if off_px > _OFF_STRAIGHT * camera.n_pixels:
        found = f"the line lies up to {off_px:.6g} px off a straight one"
        level = error if off_px > camera.n_pixels else warning
        findings.append(level(_SUBJECT, found, "check camera.tilt and smile (normalised plane), or along_deg"))
    middle = (camera.n_pixels - 1) / 2
    if abs(camera.principal_point_px - middle) > _OFF_CENTRE * camera.n_pixels:
        found = f"camera.principal_point_px is {camera.principal_point_px:g}, the line's middle {middle:g}"
        advice = "check it; without a calibration of the lens take the middle, with a larger camera.sigmas"
        findings.append(warning(_SUBJECT, found, advice))
    return findings


def _field_finding(camera: Camera, keys: Collection[str]) -> Finding:
    """On the field of view, by the key that tells it."""
    field_deg = float(np.degrees(2 * np.arctan(camera.n_pixels / 2 / camera.focal_length_px)))
    if _FIELD_OF_VIEW_DEG[0] <= field_deg <= _FIELD_OF_VIEW_DEG[1]:
        return ok(_SUBJECT, f"field of view {field_deg:.1f} deg, {1e3 / camera.focal_length_px:.3f} mrad a pixel")
    few = f"{field_deg:.3g} deg, which few cameras do"
    told = next((name for name in ("field_of_view_deg", "view_angles") if name in keys), None)
    if told is None:
        pitch_um, focal_mm = camera.pixel_pitch_m * 1e6, camera.focal_length_m * 1e3
        return warning(
            _SUBJECT,
            f"{camera.n_pixels} pixels of {pitch_um:.3g} um behind {focal_mm:.3g} mm see {few}",
            "check camera.focal_length_m, pixel_pitch_m and n_pixels against the data sheet (binning counts)",
        )
    advice = f"check camera.{told} and n_pixels against the data sheet (binning counts)"
    if _FIELD_OF_VIEW_DEG[0] <= np.degrees(field_deg) <= _FIELD_OF_VIEW_DEG[1]:
        advice = f"if these are radians, give degrees ({np.degrees(field_deg):.3g} deg); else {advice}"
    return warning(_SUBJECT, f"by camera.{told} the line sees {few}", advice)


def _step_findings(camera: Camera) -> list[Finding]:
    """On a step in the table of view angles, which no lens makes."""
    table = camera.view_angles
    if table is None:
        return []
    by_pixel = np.diff(table.across_deg) / np.diff(table.pixel)
    share, k = float(by_pixel.max() / np.median(by_pixel)), int(np.argmax(by_pixel))
    if share <= _LARGEST_STEP:
        return []
    step_deg = table.across_deg[k + 1] - table.across_deg[k]
    found = f"camera.view_angles: across_deg steps by {step_deg:.3g} deg from pixel {table.pixel[k]:g} to "
    found += f"{table.pixel[k + 1]:g}, {share:.3g} times as far a pixel as elsewhere"
    return [warning(_SUBJECT, found, "look whether rows are missing there, or whether two tables were joined")]


def _off_straight(camera: Camera) -> Floats:
    """Y (P,) of every pixel's ray in the normalised plane."""
    return pixel_directions(camera, np.arange(camera.n_pixels))[:, 1]

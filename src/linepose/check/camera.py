"""Whether the camera's numbers can be those of a line-scan camera: a wrong unit shows in the field of view."""

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
_SUBJECT: Final = "camera"


def camera_findings(camera: Camera) -> list[Finding]:
    """Findings on focal length, pixel pitch, field of view, distortion and principal point."""
    findings = []
    if not _FOCAL_M[0] <= camera.focal_length_m <= _FOCAL_M[1]:
        found = f"camera.focal_length_m is {camera.focal_length_m:g} m"
        findings.append(error(_SUBJECT, found, "give it in metres: 8.2 mm is 8.2e-3"))
    if not _PITCH_M[0] <= camera.pixel_pitch_m <= _PITCH_M[1]:
        found = f"camera.pixel_pitch_m is {camera.pixel_pitch_m:g} m"
        findings.append(error(_SUBJECT, found, "give it in metres: 7.4 um is 7.4e-6"))
    if findings:
        return findings
    field_deg = float(np.degrees(2 * np.arctan(camera.n_pixels / 2 / camera.focal_length_px)))
    if not _FIELD_OF_VIEW_DEG[0] <= field_deg <= _FIELD_OF_VIEW_DEG[1]:
        pitch_um, focal_mm = camera.pixel_pitch_m * 1e6, camera.focal_length_m * 1e3
        found = f"{camera.n_pixels} pixels of {pitch_um:.3g} um behind {focal_mm:.3g} mm"
        findings.append(
            warning(
                _SUBJECT,
                f"{found} see {field_deg:.3g} deg, which few cameras do",
                "check camera.focal_length_m, pixel_pitch_m and n_pixels against the data sheet (binning counts)",
            )
        )
    else:
        one_mrad = 1e3 / camera.focal_length_px
        findings.append(ok(_SUBJECT, f"field of view {field_deg:.1f} deg, {one_mrad:.3f} mrad a pixel"))
    lost = np.flatnonzero(~np.isfinite(normalised_from_pixel(camera, np.arange(camera.n_pixels))))
    if len(lost):
        found = f"the lens turns back on itself at {len(lost)} of {camera.n_pixels} pixels, from pixel {lost[0]}"
        findings.append(error(_SUBJECT, found, "correct camera.k1, k2, k3 and p2: normalised x, no pixels"))
    off_px = camera.focal_length_px * float(np.nanmax(np.abs(_off_straight(camera))))
    if off_px > _OFF_STRAIGHT * camera.n_pixels:
        found = f"the line lies up to {off_px:.0f} px off a straight one"
        findings.append(warning(_SUBJECT, found, "check camera.tilt and smile (normalised plane), or along_deg"))
    middle = (camera.n_pixels - 1) / 2
    if abs(camera.principal_point_px - middle) > _OFF_CENTRE * camera.n_pixels:
        found = f"camera.principal_point_px is {camera.principal_point_px:g}, the line's middle {middle:g}"
        advice = "check it; without a calibration of the lens take the middle, with a larger camera.sigmas"
        findings.append(warning(_SUBJECT, found, advice))
    return findings


def _off_straight(camera: Camera) -> Floats:
    """Y (P,) of every pixel's ray in the normalised plane."""
    return pixel_directions(camera, np.arange(camera.n_pixels))[:, 1]

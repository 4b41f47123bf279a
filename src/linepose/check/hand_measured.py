"""Whether the hand-measured pose can be about right: points in front of the camera, where they were seen."""

from typing import Final

import numpy as np

from linepose.adjustment.measurements import measurements_from_survey
from linepose.adjustment.start import looks_down, start_points
from linepose.arrays import Floats
from linepose.check.finding import Finding, error, numbers, ok, span, warning
from linepose.check.replay import in_camera
from linepose.geometry.camera import Camera, off_line, pixel_from_normalised, straight_and_certain
from linepose.likelihood.published import PublishedLikelihood
from linepose.survey.observations import Survey

_EXPLAINED: Final = 3.0  # sigmas of the hand measurement that an error may have
_NEAR_M: Final = 0.05
_FAR_M: Final = 200.0
_LONGEST_ARM_M: Final = 10.0
_LONGEST_VEHICLE_M: Final = 50.0
_SUBJECT: Final = "hand measurement"
ADVICE: Final = (
    "check hand_measured: camera in body axes (x forward, y right, z down), angles roll, pitch, yaw from camera to "
    "body (zyx intrinsic), camera x along the scan line, z the optical axis"
)


def arm_findings(position_m: Floats) -> list[Finding]:
    """What a hand-measured position (3,) says of its unit: an error where no vehicle is as long, which stands for all.

    An arm that is a few hundred times too long makes nonsense of what points and conventions then say.
    """
    arm_m = float(np.linalg.norm(position_m))
    found = f"the camera is {arm_m:.3g} m from the body's origin"
    advice = "give hand_measured.position_m in metres, from the navigation's origin"
    if arm_m > _LONGEST_VEHICLE_M:
        return [error(_SUBJECT, found, advice)]
    return [warning(_SUBJECT, found, advice)] if arm_m > _LONGEST_ARM_M else []


def hand_findings(survey: Survey, camera: Camera, pose: Floats, covariance: Floats) -> tuple[list[Finding], Floats]:
    """Findings on a hand-measured pose (6,) with covariance (6, 6), and the points (M, 3) that it gives.

    The points are those of the paper's equations, in which points behind the camera count as if in front; of a survey
    from above they are the feet of rays on the ground.
    """
    findings = arm_findings(pose[:3])
    point_m, error_px = _points_and_errors(survey, camera, pose)
    distance = in_camera(pose, survey.position_m, survey.euler_rad, point_m)[..., 2]
    seen = np.isfinite(error_px)
    behind = seen & (distance <= 0)
    if behind.any():
        views = survey.number[behind.any(axis=1)]
        found = f"{int(behind.sum())} of {int(seen.sum())} points lie behind the camera (observation {numbers(views)})"
        return [*findings, error(_SUBJECT, found, ADVICE)], point_m
    where = f"the points lie {span(distance[seen])} m in front of the camera"
    if distance[seen].min() < _NEAR_M or distance[seen].max() > _FAR_M:
        findings.append(warning(_SUBJECT, where, "check the units of positions and of hand_measured.position_m (m)"))
    else:
        findings.append(ok(_SUBJECT, where))
    mean_px = float(np.nanmean(error_px))
    allowed_px = expected_error_px(camera, covariance, float(np.median(distance[seen])))
    told = f"it reproduces the pixels within {mean_px:.1f} px on average; its sigmas explain about {allowed_px:.0f} px"
    if mean_px > _EXPLAINED * allowed_px:
        findings.append(warning(_SUBJECT, told, f"{ADVICE}; and the navigation's axes and angles"))
    else:
        findings.append(ok(_SUBJECT, told))
    return findings, point_m


def _points_and_errors(survey: Survey, camera: Camera, pose: Floats) -> tuple[Floats, Floats]:
    """Points (M, 3) at a pose (6,), and how far their pixels are off (N, M).

    Where the camera looks down, rays are nearly parallel: points are their feet on the ground.
    """
    measurements = measurements_from_survey(survey, camera)
    if not looks_down(measurements, pose):
        residuals = PublishedLikelihood(survey, straight_and_certain(camera)).without_cheirality().residuals(pose)
        return residuals.point_m, residuals.error_px
    point_m = np.full((survey.n_points, 3), np.nan)
    point_m[measurements.points] = start_points(measurements, camera, pose)
    seen = in_camera(pose, survey.position_m, survey.euler_rad, point_m)
    with np.errstate(divide="ignore", invalid="ignore"):
        along = pixel_from_normalised(camera, seen[..., 0] / seen[..., 2]) - survey.u_px
        across = camera.focal_length_px * off_line(camera, seen) / seen[..., 2]
    return point_m, np.hypot(along, across)


def expected_error_px(camera: Camera, covariance: Floats, distance_m: float) -> float:
    """Error (px) that a pose's covariance (6, 6) makes for points at this distance along the optical axis."""
    variance = float(np.trace(covariance[3:, 3:])) + float(np.trace(covariance[:3, :3])) / distance_m**2
    return camera.focal_length_px * float(np.sqrt(variance * 2 / 3))

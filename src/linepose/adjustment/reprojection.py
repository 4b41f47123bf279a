"""Reprojection errors of an adjustment at the body poses as reported, with the sigmas that its levels say of them."""

import numpy as np

from linepose.adjustment.levels import Levels
from linepose.adjustment.linearise import Optics, empty_linearised, linearise
from linepose.adjustment.measurements import measurements_from_survey
from linepose.adjustment.process import ErrorStructure, error_image
from linepose.adjustment.result import Adjustment, gridded
from linepose.arrays import Floats
from linepose.geometry.camera import Camera
from linepose.geometry.rotations import matrix_from_rotation_vector
from linepose.likelihood.base import Residuals
from linepose.survey.observations import Survey


def optics_of(found: Adjustment, camera: Camera) -> Optics:
    """The adjusted camera as the kernels take it."""
    return Optics(
        np.ascontiguousarray(found.pose[:3]),
        np.ascontiguousarray(matrix_from_rotation_vector(found.pose[3:])),
        float(found.principal_point_px),
        float(found.focal_length_m),
        camera.pixel_pitch_m,
        camera.lens.at(found.coefficients),
        np.empty(0, dtype=np.int64),
    )


def reprojection(survey: Survey, camera: Camera, found: Adjustment, line_period_s: float | None = None) -> Residuals:
    """The errors at the adjusted camera and points and at the body poses as reported, of the survey that was adjusted.

    The sigma counts every part of the navigation's error, lateness and pixels at the estimated levels.
    """
    measurements = measurements_from_survey(survey, camera, None, line_period_s)
    optics = optics_of(found, camera)
    out = empty_linearised(len(measurements.u_px))
    points = np.ascontiguousarray(found.points_m[measurements.points])
    moved = 0.0 if np.isnan(found.clock_offset_s) else found.clock_offset_s
    bodies = measurements.body_pose + moved * measurements.rate
    linearise(
        measurements.u_px,
        bodies,
        np.zeros_like(bodies),
        measurements.point,
        points,
        measurements.known.shifts,
        optics,
        out,
    )
    image = error_image(measurements.structure, out)
    variance = _variance(measurements.structure, image.by_position, image.by_attitude, image.late, found.levels)
    error = out.residual_px
    length = np.linalg.norm(error, axis=1)
    direction = np.where(length[:, None] > 0, error / np.where(length > 0, length, 1.0)[:, None], [1.0, 0.0])
    sigma = np.sqrt(np.einsum("li,lij,lj->l", direction, variance, direction))
    grid = measurements.row, measurements.column, survey.u_px.shape
    return Residuals(
        error_px=gridded(length, *grid),
        sigma_px=gridded(sigma, *grid),
        error_uv_px=gridded(error, *grid),
        point_m=found.points_m,
        point_covariance=found.point_covariance,
    )


def _variance(
    structure: ErrorStructure, by_position: Floats, by_attitude: Floats, late: Floats, levels: Levels
) -> Floats:
    """Variance (L, 2, 2) of each measurement, all parts of its error together (px^2)."""
    unit = by_position + levels.attitude * by_attitude
    navigation = levels.drift**2 + levels.constant**2 + levels.white**2
    variance = navigation * unit @ np.swapaxes(unit, 1, 2)
    lateness = levels.lateness**2 * np.stack([late[:, [0, 1]], late[:, [1, 2]]], axis=1)
    variance += lateness
    variance[:, 0, 0] += (levels.pixel * structure.sigma_u_px) ** 2
    return variance

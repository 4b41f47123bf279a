"""Eq. 11-22 as the paper writes them, one ray, pair and observation at a time, with Jacobians by complex step.

For tests and the benchmark only. It shares nothing with the compiled kernel but the survey and the camera.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from linepose.geometry.camera import Camera
from linepose.geometry.rotations import matrix_from_rotation_vector
from linepose.survey.observations import Survey

Array = NDArray[np.float64]
STEP = 1e-30
PARALLEL_SINE_SQUARED = 1e-16


@dataclass(frozen=True)
class Reference:
    """Everything the equations give: errors in pixels (N, M), points (M, 3), covariances (M, 3, 3)."""

    log_likelihood: float
    error_px: Array
    sigma_px: Array
    error_uv_px: Array
    point_m: Array
    point_covariance: Array


def jacobian(function: Callable[[Array], Array], at: Array) -> Array:
    """Columns of derivatives by complex step; `function` takes rows of parameters to rows of results."""
    steps = at + 1j * STEP * np.eye(len(at))
    return np.asarray(function(steps)).imag.T / STEP


def euler_matrix(euler: Array) -> Array:
    roll, pitch, yaw = np.moveaxis(euler, -1, 0)
    zero, one = np.zeros_like(roll), np.ones_like(roll)

    def matrix(*entries: Array) -> Array:
        return np.stack(entries, axis=-1).reshape(*roll.shape, 3, 3)

    about_x = matrix(one, zero, zero, zero, np.cos(roll), -np.sin(roll), zero, np.sin(roll), np.cos(roll))
    about_y = matrix(np.cos(pitch), zero, np.sin(pitch), zero, one, zero, -np.sin(pitch), zero, np.cos(pitch))
    about_z = matrix(np.cos(yaw), -np.sin(yaw), zero, np.sin(yaw), np.cos(yaw), zero, zero, zero, one)
    return about_z @ about_y @ about_x


def normalised(pixel: Array, intrinsics: Array, pitch_m: float) -> tuple[Array, Array]:
    """Pixel (u, v) to the normalised plane; intrinsics are u0, f in metres, k1, k2."""
    u, v = np.moveaxis(pixel, -1, 0)
    u0, f, k1, k2 = np.moveaxis(intrinsics, -1, 0)
    distorted = (u - u0) / (f / pitch_m)
    x = distorted
    for _ in range(60):  # each step leaves a small share of the error
        x = x + distorted - x * (1 + k1 * x**2 + k2 * x**4)
    return x, v / (f / pitch_m)


def ray(camera_pose: Array, pixel: Array, body_pose: Array, intrinsics: Array, pitch_m: float) -> tuple[Array, Array]:
    """Centre and direction (Eq. 11)."""
    x, y = normalised(pixel, intrinsics, pitch_m)
    r_bc = matrix_from_rotation_vector(camera_pose[3:])
    r_wb = euler_matrix(body_pose[..., 3:])
    in_camera = np.stack([x, y, np.ones_like(x)], axis=-1)
    return body_pose[..., :3] + r_wb @ camera_pose[:3], np.einsum("...ij,jk,...k->...i", r_wb, r_bc, in_camera)


def nearest_point(camera_pose: Array, parameters: Array, pitch_m: float) -> Array:
    """The point on the second ray nearest to the first; (..., 20) to (..., 3).

    Parameters: u, v, body pose of the first ray (8), of the second (8), u0, f, k1, k2.
    """
    first, second, intrinsics = parameters[..., :8], parameters[..., 8:16], parameters[..., 16:]
    c1, d1 = ray(camera_pose, first[..., :2], first[..., 2:], intrinsics, pitch_m)
    c2, d2 = ray(camera_pose, second[..., :2], second[..., 2:], intrinsics, pitch_m)
    q = np.cross(d1, np.cross(d1, d2))
    along = np.sum((c1 - c2) * q, axis=-1) / np.sum(d2 * q, axis=-1)
    return c2 + along[..., None] * d2


def reprojection_error(camera_pose: Array, parameters: Array, pitch_m: float) -> tuple[Array, Array, Array]:
    """Reprojected minus observed in the normalised plane, and the depth; parameters (..., 15).

    Parameters: the estimated point (3), u, v, body pose (6), u0, f, k1, k2.
    """
    point, pixel, body, intrinsics = np.split(parameters, [3, 5, 11], axis=-1)
    r_wb = euler_matrix(body[..., 3:])
    in_body = np.einsum("...ji,...j->...i", r_wb, point - body[..., :3]) - camera_pose[:3]
    in_camera = in_body @ matrix_from_rotation_vector(camera_pose[3:])
    x, y = normalised(pixel, intrinsics, pitch_m)
    depth = in_camera[..., 2]
    return in_camera[..., 0] / depth - x, in_camera[..., 1] / depth - y, depth


def evaluate(survey: Survey, camera: Camera, camera_pose: Array) -> Reference:
    """The whole likelihood at one camera pose (6,)."""
    camera_pose = np.asarray(camera_pose, dtype=float)
    pitch_m = camera.pixel_pitch_m
    sigmas = camera.sigmas
    pixel_covariance = np.diag([sigmas.u_px**2, sigmas.v_px**2])
    intrinsics = np.array([camera.principal_point_px, camera.focal_length_m, camera.k1, camera.k2])
    intrinsic_covariance = np.diag(
        np.square([sigmas.principal_point_px, sigmas.focal_length_m, sigmas.k1, sigmas.k2]),
    )
    n, m = survey.u_px.shape
    error, sigma = np.full((n, m), np.nan), np.full((n, m), np.nan)
    error_uv, points, covariances = np.full((n, m, 2), np.nan), np.full((m, 3), np.nan), np.full((m, 3, 3), np.nan)
    total = 0.0
    for k in range(m):
        views = np.flatnonzero(np.isfinite(survey.u_px[:, k]))
        if len(views) < 2:
            continue
        pixels = {i: np.array([survey.u_px[i, k], 0.0]) for i in views}
        bodies = {i: np.concatenate([survey.position_m[i, k], survey.euler_rad[i, k]]) for i in views}
        weight, weighted = np.zeros((3, 3)), np.zeros(3)
        for i in views:
            for j in views:
                if i == j:
                    continue
                d_i = ray(camera_pose, pixels[i], bodies[i], intrinsics, pitch_m)[1]
                d_j = ray(camera_pose, pixels[j], bodies[j], intrinsics, pitch_m)[1]
                cross = np.cross(d_i, d_j)
                if cross @ cross <= PARALLEL_SINE_SQUARED * (d_i @ d_i) * (d_j @ d_j):
                    continue
                at = np.concatenate([pixels[i], bodies[i], pixels[j], bodies[j], intrinsics])
                covariance = np.zeros((20, 20))
                covariance[0:2, 0:2] = covariance[8:10, 8:10] = pixel_covariance
                covariance[2:8, 2:8] = survey.covariance[i, k]
                covariance[10:16, 10:16] = survey.covariance[j, k]
                covariance[16:, 16:] = intrinsic_covariance
                by = jacobian(lambda p: nearest_point(camera_pose, p, pitch_m), at)
                information = np.linalg.inv(by @ covariance @ by.T)
                weight += information
                weighted += information @ nearest_point(camera_pose, at, pitch_m)
        if not np.any(weight):
            total = np.inf
            continue
        covariances[k] = np.linalg.inv(weight)
        points[k] = covariances[k] @ weighted
        for i in views:
            at = np.concatenate([points[k], pixels[i], bodies[i], intrinsics])
            covariance = np.zeros((15, 15))
            covariance[0:3, 0:3] = covariances[k]
            covariance[3:5, 3:5] = pixel_covariance
            covariance[5:11, 5:11] = survey.covariance[i, k]
            covariance[11:, 11:] = intrinsic_covariance
            ex, ey, depth = reprojection_error(camera_pose, at, pitch_m)
            if depth <= 0:
                total = np.inf

            def distance(p: Array) -> Array:
                x, y, _ = reprojection_error(camera_pose, p, pitch_m)
                return np.sqrt(x**2 + y**2)[..., None]

            by = jacobian(distance, at)
            e = float(np.hypot(ex, ey))
            variance = float((by @ covariance @ by.T)[0, 0])
            error[i, k], sigma[i, k] = e, np.sqrt(variance)
            error_uv[i, k] = -ex, -ey
            total += e**2 / variance
    scale = camera.focal_length_px
    return Reference(-0.5 * total, error * scale, sigma * scale, error_uv * scale, points, covariances)

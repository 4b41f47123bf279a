"""The geometry of the shared-error model, compiled: rays met in points, and lines linearised at the points.

A line's residual is modelled as `r = A dP + W z + n`: dP the step of its point (m), z the six standardised navigation
errors of its view, n its own noise, of covariance D. All in pixels.
"""

from typing import NamedTuple

import numpy as np
from numba import njit

from linepose.arrays import Floats
from linepose.likelihood.block_system import factorise, solve_transposed, solve_upper
from linepose.likelihood.shared_arrays import SharedArrays

SMALL_ANGLE_RAD = 1e-4


class Optics(NamedTuple):
    """What turns a world point into a pixel, and the pixel's noise; lever_arm_m (3,), camera_from_body (3, 3)."""

    lever_arm_m: Floats
    camera_from_body: Floats
    focal_length_px: float
    principal_point_px: float
    k1: float
    k2: float
    sigma_u_px: float
    sigma_v_px: float


class Levels(NamedTuple):
    """Scales of the reported navigation sigmas (shared by a view, own of a line) and of the camera's pixel sigmas."""

    shared: float
    white: float
    pixel: float


class FixedOptics(NamedTuple):
    """What is not estimated of a camera: pixel pitch (m), radial distortion, and one sigma of a pixel."""

    pixel_pitch_m: float
    k1: float
    k2: float
    sigma_u_px: float
    sigma_v_px: float


class Lines(NamedTuple):
    """The lines linearised at the points: A, W, r, and D^-1 as (uu, uv, vv), with the log-determinant of D.

    by_point (L, 2, 3), by_shared (L, 2, 6), residual_px (L, 2), precision (L, 3), log_determinant (L,).
    """

    by_point: Floats
    by_shared: Floats
    residual_px: Floats
    precision: Floats
    log_determinant: Floats


@njit(cache=True, error_model="numpy")
def matrix_from_rotation_vector(vector_rad: Floats) -> Floats:
    """Rotation matrix (3, 3) of a rotation vector (3,); Rodrigues' formula, its series near zero."""
    x, y, z = vector_rad[0], vector_rad[1], vector_rad[2]
    squared = x * x + y * y + z * z
    if squared < SMALL_ANGLE_RAD**2:
        first, second = 1.0 - squared / 6.0, 0.5 - squared / 24.0
    else:
        angle = np.sqrt(squared)
        first, second = np.sin(angle) / angle, (1.0 - np.cos(angle)) / squared
    skew = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    matrix = np.empty((3, 3))
    for i in range(3):
        for j in range(3):
            square = 0.0
            for k in range(3):
                square += skew[i, k] * skew[k, j]
            matrix[i, j] = first * skew[i, j] + second * square
        matrix[i, i] += 1.0
    return matrix


@njit(cache=True, error_model="numpy")
def optics_at(parameters: Floats, fixed: FixedOptics) -> Optics:
    """The optics at the parameters (11,) of the shared-error model."""
    camera_from_body = np.ascontiguousarray(matrix_from_rotation_vector(parameters[3:6]).T)
    return Optics(
        parameters[:3].copy(),
        camera_from_body,
        parameters[10] / fixed.pixel_pitch_m,
        parameters[9],
        fixed.k1,
        fixed.k2,
        fixed.sigma_u_px,
        fixed.sigma_v_px,
    )


@njit(cache=True, error_model="numpy")
def levels_at(parameters: Floats) -> Levels:
    """The levels at the parameters (11,) of the shared-error model, which hold their logarithms."""
    return Levels(np.exp(parameters[6]), np.exp(parameters[7]), np.exp(parameters[8]))


@njit(cache=True, error_model="numpy")
def intersect_rays(arrays: SharedArrays, optics: Optics, n_points: int) -> Floats:
    """Points (K, 3) nearest to their rays in the sense of least squares; not finite where the rays are parallel.

    Distortion is left out here: the steps that follow apply it.
    """
    normal, vector = np.zeros((n_points, 3, 3)), np.zeros((n_points, 3))
    direction, centre = np.empty(3), np.empty(3)
    c_b, lever = optics.camera_from_body, optics.lever_arm_m
    for line in range(arrays.u_px.shape[0]):
        x = (arrays.u_px[line] - optics.principal_point_px) / optics.focal_length_px
        length = np.sqrt(x * x + 1.0)
        point, w_b = arrays.line_point[line], arrays.world_from_body[line]
        for i in range(3):
            direction[i], centre[i] = 0.0, arrays.position_m[line, i]
            for j in range(3):
                direction[i] += w_b[i, j] * (c_b[0, j] * x + c_b[2, j]) / length
                centre[i] += w_b[i, j] * lever[j]
        along = direction[0] * centre[0] + direction[1] * centre[1] + direction[2] * centre[2]
        for i in range(3):
            vector[point, i] += centre[i] - direction[i] * along
            normal[point, i, i] += 1.0
            for j in range(3):
                normal[point, i, j] -= direction[i] * direction[j]
    for point in range(n_points):
        if np.isnan(factorise(normal[point])):
            vector[point] = np.nan
        solve_transposed(normal[point], vector[point])
        solve_upper(normal[point], vector[point])
    return vector


@njit(cache=True, error_model="numpy")
def project_line(
    optics: Optics,
    u_px: float,
    position_m: Floats,
    world_from_body: Floats,
    point_m: Floats,
    residual_px: Floats,
    by_point: Floats,
) -> bool:
    """Fill the residual (2,) of a line, observed minus projected, and A (2, 3); whether the point (3,) is in front.

    With q the point in the camera's axes: `u = f x (1 + k1 x^2 + k2 x^4) + u0`, `x = q_x/q_z`, and `v = f q_y/q_z`.
    """
    w_b, c_b, p = world_from_body, optics.camera_from_body, position_m
    d0, d1, d2 = point_m[0] - p[0], point_m[1] - p[1], point_m[2] - p[2]
    b0 = w_b[0, 0] * d0 + w_b[1, 0] * d1 + w_b[2, 0] * d2 - optics.lever_arm_m[0]
    b1 = w_b[0, 1] * d0 + w_b[1, 1] * d1 + w_b[2, 1] * d2 - optics.lever_arm_m[1]
    b2 = w_b[0, 2] * d0 + w_b[1, 2] * d1 + w_b[2, 2] * d2 - optics.lever_arm_m[2]
    depth = c_b[2, 0] * b0 + c_b[2, 1] * b1 + c_b[2, 2] * b2
    if not depth > 0.0:
        return False
    x = (c_b[0, 0] * b0 + c_b[0, 1] * b1 + c_b[0, 2] * b2) / depth
    y = (c_b[1, 0] * b0 + c_b[1, 1] * b1 + c_b[1, 2] * b2) / depth
    x2, f = x * x, optics.focal_length_px
    residual_px[0] = u_px - optics.principal_point_px - f * x * (1.0 + x2 * (optics.k1 + x2 * optics.k2))
    residual_px[1] = -f * y
    by_x = f * (1.0 + x2 * (3.0 * optics.k1 + x2 * 5.0 * optics.k2)) / depth
    by_y = f / depth
    u0, u1, u2 = c_b[0, 0] - x * c_b[2, 0], c_b[0, 1] - x * c_b[2, 1], c_b[0, 2] - x * c_b[2, 2]
    v0, v1, v2 = c_b[1, 0] - y * c_b[2, 0], c_b[1, 1] - y * c_b[2, 1], c_b[1, 2] - y * c_b[2, 2]
    for i in range(3):
        by_point[0, i] = by_x * (u0 * w_b[i, 0] + u1 * w_b[i, 1] + u2 * w_b[i, 2])
        by_point[1, i] = by_y * (v0 * w_b[i, 0] + v1 * w_b[i, 1] + v2 * w_b[i, 2])
    return True


@njit(cache=True, error_model="numpy")
def body_pose_jacobian(by_point: Floats, offset_m: Floats, euler_axes: Floats, by_body: Floats) -> None:
    """Fill J (2, 6), the projection by north, east, down, roll, pitch, yaw of the body, from A (2, 3).

    A body that moves by dp is a point that moves by -dp; one that turns by w, a point that moves by `offset x w`,
    offset (3,) from body to point.
    """
    for row in range(2):
        a0, a1, a2 = by_point[row, 0], by_point[row, 1], by_point[row, 2]
        c0 = a1 * offset_m[2] - a2 * offset_m[1]
        c1 = a2 * offset_m[0] - a0 * offset_m[2]
        c2 = a0 * offset_m[1] - a1 * offset_m[0]
        by_body[row, 0], by_body[row, 1], by_body[row, 2] = -a0, -a1, -a2
        for i in range(3):
            by_body[row, 3 + i] = c0 * euler_axes[0, i] + c1 * euler_axes[1, i] + c2 * euler_axes[2, i]


@njit(cache=True, error_model="numpy")
def empty_lines(n_lines: int) -> Lines:
    """Room for `linearise`."""
    return Lines(
        np.empty((n_lines, 2, 3)),
        np.empty((n_lines, 2, 6)),
        np.empty((n_lines, 2)),
        np.empty((n_lines, 3)),
        np.empty(n_lines),
    )


@njit(cache=True, error_model="numpy")
def linearise(arrays: SharedArrays, optics: Optics, levels: Levels, points_m: Floats, lines: Lines) -> bool:
    """Fill `lines` at the points (K, 3); whether every point is in front of the camera.

    `W = a J F` and `D = b^2 J Q J^T + g^2 diag(sigma_u^2, sigma_v^2)`, with a, b, g the levels. Where the body's motion
    matters, `l^2 = sigma_v^2 g^2 / (1 + g^8)^(1/4)` of the noise across the line is a point that is late. It has the
    direction and size of the motion's image, `m = J motion` less what is allowed for: `l^2 m m^T` in its place.
    """
    by_body, offset = np.empty((2, 6)), np.empty(3)
    by_u, by_v = by_body[0], by_body[1]
    white2, pixel2 = levels.white**2, levels.pixel**2
    for line in range(arrays.u_px.shape[0]):
        point, position, by_point = points_m[arrays.line_point[line]], arrays.position_m[line], lines.by_point[line]
        u_px, w_b = arrays.u_px[line], arrays.world_from_body[line]
        if not project_line(optics, u_px, position, w_b, point, lines.residual_px[line], by_point):
            return False
        for i in range(3):
            offset[i] = point[i] - position[i]
        body_pose_jacobian(by_point, offset, arrays.euler_axes[line], by_body)
        uu, uv, vv = 0.0, 0.0, 0.0
        u0, u1, u2, u3, u4, u5 = by_u[0], by_u[1], by_u[2], by_u[3], by_u[4], by_u[5]
        v0, v1, v2, v3, v4, v5 = by_v[0], by_v[1], by_v[2], by_v[3], by_v[4], by_v[5]
        f, q, shared = arrays.shared_root[arrays.line_view[line]], arrays.covariance[line], lines.by_shared[line]
        for c in range(6):
            along = u0 * f[0, c] + u1 * f[1, c] + u2 * f[2, c] + u3 * f[3, c] + u4 * f[4, c] + u5 * f[5, c]
            across = v0 * f[0, c] + v1 * f[1, c] + v2 * f[2, c] + v3 * f[3, c] + v4 * f[4, c] + v5 * f[5, c]
            shared[0, c], shared[1, c] = levels.shared * along, levels.shared * across
        for c in range(6):
            along = u0 * q[0, c] + u1 * q[1, c] + u2 * q[2, c] + u3 * q[3, c] + u4 * q[4, c] + u5 * q[5, c]
            across = v0 * q[0, c] + v1 * q[1, c] + v2 * q[2, c] + v3 * q[3, c] + v4 * q[4, c] + v5 * q[5, c]
            uu += along * by_u[c]
            uv += along * by_v[c]
            vv += across * by_v[c]
        noise_u2, noise_v2 = pixel2 * optics.sigma_u_px**2, pixel2 * optics.sigma_v_px**2
        uu, uv, vv = white2 * uu + noise_u2, white2 * uv, white2 * vv + noise_v2
        if not np.isnan(arrays.motion[line, 0]):
            along, across = -arrays.motion[line, 6], 0.0
            for c in range(6):
                along += by_u[c] * arrays.motion[line, c]
                across += by_v[c] * arrays.motion[line, c]
            late2 = noise_v2 / np.sqrt(np.sqrt(1.0 + pixel2**4))  # below the camera's sigma all of it, at most that
            uu += late2 * along * along
            uv += late2 * along * across
            vv += late2 * (across * across - 1.0)
        determinant = uu * vv - uv * uv
        lines.precision[line, 0] = vv / determinant
        lines.precision[line, 1] = -uv / determinant
        lines.precision[line, 2] = uu / determinant
        lines.log_determinant[line] = np.log(determinant)
    return True

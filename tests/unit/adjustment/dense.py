"""The adjustment written plainly: dense covariance matrices, every derivative by complex step."""

import numpy as np

STEP = 1e-30


def euler_matrix(angles):
    (cr, cp, cy), (sr, sp, sy) = np.cos(angles), np.sin(angles)
    about_x = np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]])
    about_y = np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
    about_z = np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]])
    return about_z @ about_y @ about_x


def vector_matrix(vector):
    """Rotation matrix of a small or large rotation vector by the exponential series, valid for complex arguments."""
    if not np.any(vector):
        return np.eye(3)
    x, y, z = vector
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    total, term = np.eye(3, dtype=k.dtype), np.eye(3, dtype=k.dtype)
    for n in range(1, 20):
        term = term @ k / n
        total = total + term
    return total


def project(camera, lever, rotation, step, body, point):
    """Pixel (u, v) at a step: lever arm, small rotation on the left, principal point, focal length."""
    turned = vector_matrix(step[3:6]) @ rotation
    q = turned.T @ (euler_matrix(body[3:]).T @ (point - body[:3]) - lever - step[:3])
    x, f = q[0] / q[2], (camera.focal_length_m + step[7]) / camera.pixel_pitch_m
    radial = x * (1 + camera.k1 * x**2 + camera.k2 * x**4)
    return np.array([f * radial + camera.principal_point_px + step[6], f * q[1] / q[2]])


def complex_step(function, argument):
    columns = []
    for i in range(len(argument)):
        moved = argument.astype(complex)
        moved[i] += STEP * 1j
        columns.append(np.imag(function(moved)) / STEP)
    return np.array(columns).T


def linearised(camera, lever, rotation, measurements, points, bodies):
    """Residual (2 L,), and by theta (2 L, 10), point (2 L, 3), body (2 L, 6); shift and clock offset last of theta."""
    residual, by_theta, by_point, by_body = [], [], [], []
    for line, point in enumerate(measurements.point):
        body, p, none = bodies[line], points[point], np.zeros(10)
        residual.append([measurements.u_px[line], 0] - project(camera, lever, rotation, none, body, p))
        rate, shift = measurements.rate[line], np.array([0.0, 0.0, measurements.known.shifts[point]])
        by_theta.append(
            complex_step(
                lambda s, b=body, r=rate, p=p, d=shift: project(camera, lever, rotation, s, b + r * s[9], p + d * s[8]),
                none,
            )
        )
        by_point.append(complex_step(lambda x, b=body: project(camera, lever, rotation, np.zeros(8), b, x), p))
        by_body.append(complex_step(lambda x, p=p: project(camera, lever, rotation, np.zeros(8), x, p), body))
    return tuple(np.concatenate(part) for part in (residual, by_theta, by_point, by_body))


def symmetric_root(covariance):
    sigma = np.sqrt(np.diag(covariance))
    values, vectors = np.linalg.eigh(covariance / np.outer(sigma, sigma))
    return np.diag(sigma) @ vectors @ np.diag(np.sqrt(values)) @ vectors.T


def body_covariance(measurements, covariances, time_s, motion, levels, view_weight, line_weight):
    """Covariance (6 L, 6 L) of all corrections."""
    n = len(measurements.u_px)
    out = np.zeros((6 * n, 6 * n))
    scale = np.diag([1, 1, 1, *[levels.attitude] * 3])
    roots = [scale @ symmetric_root(c) for c in covariances]
    for i in range(n):
        for j in range(n):
            same_view = measurements.view[i] == measurements.view[j]
            unit = levels.drift**2 * np.exp(-abs(time_s[i] - time_s[j]) / levels.correlation_time_s)
            unit += same_view * levels.constant**2 / view_weight[measurements.view[i]]
            unit += (i == j) * levels.white**2 / line_weight[i]
            block = unit * roots[i] @ roots[j].T
            if i == j:
                block = block + levels.lateness**2 / line_weight[i] * np.outer(motion[i], motion[i])
            out[6 * i : 6 * i + 6, 6 * j : 6 * j + 6] = block
    return out


def measurement_covariance(by_body, of_bodies, levels, camera, line_weight):
    """Covariance (2 L, 2 L) of all measurements."""
    n = len(by_body) // 2
    image = np.zeros((2 * n, 6 * n))
    for i in range(n):
        image[2 * i : 2 * i + 2, 6 * i : 6 * i + 6] = by_body[2 * i : 2 * i + 2]
    pixels = np.tile([(levels.pixel * camera.sigmas.u_px) ** 2, 0.05**2], n) / np.repeat(line_weight, 2)
    return image @ of_bodies @ image.T + np.diag(pixels), image


def design(measurements, by_theta, by_point):
    """Columns in the order of the normal equations: points, intrinsics, common shift, clock offset, pose."""
    n = len(measurements.u_px)
    points = np.zeros((2 * n, 3 * measurements.n_points))
    for i, k in enumerate(measurements.point):
        points[2 * i : 2 * i + 2, 3 * k : 3 * k + 3] = by_point[2 * i : 2 * i + 2]
    return np.hstack([points, by_theta[:, 6:], by_theta[:, :6]])

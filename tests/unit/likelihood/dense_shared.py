"""The shared-error model written plainly: dense covariance matrices, and derivatives by complex step."""

import numpy as np

from linepose.geometry.camera import Camera
from linepose.survey.observations import Survey

STEP = 1e-30


def euler_matrix(angles):
    (cr, cp, cy), (sr, sp, sy) = np.cos(angles), np.sin(angles)
    about_x = np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]])
    about_y = np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
    about_z = np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]])
    return about_z @ about_y @ about_x


def vector_matrix(vector):
    angle = np.sqrt(np.sum(vector**2))
    x, y, z = vector / angle
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k


def project(parameters, camera: Camera, body, point):
    """Pixel (u, v) of a world point, body = position and Euler angles (6,); complex where an argument is."""
    q = vector_matrix(parameters[3:6]).T @ (euler_matrix(body[3:]).T @ (point - body[:3]) - parameters[:3])
    x, f = q[0] / q[2], parameters[10] / camera.pixel_pitch_m
    return np.array([f * x * (1 + camera.k1 * x**2 + camera.k2 * x**4) + parameters[9], f * q[1] / q[2]])


def complex_step(function, argument):
    columns = []
    for i in range(len(argument)):
        moved = argument.astype(complex)
        moved[i] += STEP * 1j
        columns.append(np.imag(function(moved)) / STEP)
    return np.array(columns).T


def lines_of(survey: Survey):
    """(view, point) of every used line, points renumbered."""
    seen = np.isfinite(survey.u_px)
    used = np.nonzero(seen.sum(axis=0) >= 2)[0]
    return [(i, k) for i in range(survey.n_observations) for k in range(len(used)) if seen[i, used[k]]], used


def intersection(survey, camera, parameters, lines, used):
    points = []
    for k in range(len(used)):
        normal, right = np.zeros((3, 3)), np.zeros(3)
        for i, point in lines:
            if point == k:
                r_wb = euler_matrix(survey.euler_rad[i, used[k]])
                x = (survey.u_px[i, used[k]] - parameters[9]) * camera.pixel_pitch_m / parameters[10]
                direction = r_wb @ vector_matrix(parameters[3:6]) @ [x, 0, 1]
                across = np.eye(3) - np.outer(direction, direction) / (direction @ direction)
                normal += across
                right += across @ (survey.position_m[i, used[k]] + r_wb @ parameters[:3])
        points.append(np.linalg.solve(normal, right))
    return np.concatenate(points)


def linearised(survey, camera, parameters, lines, used, points):
    """Residuals (2 L,), design (2 L, 3 K), and the body pose's Jacobian of each line."""
    residual, design, by_body = [], np.zeros((2 * len(lines), len(points))), []
    for row, (i, k) in enumerate(lines):
        body = np.concatenate([survey.position_m[i, used[k]], survey.euler_rad[i, used[k]]])
        point = points[3 * k : 3 * k + 3]
        residual.append([survey.u_px[i, used[k]], 0] - project(parameters, camera, body, point))
        design[2 * row : 2 * row + 2, 3 * k : 3 * k + 3] = complex_step(
            lambda p, body=body: project(parameters, camera, body, p), point
        )
        by_body.append(complex_step(lambda b, point=point: project(parameters, camera, b, point), body))
    return np.concatenate(residual), design, by_body


def covariance_of(survey, camera, parameters, lines, used, by_body):
    """Covariance (2 L, 2 L) of all lines, full within a view."""
    a, b, g = np.exp(parameters[6:9])
    covariance = np.zeros((2 * len(lines), 2 * len(lines)))
    for first, (i, k) in enumerate(lines):
        for second, (j, _) in enumerate(lines):
            if i == j:
                mean = np.mean([survey.covariance[i, used[p]] for view, p in lines if view == i], axis=0)
                block = a**2 * by_body[first] @ mean @ by_body[second].T
                if first == second:
                    block = block + b**2 * by_body[first] @ survey.covariance[i, used[k]] @ by_body[first].T
                    block = block + g**2 * np.diag([camera.sigmas.u_px**2, camera.sigmas.v_px**2])
                covariance[2 * first : 2 * first + 2, 2 * second : 2 * second + 2] = block
    return covariance


def log_prior(camera, parameters):
    levels = (parameters[6:9] - np.log(0.5)) / 1.5
    principal_point = (parameters[9] - camera.principal_point_px) / camera.sigmas.principal_point_px
    focal_length = (parameters[10] - camera.focal_length_m) / camera.sigmas.focal_length_m
    return -0.5 * (levels @ levels + principal_point**2 + focal_length**2)


def log_likelihood(survey: Survey, camera: Camera, parameters) -> float:
    """The whole of it: one step on pixels alone, two linearisations, and the points integrated out."""
    lines, used = lines_of(survey)
    points = intersection(survey, camera, parameters, lines, used)
    pixels = np.tile([camera.sigmas.u_px**2, camera.sigmas.v_px**2], len(lines))
    for step in range(3):
        residual, design, by_body = linearised(survey, camera, parameters, lines, used, points)
        own = np.diag(pixels) if step == 0 else covariance_of(survey, camera, parameters, lines, used, by_body)
        information = design.T @ np.linalg.solve(own, design)
        move = np.linalg.solve(information, design.T @ np.linalg.solve(own, residual))
        points = points + move
    left = residual - design @ move
    chi_squared = left @ np.linalg.solve(own, left)
    determinants = np.linalg.slogdet(own)[1] + np.linalg.slogdet(information)[1]
    return -0.5 * (chi_squared + determinants) + log_prior(camera, parameters)

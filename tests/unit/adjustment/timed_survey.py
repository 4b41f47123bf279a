"""Small surveys with times and a known truth: views one after the other, of a body that moves."""

from dataclasses import dataclass

import numpy as np

from linepose.geometry.camera import Camera
from linepose.geometry.camera_sigmas import CameraSigmas
from linepose.geometry.rotations import matrix_from_euler, matrix_from_rotation_vector
from linepose.survey.observations import Survey

CAMERA = Camera(
    focal_length_m=8.0e-3,
    pixel_pitch_m=8.0e-6,
    n_pixels=600,
    principal_point_px=300.0,
    k1=-0.2,
    k2=0.1,
    sigmas=CameraSigmas(v_px=0.8),
)
POSE = np.array([0.2, -0.05, -0.8, -0.8, 0.78, -1.45])
SIGMA = np.array([0.01, 0.013, 0.011, 4e-3, 4.6e-3, 1.8e-3])
SPEED_M_S = 0.2
LINE_S = 0.01


@dataclass(frozen=True)
class Errors:
    """True levels of a survey's errors, in units of the reported sigmas, pixels and lines."""

    drift: float = 0.4
    white: float = 0.1
    constant: float = 0.4
    pixel: float = 0.5
    lateness: float = 0.5
    correlation_time_s: float = 30.0


def reported_covariance(scale=1.0):
    correlation = np.full((6, 6), 0.3) + 0.7 * np.eye(6)
    return correlation * np.outer(SIGMA, SIGMA) * scale**2


def make_survey(
    n_views, n_points, errors=None, seed=0, gap_s=20.0, camera=CAMERA, speeds_m_s=(SPEED_M_S,), clock_offset_s=0.0
):
    """Views from all round the pattern; each point crosses the line of the true body exactly, then errors are added.

    Views take the speeds in turn; the clock of the scan is `clock_offset_s` behind that of the navigation.
    """
    errors = errors or Errors()
    random = np.random.default_rng(seed)
    points = random.uniform([-0.6, -0.6, 0.2], [0.6, 0.6, 0.6], (n_points, 3))
    r_bc = matrix_from_rotation_vector(POSE[3:])
    shape = (n_views, n_points)
    time, u = np.zeros(shape), np.empty(shape)
    position, euler = np.empty((*shape, 3)), np.empty((*shape, 3))
    for view in range(n_views):
        attitude = np.array([*random.normal(0, 0.08, 2), 2 * np.pi * view / n_views + random.normal(0, 0.2)])
        r_wb = matrix_from_euler(attitude)
        aim = random.normal([0, 0, 0.4], 0.1)
        centre = aim - r_wb @ r_bc[:, 2] * random.uniform(1.6, 2.6) - r_wb @ POSE[:3]
        forward, speed = r_wb @ r_bc[:, 1], speeds_m_s[view % len(speeds_m_s)]
        for point in range(n_points):
            in_camera = r_bc.T @ (r_wb.T @ (points[point] - centre) - POSE[:3])
            lateness = LINE_S * errors.lateness * random.normal()
            time[view, point] = gap_s * view + in_camera[1] / speed + lateness - clock_offset_s
            body = centre + forward * (in_camera[1] + speed * (lateness - clock_offset_s))
            x = in_camera[0] / in_camera[2]
            radial = x * (1 + camera.k1 * x**2 + camera.k2 * x**4)
            noise = errors.pixel * camera.sigmas.u_px * random.normal()
            u[view, point] = camera.principal_point_px + camera.focal_length_px * radial + noise
            position[view, point], euler[view, point] = body, attitude
    root = _root(reported_covariance())
    order = np.argsort(time, axis=None)
    z, state = np.empty((time.size, 6)), random.normal(size=6)
    flat = time.ravel()[order]
    for k in range(time.size):
        if k:
            decay = np.exp(-(flat[k] - flat[k - 1]) / errors.correlation_time_s)
            state = decay * state + np.sqrt(1 - decay**2) * random.normal(size=6)
        z[order[k]] = state
    unit = errors.drift * z.reshape(*shape, 6) + errors.white * random.normal(size=(*shape, 6))
    unit += errors.constant * random.normal(size=(n_views, 1, 6))
    wrong = unit @ root.T
    return Survey(
        number=np.arange(1, n_views + 1),
        time_us=np.rint((time + 10.0) * 1e6).astype(np.int64),
        u_px=u,
        position_m=position + wrong[..., :3],
        euler_rad=euler + wrong[..., 3:],
        covariance=np.broadcast_to(reported_covariance(), (*shape, 6, 6)).copy(),
        nav_gap_s=np.zeros(shape),
        origin_m=np.zeros(3),
    )


def _root(covariance):
    sigma = np.sqrt(np.diag(covariance))
    values, vectors = np.linalg.eigh(covariance / np.outer(sigma, sigma))
    return np.diag(sigma) @ vectors @ np.diag(np.sqrt(values)) @ vectors.T


def without(survey, *lines):
    """The survey with the points of these (row, point) missing."""
    gaps = survey.u_px.copy(), survey.position_m.copy(), survey.euler_rad.copy(), survey.covariance.copy()
    for row, point in lines:
        for values in gaps:
            values[row, point] = np.nan
    u, position, euler, covariance = gaps
    return Survey(survey.number, survey.time_us, u, position, euler, covariance, survey.nav_gap_s, survey.origin_m)

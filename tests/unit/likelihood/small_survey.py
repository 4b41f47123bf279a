"""Small surveys with a known truth: a line-scan camera that sweeps over a pattern from several directions."""

from dataclasses import dataclass

import numpy as np

from linepose.geometry.camera import Camera
from linepose.geometry.camera_sigmas import CameraSigmas
from linepose.geometry.rotations import matrix_from_euler, matrix_from_rotation_vector
from linepose.survey.observations import Survey

CAMERA = Camera(focal_length_m=8.0e-3, pixel_pitch_m=8.0e-6, n_pixels=600, principal_point_px=300.0)
DISTORTED = CAMERA.replaced(k1=-0.2, k2=0.1, sigmas=CameraSigmas(v_px=0.8))
POSE = np.array([0.2, -0.05, -0.8, -0.8, 0.78, -1.45])  # looks ahead and down, line across the path
NAVIGATION_SIGMA = np.array([0.01, 0.013, 0.011, 4e-3, 4.6e-3, 1.8e-3])
CORRELATION = 0.3


@dataclass(frozen=True)
class Truth:
    """Levels with which a survey is made: of the shared error, of each line's own, and of the pixel."""

    shared: float = 0.0
    white: float = 0.0
    pixel: float = 1.0


def reported_covariance() -> np.ndarray:
    correlation = np.full((6, 6), CORRELATION) + (1 - CORRELATION) * np.eye(6)
    return correlation * np.outer(NAVIGATION_SIGMA, NAVIGATION_SIGMA)


def make_survey(n_views: int, n_points: int, truth: Truth, seed: int, camera: Camera = CAMERA) -> Survey:
    """Views from all round the pattern; the true body crosses each point's line exactly, then errors are added."""
    random = np.random.default_rng(seed)
    points = random.uniform([-0.6, -0.6, 0.2], [0.6, 0.6, 0.6], (n_points, 3))
    r_bc = matrix_from_rotation_vector(POSE[3:])
    optical_axis = r_bc[:, 2]
    shape = (n_views, n_points)
    u, position, euler = np.empty(shape), np.empty((*shape, 3)), np.empty((*shape, 3))
    covariance = np.empty((*shape, 6, 6))
    for view in range(n_views):
        attitude = np.array([*random.normal(0, 0.08, 2), 2 * np.pi * view / n_views + random.normal(0, 0.2)])
        r_wb = matrix_from_euler(attitude)
        aim = random.normal([0, 0, 0.4], 0.1)
        centre = aim - r_wb @ optical_axis * random.uniform(1.6, 2.6) - r_wb @ POSE[:3]
        scale = random.uniform(0.7, 1.5)
        root = np.linalg.cholesky(reported_covariance() * scale**2)
        common = truth.shared * root @ random.normal(size=6)
        for point in range(n_points):
            forward = r_wb @ r_bc[:, 1]
            at_centre = r_bc.T @ (r_wb.T @ (points[point] - centre) - POSE[:3])
            body = centre + forward * at_centre[1]
            x, _, z = r_bc.T @ (r_wb.T @ (points[point] - body) - POSE[:3])
            x /= z
            distorted = x * (1 + camera.k1 * x**2 + camera.k2 * x**4)
            noise = truth.pixel * random.normal(size=2) * [camera.sigmas.u_px, camera.sigmas.v_px]
            u[view, point] = camera.principal_point_px + camera.focal_length_px * distorted + noise[0]
            body = body + forward * noise[1] * z / camera.focal_length_px
            error = common + truth.white * root @ random.normal(size=6)
            position[view, point], euler[view, point] = body + error[:3], attitude + error[3:]
            drift = 1 + 0.05 * point / n_points  # the reported covariance changes a little within a view
            covariance[view, point] = reported_covariance() * (scale * drift) ** 2
    return Survey(
        number=np.arange(1, n_views + 1),
        time_us=np.zeros(shape, dtype=np.int64),
        u_px=u,
        position_m=position,
        euler_rad=euler,
        covariance=covariance,
        nav_gap_s=np.zeros(shape),
        origin_m=np.zeros(3),
    )


def without(survey: Survey, *lines: tuple[int, int]) -> Survey:
    """The survey with the points of these (row, point) missing."""
    gaps = survey.u_px.copy(), survey.position_m.copy(), survey.euler_rad.copy(), survey.covariance.copy()
    for row, point in lines:
        for values in gaps:
            values[row, point] = np.nan
    u, position, euler, covariance = gaps
    return Survey(survey.number, survey.time_us, u, position, euler, covariance, survey.nav_gap_s, survey.origin_m)

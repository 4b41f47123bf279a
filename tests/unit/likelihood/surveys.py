"""Surveys to evaluate likelihoods on: a synthetic one, and the authors' field data where it is at hand."""

from pathlib import Path

import numpy as np

from linepose.geometry import rotations
from linepose.geometry.camera import Camera, pixel_from_normalised
from linepose.geometry.camera_sigmas import CameraSigmas
from linepose.survey.observations import Survey

FIELD_FOLDER = Path(__file__).resolve().parents[4] / "shared" / "ladybird"
FIELD_CAMERA = Camera(focal_length_m=8.2e-3, pixel_pitch_m=4.8e-3 / 648, n_pixels=648, principal_point_px=323.0)
INLIERS = (*range(1, 7), *range(14, 22), 24, 25)
SYNTHETIC_POSE = np.array([0.2, -0.1, -0.8, -0.8, 0.75, -1.4])
DISTORTED_CAMERA = Camera(
    focal_length_m=8.2e-3,
    pixel_pitch_m=4.8e-3 / 648,
    n_pixels=648,
    principal_point_px=320.0,
    k1=-0.05,
    k2=0.02,
    sigmas=CameraSigmas(u_px=0.4, v_px=0.6, k1=0.02, k2=0.05),
)


def field_survey(folder: Path = FIELD_FOLDER) -> Survey:
    """Observations 1-25 of the Ladybird: every second view by name, with the covariance nearest in time."""
    files = sorted((folder / "labelled_points").glob("*.csv"))[1::2]
    navigation = np.loadtxt(folder / "nav_covs.csv", delimiter=",")
    times, matrices = navigation[:, 0], navigation[:, 1:].reshape(-1, 12, 12)[:, :6, :6]
    views = [np.loadtxt(file, delimiter=",", ndmin=2) for file in files]
    n, m = len(views), 15
    u, time = np.full((n, m), np.nan), np.zeros((n, m), dtype=np.int64)
    position, euler, covariance = np.full((n, m, 3), np.nan), np.full((n, m, 3), np.nan), np.full((n, m, 6, 6), np.nan)
    gap = np.full((n, m), np.nan)
    origin = np.round(np.concatenate(views)[:, 3:6].mean(axis=0))
    for i, view in enumerate(views):
        for row in view:
            k = int(row[1])
            nearest = int(np.argmin(np.abs(times - row[0])))
            time[i, k], u[i, k], gap[i, k] = int(row[0]), row[2], (times[nearest] - row[0]) * 1e-6
            position[i, k], euler[i, k], covariance[i, k] = row[3:6] - origin, row[6:9], matrices[nearest]
    return Survey(np.arange(1, n + 1), time, u, position, euler, covariance, gap, origin)


def synthetic_survey(n_observations: int, n_points: int, seed: int, camera: Camera = DISTORTED_CAMERA) -> Survey:
    """A vehicle that passes scattered points at many headings, rolls and pitches; every covariance is its own."""
    random = np.random.default_rng(seed)
    points = np.column_stack([random.uniform(-0.6, 0.6, (n_points, 2)), random.uniform(-0.2, 0.2, n_points)])
    shape = (n_observations, n_points)
    euler = np.stack(
        [
            random.uniform(-0.15, 0.15, shape),
            random.uniform(-0.15, 0.15, shape),
            np.broadcast_to(random.uniform(-np.pi, np.pi, (n_observations, 1)), shape) + random.normal(0, 0.02, shape),
        ],
        axis=-1,
    )
    r_wb = rotations.matrix_from_euler(euler)
    r_bc = rotations.matrix_from_rotation_vector(SYNTHETIC_POSE[3:])
    x = random.uniform(-0.25, 0.25, shape)
    depth = random.uniform(1.5, 2.5, shape)
    in_camera = np.stack([x * depth, np.zeros(shape), depth], axis=-1)
    in_body = in_camera @ r_bc.T + SYNTHETIC_POSE[:3]
    position = points - np.einsum("...ij,...j->...i", r_wb, in_body) + random.normal(0, 0.01, (*shape, 3))
    scale = np.array([0.011, 0.013, 0.011, 4e-3, 4.5e-3, 2e-3])
    factors = random.normal(size=(*shape, 6, 6)) * 0.3 + np.eye(6)
    covariance = np.einsum("...ij,...kj->...ik", factors, factors) * scale[:, None] * scale
    return Survey(
        number=np.arange(1, n_observations + 1),
        time_us=np.zeros(shape, dtype=np.int64),
        u_px=pixel_from_normalised(camera, x) + random.normal(0, 0.5, shape),
        position_m=position,
        euler_rad=euler,
        covariance=covariance,
        nav_gap_s=np.zeros(shape),
        origin_m=np.zeros(3),
    )


def with_gaps(survey: Survey, missing: list[tuple[int, int]]) -> Survey:
    """The survey without these (row, point) entries: all of them NaN, as in a survey that was read."""
    arrays = {
        name: getattr(survey, name).copy() for name in ("u_px", "position_m", "euler_rad", "covariance", "nav_gap_s")
    }
    for i, k in missing:
        for array in arrays.values():
            array[i, k] = np.nan
    return Survey(number=survey.number, time_us=survey.time_us, origin_m=survey.origin_m, **arrays)

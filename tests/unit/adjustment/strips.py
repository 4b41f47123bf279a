"""Flights of many strips over many points, each seen by some of the strips."""

import numpy as np

from linepose.geometry.rotations import matrix_from_euler, rotation_vector_from_matrix
from linepose.survey.observations import Survey
from unit.adjustment import timed_survey

CAMERA = timed_survey.CAMERA
BODY_FROM_CAMERA = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
POSE = np.concatenate([[0.2, -0.05, 0.1], rotation_vector_from_matrix(BODY_FROM_CAMERA)])
LINE_S = 0.005
HEIGHTS_M = (56.0, 40.0)
SPEED_M_S = 8.0
ACROSS = 5  # strips of one direction that see a point
STRIP_GAP_S = 60.0


def make_flight(n_strips, n_points, errors=None, seed=1):
    """Half of the strips along either direction, there and back at two heights; errors as of `timed_survey`."""
    errors, random = errors or timed_survey.Errors(), np.random.default_rng(seed)
    half, spacing_m = n_strips // 2, 0.58 * HEIGHTS_M[1] / ACROSS
    side_m = spacing_m * half
    points = np.column_stack([random.uniform(-side_m / 2, side_m / 2, (n_points, 2)), random.normal(0, 1, n_points)])
    shape = (n_strips, n_points)
    time, u = np.zeros(shape), np.full(shape, np.nan)
    position, euler = np.full((*shape, 3), np.nan), np.full((*shape, 3), np.nan)
    for strip in range(n_strips):
        crossing, back = strip >= half, strip % 2
        yaw = np.pi / 2 * crossing + np.pi * back
        attitude = np.array([*random.normal(0, 0.03, 2), yaw + random.normal(0, 0.02)])
        r_wb = matrix_from_euler(attitude)
        offset_m = (strip % half - (half - 1) / 2) * spacing_m
        middle = np.array([offset_m, 0, -HEIGHTS_M[back]] if crossing else [0, offset_m, -HEIGHTS_M[back]])
        in_camera = ((points - middle) @ r_wb - POSE[:3]) @ BODY_FROM_CAMERA
        lateness = LINE_S * errors.lateness * random.normal(size=n_points)
        x = in_camera[:, 0] / in_camera[:, 2]
        ideal = CAMERA.principal_point_px + CAMERA.focal_length_px * x * (1 + CAMERA.k1 * x**2 + CAMERA.k2 * x**4)
        seen = (np.abs(ideal - CAMERA.n_pixels / 2) < CAMERA.n_pixels / 2) & (np.abs(in_camera[:, 1]) < side_m / 2 + 5)
        time[strip] = STRIP_GAP_S * strip - in_camera[:, 1] / SPEED_M_S + lateness
        noise = errors.pixel * CAMERA.sigmas.u_px * random.normal(size=n_points)
        u[strip] = np.where(seen, ideal + noise, np.nan)
        along = in_camera[:, 1] - SPEED_M_S * lateness
        position[strip] = middle + along[:, None] * (r_wb @ BODY_FROM_CAMERA[:, 1])
        euler[strip] = attitude
    where = np.nonzero(np.isfinite(u))
    wrong = _navigation_errors(time[where], where[0], errors, random)
    position[where] += wrong[:, :3]
    euler[where] += wrong[:, 3:]
    return Survey(
        number=np.arange(1, n_strips + 1),
        time_us=np.rint((time - time.min() + 10.0) * 1e6).astype(np.int64),
        u_px=u,
        position_m=position,
        euler_rad=euler,
        covariance=np.broadcast_to(timed_survey.reported_covariance(), (*shape, 6, 6)),
        nav_gap_s=np.zeros(shape),
        origin_m=np.zeros(3),
    )


def _navigation_errors(time_s, strip, errors, random):
    """Errors (L, 6) of body poses at times (L,) of strips (L,)."""
    order = np.argsort(time_s)
    decay = np.exp(-np.diff(time_s[order]) / errors.correlation_time_s)
    drift, state = np.empty((len(time_s), 6)), random.normal(size=6)
    drift[order[0]] = state
    for k, share in zip(order[1:], decay, strict=True):
        state = share * state + np.sqrt(1 - share**2) * random.normal(size=6)
        drift[k] = state
    unit = errors.drift * drift + errors.white * random.normal(size=drift.shape)
    unit += errors.constant * random.normal(size=(strip.max() + 1, 6))[strip]
    return unit @ timed_survey._root(timed_survey.reported_covariance()).T

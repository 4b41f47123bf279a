"""Flights over scattered points without any pattern, with a known truth: strips, tie points, navigation that drifts."""

from dataclasses import dataclass, field
from typing import Final

import numpy as np

from linepose.arrays import Floats
from linepose.geometry import rotations
from linepose.geometry.camera import Camera
from linepose.geometry.camera_sigmas import CameraSigmas
from linepose.simulation.drawn_camera import drawn_camera
from linepose.simulation.flight_layouts import CROSSED, Strip
from linepose.simulation.navigation_error import navigation_errors
from linepose.simulation.settings import NavigationErrorSettings, ReportedSettings
from linepose.simulation.strip_motion import StripMotion, crossing_times
from linepose.simulation.survey import reported_covariance
from linepose.survey.observations import Survey

FLIGHT_CAMERA: Final = Camera(
    focal_length_m=8.2e-3,
    pixel_pitch_m=7.407e-6,
    n_pixels=1024,
    principal_point_px=511.5,
    sigmas=CameraSigmas(u_px=0.4, v_px=0.5, principal_point_px=2.0, focal_length_m=5e-5),
)
# camera x to the right of the body, its line of sight down
NADIR: Final = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
_POSITION_M, _ROLL_RAD, _YAW_RAD = 0.02, float(np.deg2rad(0.02)), float(np.deg2rad(0.08))
_REPORTED: Final = ReportedSettings((_POSITION_M,) * 3, (_ROLL_RAD, _ROLL_RAD, _YAW_RAD))
_WHITE_SHARE: Final = 0.3  # of what the navigation reports
_MORE: Final = 3  # candidates for each point that is asked for


def drifting(correlation_time_s: float = 60.0) -> NavigationErrorSettings:
    """Errors that drift by what is reported, and are white besides."""
    position, euler = _REPORTED.position_m, _REPORTED.euler_rad

    def white(sigma: tuple[float, float, float]) -> tuple[float, float, float]:
        return (_WHITE_SHARE * sigma[0], _WHITE_SHARE * sigma[1], _WHITE_SHARE * sigma[2])

    return NavigationErrorSettings(
        gauss_markov_position_m=position,
        gauss_markov_euler_rad=euler,
        correlation_time_s=correlation_time_s,
        white_position_m=white(position),
        white_euler_rad=white(euler),
    )


@dataclass(frozen=True)
class FlightSettings:
    """A flight: its strips, its points and how wrong everything is.

    A point is seen in `fewest_strips` to `most_strips` strips; heights of the ground have sigma `relief_m` about zero;
    `lateness_lines` is a sigma; the true camera differs from what is believed by its own sigmas, its lever arm by
    `lever_sigma_m`, its turn by `turn_sigma_rad` about each axis of the body. Of `wrong_share` of the points one
    measurement or more lies `wrong_px` off, a bad match.
    """

    strips: tuple[Strip, ...] = CROSSED
    n_points: int = 200
    fewest_strips: int = 2
    most_strips: int = 6
    relief_m: float = 1.0
    speed_m_s: float = 5.0
    turn_s: float = 10.0
    line_period_s: float = 0.01
    pixel_px: float = 0.4
    lateness_lines: float = 0.5
    lever_sigma_m: float = 0.05
    turn_sigma_rad: float = float(np.deg2rad(1.0))
    wrong_share: float = 0.0
    wrong_px: float = 30.0
    navigation_error: NavigationErrorSettings = field(default_factory=drifting)


@dataclass(frozen=True)
class Flight:
    """What a flight records, and the truth behind it.

    survey: M points in N strips, without any hint of what is wrong; camera, hand_pose (6,), hand_covariance (6, 6): as
    they are believed to be; line_period_s; pose (6,), points_m (M, 3), true_camera: the truth;
    wrong (M,): points with bad matches.
    """

    survey: Survey
    camera: Camera
    hand_pose: Floats
    hand_covariance: Floats
    line_period_s: float
    pose: Floats
    points_m: Floats
    true_camera: Camera
    wrong: np.ndarray


def simulate_flight(
    settings: FlightSettings, seed: int | np.random.Generator, camera: Camera = FLIGHT_CAMERA
) -> Flight:
    """A flight; the same seed repeats every number."""
    random = np.random.default_rng(seed)
    by_hand = np.concatenate([[0.15, 0.05, 0.10], rotations.rotation_vector_from_matrix(NADIR)])
    turn = rotations.matrix_from_rotation_vector(settings.turn_sigma_rad * random.standard_normal(3))
    lever = by_hand[:3] + settings.lever_sigma_m * random.standard_normal(3)
    pose = np.concatenate([lever, rotations.rotation_vector_from_matrix(turn @ NADIR)])
    true_camera = drawn_camera(camera, 1.0, random)
    motion = StripMotion.drawn(settings.strips, settings.speed_m_s, settings.turn_s, random)
    points = points_below(settings, random)
    time_s, u_px = crossing_times(motion, true_camera, pose, points)
    seen = thinned(np.isfinite(u_px), settings.most_strips, random)
    kept = np.flatnonzero(seen.sum(axis=0) >= settings.fewest_strips)[: settings.n_points]
    points, time_s, u_px, seen = points[kept], time_s[:, kept], u_px[:, kept], seen[:, kept]
    row, column = np.nonzero(seen)
    true_u = u_px[row, column] + settings.pixel_px * random.standard_normal(len(row))
    late = settings.lateness_lines * settings.line_period_s * random.standard_normal(len(row))
    wrong = random.random(len(kept)) < settings.wrong_share
    du, dt = _bad_matches(wrong, row, column, settings, random)
    stamp = time_s[row, column] + late + dt
    body = motion.body_poses(row, stamp)
    order = np.argsort(stamp, kind="stable")
    body[order] += navigation_errors(random, settings.navigation_error, stamp[order], row[order])
    shape = u_px.shape
    grids = np.zeros(shape, dtype=np.int64), np.full(shape, np.nan), np.full((*shape, 6), np.nan)
    grids[0][row, column] = np.rint((stamp + 10.0) * 1e6).astype(np.int64)
    grids[1][row, column], grids[2][row, column] = true_u + du, body
    survey = Survey(
        number=np.arange(1, shape[0] + 1, dtype=np.int64),
        time_us=grids[0],
        u_px=grids[1],
        position_m=grids[2][..., :3],
        euler_rad=grids[2][..., 3:],
        covariance=np.broadcast_to(reported_covariance(_REPORTED), (*shape, 6, 6)),
        nav_gap_s=np.zeros(shape),
        origin_m=np.zeros(3),
    )
    hand_covariance = np.diag(np.repeat([settings.lever_sigma_m**2, settings.turn_sigma_rad**2], 3))
    return Flight(
        survey,
        camera,
        by_hand,
        hand_covariance,
        settings.line_period_s,
        pose,
        points,
        true_camera,
        wrong,
    )


def points_below(settings: FlightSettings, random: np.random.Generator) -> Floats:
    """Points on the ground (C, 3) below and beside the strips, more than are asked for."""
    ends = np.concatenate([strip.ends(settings.speed_m_s) for strip in settings.strips])
    margin = 0.2 * max(strip.height_m for strip in settings.strips)
    count = _MORE * settings.n_points + 200
    along = random.uniform(ends.min(axis=0) - margin, ends.max(axis=0) + margin, (count, 2))
    return np.column_stack([along, settings.relief_m * random.standard_normal(count)])


def thinned(seen: np.ndarray, most: int, random: np.random.Generator) -> np.ndarray:
    """At most so many strips a point, drawn among those that see it (N, M)."""
    rank = np.argsort(np.argsort(np.where(seen, random.random(seen.shape), 2.0), axis=0), axis=0)
    return seen & (rank < most)


def _bad_matches(
    wrong: np.ndarray, row: np.ndarray, column: np.ndarray, settings: FlightSettings, random: np.random.Generator
) -> tuple[Floats, Floats]:
    """How far measurements (L,) of wrong points lie off, along the line (px) and in time (s)."""
    n = len(row)
    off = random.uniform(-settings.wrong_px, settings.wrong_px, (2, n))
    hit = wrong[column] & (random.random(n) < 0.5)
    first = np.unique(column, return_index=True)[1]
    hit[first] |= wrong[column[first]]
    return off[0] * hit, off[1] * hit * settings.line_period_s

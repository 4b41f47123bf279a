"""Scan images by ray casting: the light that every pixel of every line collects from the board and the ground.

A pixel sees a square field of view, which the slit and the optics make wider than the pixels' spacing, while the body
moves on during the exposure. All of it is sampled on a grid of directions, at a few moments, and averaged. The grid
is turned, so that an edge of the print along the scan line or across it meets the samples one by one: on a straight
grid it would meet whole rows, and a slow pass would show an edge as a flight of stairs.
"""

from dataclasses import dataclass
from typing import Final

import numba
import numpy as np
from numpy.typing import NDArray

from linepose.arrays import Floats
from linepose.geometry import rotations
from linepose.geometry.camera import Camera, pixel_directions
from linepose.simulation import scene
from linepose.simulation.board import PRINT_CELL_M, print_of
from linepose.simulation.faults import missing
from linepose.simulation.projection import exact_projections
from linepose.simulation.settings import SimulationSettings
from linepose.simulation.trajectory import body_poses, schedule

_MOMENTS: Final = 2  # in an exposure, during which the body moves by a fraction of what a pixel sees


@dataclass(frozen=True)
class Exposure:
    """The noiseless scan of one observation: light (L, S) of L lines of S pixels, and the middle of each line (L,), s.

    Light is reflectance times the lighting's strength.
    """

    observation: int
    light: NDArray[np.float32]
    time_s: Floats


def line_times_s(camera: Camera, settings: SimulationSettings, observation: int) -> Floats:
    """Middles of the scan lines that show the board and a margin around it, within the pass; (L,) in s."""
    row = observation - 1
    times, crossings = schedule(settings), exact_projections(camera, settings).time_s[row]
    start, end = times.start_s[row], times.end_s[row]
    seen = crossings[np.isfinite(crossings)]
    if len(seen):
        margin = settings.image.margin_share * np.ptp(seen)
        start, end = max(start, seen.min() - margin), min(end, seen.max() + margin)
    n_lines = int(np.floor((end - start) * settings.image.line_rate_hz)) + 1
    return start + np.arange(n_lines) / settings.image.line_rate_hz


def line_of_time(camera: Camera, settings: SimulationSettings, observation: int, time_s: Floats) -> Floats:
    """Line number, whole at a line's middle, of survey times (...); (...)."""
    return (time_s - line_times_s(camera, settings, observation)[0]) * settings.image.line_rate_hz


def render(camera: Camera, settings: SimulationSettings, observation: int) -> Exposure:
    """The scan of one observation without noise, from its number counted from 1."""
    image = settings.image
    middles = line_times_s(camera, settings, observation)
    moments = _cell_centres(_MOMENTS) * image.exposure_share / image.line_rate_hz
    centres, matrices = _camera_in_board(settings, middles[:, None] + moments)
    sampled_u, sampled_v = _turned_grid(image.supersampling) * image.ifov_rad
    light = _collected_light(
        centres,
        matrices,
        *_sampled(camera, sampled_u, sampled_v),
        missing(settings)[observation - 1],
        print_of(settings.board),
        np.array([image.dark_reflectance, image.bright_reflectance]),
        np.array([image.ground_reflectance, image.ground_contrast, image.ground_grain_m]),
        image.backdrop_distance_m,
        np.array(image.lighting_gradient_per_m),
        settings.seed,
    )
    return Exposure(observation, light, middles)


def _cell_centres(n: int) -> Floats:
    """Centres of n equal cells of the interval from -1/2 to 1/2."""
    return (np.arange(n) + 0.5) / n - 0.5


def _turned_grid(n: int) -> Floats:
    """Samples of the unit square around 0, one in each of n x n cells, each alone in its row and column; (2, n^2)."""
    i, j = np.indices((n, n)).reshape(2, -1)
    return np.stack([i + (j + 0.5) / n, j + (n - i - 0.5) / n]) / n - 0.5


def _sampled(camera: Camera, sampled_u: Floats, sampled_v: Floats) -> tuple[Floats, Floats]:
    """Normalised x and y of each pixel's samples, which are off its centre by (n,) along and across; (S, n) twice."""
    pixels = np.arange(camera.n_pixels)[:, None] + sampled_u * camera.focal_length_px
    rays = pixel_directions(camera, pixels)
    return np.ascontiguousarray(rays[..., 0]), rays[..., 1] + sampled_v


def _camera_in_board(settings: SimulationSettings, time_s: Floats) -> tuple[Floats, Floats]:
    """Camera centres (..., 3) and matrices camera to board (..., 3, 3) in the board frame; times (...)."""
    pose = np.asarray(settings.true_pose)
    position, euler = body_poses(settings, time_s)
    body = rotations.matrix_from_euler(euler)
    from_world = rotations.matrix_from_euler(settings.board.euler_rad).T
    centres = (position + body @ pose[:3] - np.asarray(settings.board.position_m)) @ from_world.T
    return centres, from_world @ body @ rotations.matrix_from_rotation_vector(pose[3:])


@numba.njit(cache=True, parallel=True)
def _collected_light(
    centres: Floats,
    matrices: Floats,
    sampled_x: Floats,
    sampled_y: Floats,
    missing_points: NDArray[np.bool_],
    white: NDArray[np.bool_],
    sheet: Floats,
    ground: Floats,
    backdrop_m: float,
    gradient: Floats,
    seed: int,
) -> NDArray[np.float32]:
    """Mean light of each pixel; centres (L, T, 3), matrices (L, T, 3, 3), samples x and y (S, n) to (L, S)."""
    n_lines, n_moments = centres.shape[:2]
    n_pixels, n_samples = sampled_x.shape
    light = np.empty((n_lines, n_pixels), dtype=np.float32)
    for line in numba.prange(n_lines):
        for pixel in range(n_pixels):
            total = 0.0
            for moment in range(n_moments):
                c, m = centres[line, moment], matrices[line, moment]
                for k in range(n_samples):
                    x, y = sampled_x[pixel, k], sampled_y[pixel, k]
                    dx = m[0, 0] * x + m[0, 1] * y + m[0, 2]
                    dy = m[1, 0] * x + m[1, 1] * y + m[1, 2]
                    dz = m[2, 0] * x + m[2, 1] * y + m[2, 2]
                    total += _seen(c, dx, dy, dz, missing_points, white, sheet, ground, backdrop_m, gradient, seed)
            light[line, pixel] = total / (n_moments * n_samples)
    return light


@numba.njit(cache=True)
def _seen(
    centre: Floats,
    dx: float,
    dy: float,
    dz: float,
    missing_points: NDArray[np.bool_],
    white: NDArray[np.bool_],
    sheet: Floats,
    ground: Floats,
    backdrop_m: float,
    gradient: Floats,
    seed: int,
) -> float:
    """Light from where one ray first meets the sheet, or else the backdrop, a plane behind it."""
    if dz <= 0.0:
        return ground[0]
    depth = -centre[2] / dz
    x, y = centre[0] + depth * dx, centre[1] + depth * dy
    if len(white):
        row = int(np.floor(y / PRINT_CELL_M + 0.5 * white.shape[0]))
        column = int(np.floor(x / PRINT_CELL_M + 0.5 * white.shape[1]))
        is_seen = depth > 0.0 and 0 <= row < white.shape[0] and 0 <= column < white.shape[1]
    else:
        row = column = 0
        is_seen = depth > 0.0 and scene.on_sheet(x, y)
    if is_seen and len(white):
        reflectance = sheet[1] if white[row, column] else sheet[0]
    elif is_seen:
        if scene.covered(x, y, missing_points):
            reflectance = scene.ground_reflectance(x, y, ground[0], ground[1], ground[2], seed)
        else:
            reflectance = scene.sheet_reflectance(x, y, sheet[0], sheet[1])
    else:
        depth = (backdrop_m - centre[2]) / dz
        x, y = centre[0] + depth * dx, centre[1] + depth * dy
        reflectance = scene.ground_reflectance(x, y, ground[0], ground[1], ground[2], seed)
    return reflectance * max(0.1, 1.0 + gradient[0] * x + gradient[1] * y)

"""Scans from the air: the light that each pixel of each line collects from textured ground with relief."""

from dataclasses import dataclass
from typing import Final

import numba
import numpy as np
from numpy.typing import NDArray

from linepose.arrays import Floats
from linepose.geometry import rotations
from linepose.geometry.camera import Camera, pixel_directions
from linepose.simulation.flight_section import FlightSection
from linepose.simulation.strip_motion import StripMotion
from linepose.simulation.textured_ground import TexturedGround, down_at, reflectance_at, textured_ground

_MOTION: Final = 1  # streams of random numbers, so that one part does not move another
_SAMPLES: Final = 2  # along either side of what a pixel sees
_STEPS: Final = 4  # in which a ray finds the ground
_EXPOSURE: Final = 0.8  # of a line's period


@dataclass(frozen=True)
class TrueFlight:
    """Where the body truly goes, over which ground, and the camera's pose in it (6,)."""

    motion: StripMotion
    ground: TexturedGround
    pose: Floats
    line_rate_hz: float

    def line_times_s(self, strip: int) -> Floats:
        """Middles (L,) of the lines of a strip counted from 0, from the flight's start."""
        count = int(np.floor(self.motion.duration_s[strip] * self.line_rate_hz)) + 1
        return self.motion.start_s[strip] + np.arange(count) / self.line_rate_hz

    def body_poses(self, time_s: Floats) -> Floats:
        """Poses (K, 6) of the body at ascending times (K,): in strips, and on straight ways from one to the next."""
        start, end = self.motion.start_s, self.motion.start_s + self.motion.duration_s
        strips = np.arange(len(start))
        nearest = np.searchsorted((end[:-1] + start[1:]) / 2, time_s)
        pose = self.motion.body_poses(nearest, np.clip(time_s, start[nearest], end[nearest]))
        first, last = self.motion.body_poses(strips, start), self.motion.body_poses(strips, end)
        for turn in range(len(start) - 1):
            inside = (time_s > end[turn]) & (time_s < start[turn + 1])
            share = (time_s[inside] - end[turn]) / (start[turn + 1] - end[turn])
            way = first[turn + 1] - last[turn]
            way[5] = (way[5] + np.pi) % (2 * np.pi) - np.pi
            pose[inside] = last[turn] + share[:, None] * way
        return pose


def true_flight(section: FlightSection) -> TrueFlight:
    """The truth of a flight, the same for the same section."""
    random = np.random.default_rng([section.seed, _MOTION])
    motion = StripMotion.drawn([one.strip for one in section.strips], section.speed_m_s, section.turn_s, random)
    ground = textured_ground(section.ground, section.seed)
    return TrueFlight(motion, ground, section.true_pose, section.line_rate_hz)


def light_of_strip(camera: Camera, flight: TrueFlight, strip: int) -> NDArray[np.float32]:
    """The noiseless scan (L, P) of a strip counted from 0, as reflectances."""
    time_s = flight.line_times_s(strip)
    moments = (np.arange(_SAMPLES) + 0.5) / _SAMPLES - 0.5
    at_s = time_s[:, None] + _EXPOSURE / flight.line_rate_hz * moments
    body = flight.motion.body_poses(np.full(at_s.size, strip), at_s.ravel())
    matrix = rotations.matrix_from_euler(body[:, 3:])
    centre = body[:, :3] + matrix @ flight.pose[:3]
    matrix = matrix @ rotations.matrix_from_rotation_vector(flight.pose[3:])
    shape = at_s.shape
    rays = pixel_directions(camera, np.arange(camera.n_pixels)[:, None] + moments)
    ground = flight.ground
    return _collected(
        centre.reshape(*shape, 3),
        matrix.reshape(*shape, 3, 3),
        np.ascontiguousarray(rays[..., 0]),
        np.ascontiguousarray(rays[..., 1]),
        ground.waves,
        ground.grain_m,
        ground.contrast,
        ground.rows_m,
        ground.seed,
    )


@numba.njit(cache=True, parallel=True)
def _collected(
    centres: Floats,
    matrices: Floats,
    x: Floats,
    y: Floats,
    waves: Floats,
    grain_m: float,
    contrast: float,
    rows_m: float,
    seed: int,
) -> NDArray[np.float32]:
    """Mean light (L, P); centres (L, T, 3), matrices (L, T, 3, 3), x and y (P, S) of the samples' rays."""
    n_lines, n_moments = centres.shape[:2]
    n_pixels, n_samples = x.shape
    light = np.empty((n_lines, n_pixels), dtype=np.float32)
    for line in numba.prange(n_lines):
        down = 0.0
        for pixel in range(n_pixels):
            total = 0.0
            for moment in range(n_moments):
                c, m = centres[line, moment], matrices[line, moment]
                for k in range(n_samples):
                    north = m[0, 0] * x[pixel, k] + m[0, 1] * y[pixel, k] + m[0, 2]
                    east = m[1, 0] * x[pixel, k] + m[1, 1] * y[pixel, k] + m[1, 2]
                    ahead = m[2, 0] * x[pixel, k] + m[2, 1] * y[pixel, k] + m[2, 2]
                    if moment == 0 and k == 0:  # its samples lie so near that they share a height
                        for _ in range(_STEPS):
                            depth = (down - c[2]) / ahead
                            down = down_at(c[0] + depth * north, c[1] + depth * east, waves)
                    depth = (down - c[2]) / ahead
                    at_north, at_east = c[0] + depth * north, c[1] + depth * east
                    total += reflectance_at(at_north, at_east, grain_m, contrast, rows_m, seed)
            light[line, pixel] = total / (n_moments * n_samples)
    return light

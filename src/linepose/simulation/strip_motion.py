"""How the body moves along strips, and when it sees which point."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from linepose.arrays import Floats
from linepose.geometry import rotations
from linepose.geometry.camera import Camera, off_line, pixel_from_normalised
from linepose.simulation.flight_layouts import Strip

_SWINGS: Final = 3  # sinusoids on each axis
_PERIODS_S: Final = (5.0, 15.0)
# sigmas of north, east, down (m), roll, pitch, yaw (rad) of the body about its straight path
_AMPLITUDES: Final = np.array([0.2, 0.2, 0.2, *np.deg2rad([1.5, 1.5, 1.0])])
_ITERATIONS: Final = 8
_DIFFERENCE_S: Final = 1e-3  # for how fast a point moves across the line
_ON_THE_LINE: Final = 1e-6  # of the depth


@dataclass(frozen=True)
class StripMotion:
    """Straight strips one after the other, with swings of the body about each.

    middle_m (N, 3), velocity_m_s (N, 3), heading_rad (N,), start_s, duration_s (N,); amplitude, period_s, phase_rad
    (N, 6, S): of the swings.
    """

    middle_m: Floats
    velocity_m_s: Floats
    heading_rad: Floats
    start_s: Floats
    duration_s: Floats
    amplitude: Floats
    period_s: Floats
    phase_rad: Floats

    @classmethod
    def drawn(
        cls, strips: Sequence[Strip], speed_m_s: float, turn_s: float, random: np.random.Generator
    ) -> "StripMotion":
        """The motion along strips (N), with swings drawn."""
        heading = np.array([strip.heading_rad for strip in strips])
        duration = np.array([strip.duration_s for strip in strips])
        shape = (len(strips), 6, _SWINGS)
        return cls(
            np.array([[strip.north_m, strip.east_m, -strip.height_m] for strip in strips]),
            speed_m_s * np.column_stack([np.cos(heading), np.sin(heading), np.zeros(len(strips))]),
            heading,
            np.concatenate([[0.0], np.cumsum(duration + turn_s)[:-1]]),
            duration,
            np.sqrt(2 / _SWINGS) * _AMPLITUDES[:, None] * random.standard_normal(shape),
            random.uniform(*_PERIODS_S, shape),
            random.uniform(0.0, 2 * np.pi, shape),
        )

    def body_poses(self, strip: np.ndarray, time_s: Floats) -> Floats:
        """Poses (L, 6) of the body on strips (L,) at times (L,): north, east, down (m), roll, pitch, yaw (rad)."""
        since = time_s - self.start_s[strip]
        angle = 2 * np.pi * since[:, None, None] / self.period_s[strip] + self.phase_rad[strip]
        pose = np.einsum("lis,lis->li", self.amplitude[strip], np.sin(angle))
        pose[:, :3] += self.middle_m[strip] + (since - self.duration_s[strip] / 2)[:, None] * self.velocity_m_s[strip]
        pose[:, 5] += self.heading_rad[strip]
        return pose


def crossing_times(motion: StripMotion, camera: Camera, pose: Floats, points_m: Floats) -> tuple[Floats, Floats]:
    """When each strip's line crosses each point (s), and at which pixel; (N, M) twice, NaN where it does not.

    pose (6,): of the camera in the body; points_m (M, 3).
    """
    n, m = len(motion.start_s), len(points_m)
    strip = np.repeat(np.arange(n), m)
    points = np.tile(points_m, (n, 1))
    time_s = motion.start_s[strip] + motion.duration_s[strip] / 2

    def across(at_s: Floats) -> Floats:
        """How far points lie off what the line sees (m)."""
        return off_line(camera, _in_camera(motion.body_poses(strip, at_s), pose, points))

    for _ in range(_ITERATIONS):
        rate = (across(time_s + _DIFFERENCE_S) - across(time_s - _DIFFERENCE_S)) / (2 * _DIFFERENCE_S)
        time_s = time_s - across(time_s) / rate
    in_camera = _in_camera(motion.body_poses(strip, time_s), pose, points)
    u = pixel_from_normalised(camera, in_camera[:, 0] / in_camera[:, 2])
    since = time_s - motion.start_s[strip]
    seen = (in_camera[:, 2] > 0) & (np.abs(off_line(camera, in_camera)) < _ON_THE_LINE * in_camera[:, 2])
    seen &= (since >= 0) & (since <= motion.duration_s[strip]) & (u > 0) & (u < camera.n_pixels - 1)
    return np.where(seen, time_s, np.nan).reshape(n, m), np.where(seen, u, np.nan).reshape(n, m)


def _in_camera(body_pose: Floats, pose: Floats, points_m: Floats) -> Floats:
    """Points (L, 3) in the camera's axes, each at its own body pose (L, 6)."""
    body = rotations.matrix_from_euler(body_pose[:, 3:])
    in_body = np.einsum("lji,lj->li", body, points_m - body_pose[:, :3]) - pose[:3]
    return in_body @ rotations.matrix_from_rotation_vector(pose[3:])

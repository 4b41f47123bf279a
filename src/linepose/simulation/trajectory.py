"""Where the body truly is at any time of a simulated survey.

Every pass is an arc of constant speed and turn rate, so that straight drives and rotations on the spot are one law.
Between passes the body glides from the end of one to the start of the next. It rides on the ground: height, roll and
pitch follow the ground's height and slope, and a channel adds roll. Times are seconds from the survey's start.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from linepose.arrays import Floats
from linepose.simulation.settings import GroundSettings, SimulationSettings


@dataclass(frozen=True)
class Schedule:
    """When each pass starts, has its middle and ends, and how long the survey lasts; (N,) each, s."""

    start_s: Floats
    middle_s: Floats
    end_s: Floats
    survey_end_s: float


@lru_cache(maxsize=8)
def schedule(settings: SimulationSettings) -> Schedule:
    """The times of all passes: one after the other, a transfer before, between and after them."""
    duration = np.array([one.duration_s for one in settings.passes])
    start = settings.transfer_s * np.arange(1, len(duration) + 1) + np.concatenate([[0.0], np.cumsum(duration)[:-1]])
    end = start + duration
    return Schedule(start, start + duration / 2, end, float(end[-1] + settings.transfer_s))


def body_poses(settings: SimulationSettings, time_s: ArrayLike) -> tuple[Floats, Floats]:
    """True positions (m) and Euler angles (rad) of the body; times (...) to (..., 3) and (..., 3)."""
    time = np.asarray(time_s, dtype=float)
    north, east, heading, channel_roll = _on_map(settings, time)
    down, roll, pitch = _on_ground(settings.ground, north, east, heading)
    position = np.stack([north, east, down - settings.ground.body_height_m], axis=-1)
    return position, np.stack([roll + channel_roll, pitch, _wrapped(heading)], axis=-1)


def time_us(settings: SimulationSettings, time_s: ArrayLike) -> np.ndarray:
    """Time stamps (int64, microseconds) of survey times; same shape."""
    return settings.start_time_us + np.rint(np.asarray(time_s, dtype=float) * 1e6).astype(np.int64)


def _on_map(settings: SimulationSettings, time: Floats) -> tuple[Floats, Floats, Floats, Floats]:
    """North, east, heading and channel roll; in a transfer a smooth blend of where the two passes meet it."""
    times = schedule(settings)
    table = _pass_table(settings)
    after = np.searchsorted(times.start_s, time, side="right")  # passes that have begun
    last, following = np.clip(after - 1, 0, None), np.clip(after, None, len(table) - 1)
    in_pass = (after > 0) & (time <= times.end_s[last])
    begun, next_ = np.where(after > 0, last, 0), np.where(in_pass, last, following)
    leaving_s = np.where(after > 0, np.minimum(time, times.end_s[begun]), times.start_s[0])
    here = _arc(table[begun], leaving_s - times.middle_s[begun])
    there = _arc(table[next_], times.start_s[next_] - times.middle_s[next_])
    share = np.clip((time - times.end_s[begun]) / settings.transfer_s, 0.0, 1.0)
    share = np.where(in_pass | (after == 0) | (after == len(table)), 0.0, share * share * (3 - 2 * share))
    north, east = (a + share * (b - a) for a, b in zip(here[:2], there[:2], strict=True))
    heading = here[2] + share * _wrapped(there[2] - here[2])
    return north, east, heading, here[3] + share * (there[3] - here[3])


@lru_cache(maxsize=8)
def _pass_table(settings: SimulationSettings) -> Floats:
    return np.array(
        [
            [one.north_m, one.east_m, one.heading_rad, one.speed_m_s, one.turn_rate_rad_s, one.channel_roll_rad]
            for one in settings.passes
        ]
    )


def _arc(table: Floats, elapsed_s: Floats) -> tuple[Floats, Floats, Floats, Floats]:
    """North, east, heading and channel roll on arcs (..., 6), at times (...) from their middles."""
    north, east, heading, speed, turn_rate, roll = np.moveaxis(table, -1, 0)
    half_turn = turn_rate * elapsed_s / 2
    chord = speed * elapsed_s * np.sinc(half_turn / np.pi)
    along = heading + half_turn
    return north + chord * np.cos(along), east + chord * np.sin(along), heading + 2 * half_turn, roll


def _on_ground(ground: GroundSettings, north: Floats, east: Floats, heading: Floats) -> tuple[Floats, Floats, Floats]:
    """Down of the ground (m), and the roll and pitch (rad) of a body whose z axis is normal to it."""
    down, by_north, by_east = np.zeros_like(north), np.zeros_like(north), np.zeros_like(north)
    for wave in ground.waves:
        number = 2 * np.pi / wave.wavelength_m
        kn, ke = number * np.cos(wave.direction_rad), number * np.sin(wave.direction_rad)
        phase = kn * north + ke * east + wave.phase_rad
        down -= wave.amplitude_m * np.sin(phase)
        by_north -= wave.amplitude_m * kn * np.cos(phase)
        by_east -= wave.amplitude_m * ke * np.cos(phase)
    ahead = by_north * np.cos(heading) + by_east * np.sin(heading)
    right = -by_north * np.sin(heading) + by_east * np.cos(heading)
    return down, np.arcsin(right / np.sqrt(1 + ahead**2 + right**2)), -np.arctan(ahead)


def _wrapped(angle: Floats) -> Floats:
    return (angle + np.pi) % (2 * np.pi) - np.pi

"""A drive with a known pose, as its navigation system sees it: latitude, longitude, height, angles about true north."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.spatial.transform import Rotation

from unit.inputs import geodesy

ORIGIN = (-33.8892, 151.1937, 42.5)  # deg, deg, m
WEEK_1980_US = 604_800_000_000


@dataclass(frozen=True)
class Drive:
    """In the tangent plane at ORIGIN: time_us (K,), position_m (K, 3), euler_rad (K, 3), covariance (K, 6, 6)."""

    time_us: np.ndarray
    position_m: np.ndarray
    euler_rad: np.ndarray
    covariance: np.ndarray

    @cached_property
    def geodetic(self):
        """Latitude, longitude (deg), height (m); (K, 3)."""
        origin = np.array(ORIGIN)
        return geodesy.geodetic_of(geodesy.ecef(origin) + self.position_m @ geodesy.axes(origin).T)

    @cached_property
    def turn(self):
        """From the axes at ORIGIN to those at each place; (K, 3, 3)."""
        return np.swapaxes(geodesy.axes(self.geodetic), -1, -2) @ geodesy.axes(np.array(ORIGIN))

    @cached_property
    def true_matrix(self):
        """Body (x forward, y right, z down) to true north, east, down; (K, 3, 3)."""
        return self.turn @ Rotation.from_euler("ZYX", self.euler_rad[:, ::-1]).as_matrix()

    @cached_property
    def true_euler(self):
        """Roll, pitch, heading (rad) about true north; (K, 3)."""
        return Rotation.from_matrix(self.true_matrix).as_euler("ZYX")[:, ::-1]

    @cached_property
    def week(self):
        return self.gps_us // WEEK_1980_US

    @cached_property
    def second(self):
        return (self.gps_us % WEEK_1980_US) / 1e6

    @cached_property
    def gps_us(self):
        """GPS time since 1980-01-06: 17 leap seconds ahead of UTC from July 2015 to 2016, when the drive was."""
        return self.time_us - 315_964_800_000_000 + 17_000_000


def drive_of(table, covariance):
    """The drive of a log with the columns of our own table; the first place is near ORIGIN."""
    position = table[["north_m", "east_m", "down_m"]].to_numpy()
    position = position - position[0] + [3.0, -2.0, 1.0]
    euler = table[["roll_rad", "pitch_rad", "yaw_rad"]].to_numpy()
    matrices = np.broadcast_to(covariance, (len(table), 6, 6)).copy()
    return Drive(table["time_us"].to_numpy(), position, euler, matrices)

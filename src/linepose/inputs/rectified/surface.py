"""The plane that scans are rectified on, with axes along it."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from linepose.arrays import Floats


@dataclass(frozen=True)
class Surface:
    """A plane in the world by a point (3,) and two unit vectors along it (2, 3), at right angles.

    Seen from its front, the first runs to the right and the second down.
    """

    origin_m: Floats
    axes: Floats

    def from_world(self, points_m: ArrayLike) -> Floats:
        """Coordinates (..., 2) along the axes of world points (..., 3), in m."""
        return (np.asarray(points_m, dtype=float) - self.origin_m) @ self.axes.T

    def to_world(self, places_m: ArrayLike) -> Floats:
        """World points (..., 3) of coordinates (..., 2) along the axes."""
        return self.origin_m + np.asarray(places_m, dtype=float) @ self.axes


def flat_ground(down_m: float) -> Surface:
    """Level ground at this height of the world's down; the map has east to the right and south down."""
    return Surface(np.array([0.0, 0.0, down_m]), np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]]))

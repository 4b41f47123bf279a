"""A plane drawn flat: from above where it lies, from the front where it stands."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from linepose.arrays import Floats
from linepose.geometry.plane import Plane

_UPRIGHT = 0.5  # the normal's part along down, below which a plane stands rather than lies
_COMPASS = ("north", "north-east", "east", "south-east", "south", "south-west", "west", "north-west")


@dataclass(frozen=True)
class PlaneView:
    """Axes (3,) of the drawing in north, east, down, the point (3,) at its origin, and the axes' names with units."""

    origin_m: Floats
    rightwards: Floats
    upwards: Floats
    labels: tuple[str, str]

    def flat(self, points_m: ArrayLike) -> Floats:
        """Points (..., 3) as the drawing's coordinates (..., 2), m."""
        return (np.asarray(points_m, dtype=float) - self.origin_m) @ np.stack([self.rightwards, self.upwards], axis=-1)

    def flat_covariance(self, covariance: ArrayLike) -> Floats:
        """Covariances (..., 3, 3) in the drawing's coordinates (..., 2, 2)."""
        axes = np.stack([self.rightwards, self.upwards])
        return np.asarray(axes @ np.asarray(covariance, dtype=float) @ axes.T)


def plane_view(plane: Plane, viewer_m: ArrayLike) -> PlaneView:
    """The natural view: a map, north up, of a plane that lies; as seen from `viewer_m` (3,) of one that stands."""
    if abs(plane.normal[2]) >= _UPRIGHT:
        return PlaneView(
            plane.centre_m, np.array([0.0, 1.0, 0.0]), np.array([1.0, 0.0, 0.0]), ("East (m)", "North (m)")
        )
    down = np.array([0.0, 0.0, 1.0])
    upwards = down @ plane.normal * plane.normal - down
    upwards /= np.linalg.norm(upwards)
    towards = plane.normal * np.sign(plane.height_m(viewer_m) or 1.0)  # from the plane to the viewer
    rightwards = np.cross(upwards, towards)
    heading = float(np.arctan2(rightwards[1], rightwards[0]))
    name = _COMPASS[round(heading / (np.pi / 4)) % len(_COMPASS)]
    return PlaneView(plane.centre_m, rightwards, upwards, (f"Towards {name} (m)", "Up (m)"))

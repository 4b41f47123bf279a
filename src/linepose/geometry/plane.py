"""A plane in space: the best one through points, and where rays meet it."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from linepose.arrays import Floats
from linepose.errors import EstimationError

_COLLINEAR = 1e-9  # second largest spread of the points over their largest, below which no plane is defined


@dataclass(frozen=True)
class Plane:
    """All x with `normal . (x - centre_m) = 0`; normal (3,) of unit length with its third part (down) not negative."""

    centre_m: Floats
    normal: Floats

    def height_m(self, points_m: ArrayLike) -> Floats:
        """Signed distance of points (..., 3) from the plane, along the normal; (...)."""
        return np.asarray((np.asarray(points_m, dtype=float) - self.centre_m) @ self.normal)


def fit_plane(points_m: ArrayLike) -> Plane:
    """Plane of least squared distances from points (K, 3), rows with NaN left out: total least squares.

    The paper fits `down = a north + b east + c` (Eq. 26), which cannot hold a vertical plane; away from the vertical
    and for noise that is small beside the points' extent the two agree.
    Raises EstimationError for fewer than three points or points on a line.
    """
    points = np.asarray(points_m, dtype=float)
    points = points[np.all(np.isfinite(points), axis=1)]
    centre = points.mean(axis=0) if len(points) else np.full(3, np.nan)
    spread = np.linalg.svd(points - centre, compute_uv=False) if len(points) >= 3 else np.zeros(3)
    if spread[1] <= _COLLINEAR * spread[0]:
        raise EstimationError(
            f"plane: found {len(points)} points that span no plane, expected at least three that are not on one line; "
            "label more points of the pattern"
        )
    normal = np.linalg.svd(points - centre)[2][2]
    return Plane(centre, normal if normal[2] >= 0 else -normal)


def fit_plane_by_height(points_m: ArrayLike) -> Plane:
    """Plane `down = a north + b east + c` of least squared heights (Eq. 26), for comparison; points (K, 3)."""
    points = np.asarray(points_m, dtype=float)
    points = points[np.all(np.isfinite(points), axis=1)]
    centre = points.mean(axis=0)
    slopes = np.linalg.lstsq((points - centre)[:, :2], (points - centre)[:, 2], rcond=None)[0]
    normal = np.append(-slopes, 1.0)
    return Plane(centre, normal / np.linalg.norm(normal))


def intersect(plane: Plane, centres_m: ArrayLike, directions: ArrayLike) -> Floats:
    """Where rays `centre + t direction` meet the plane (Eq. 27); (..., 3) each to (..., 3).

    NaN where the plane lies behind the ray's centre or along the ray.
    """
    c, d = np.asarray(centres_m, dtype=float), np.asarray(directions, dtype=float)
    with np.errstate(divide="ignore", invalid="ignore"):
        along = -plane.height_m(c) / (d @ plane.normal)
    along = np.where(np.isfinite(along) & (along > 0), along, np.nan)
    return c + along[..., None] * d

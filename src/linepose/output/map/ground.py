"""The ground that rays meet: a plane, or a grid of heights."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.pipeline.calibration import INLIERS, Calibration
from linepose.pipeline.residual_tables import POINT_COVARIANCE_COLUMNS
from linepose.survey.observations import POSITION_COLUMNS, POSITION_COVARIANCE_INDICES

if TYPE_CHECKING:
    from linepose.config.map import MapSection
    from linepose.output.map.frame import SurveyMap

_FEWEST_POINTS: Final = 3
_FLATTEST: Final = 1e-3  # width of the points beside their length, below which they lie on a line
_SIGMA_M: Final = 0.05  # of a ground of which nothing is said
_NO_GRID: Final = np.zeros((1, 1), dtype=np.float32)


@dataclass(frozen=True, eq=False)
class Ground:
    """A plane `normal . X = offset` of places X north, east, down (m), or a grid of heights; `sigma_m` of its height.

    `normal` (3,) has -1 as its last number: it points up. `height_m` (H, W), where there is one, counts rows southwards
    and columns eastwards from the centre of the first cell at `corner_m` (north, east), `cell_m` apart (south, east);
    NaN is a hole.
    """

    sigma_m: float
    normal: Floats
    offset: float
    height_m: NDArray[np.float32] | None = None
    corner_m: tuple[float, float] = (0.0, 0.0)
    cell_m: tuple[float, float] = (1.0, 1.0)

    @property
    def extremes_m(self) -> Floats:
        """The lowest and the highest of the grid's heights (2,)."""
        return np.array([np.nanmin(self.grid), np.nanmax(self.grid)], dtype=float)

    @property
    def grid(self) -> NDArray[np.float32]:
        """The heights; one cell that means nothing where the ground is a plane."""
        return _NO_GRID if self.height_m is None else self.height_m


def flat_ground(height_m: float, sigma_m: float = _SIGMA_M) -> Ground:
    """A flat ground of this height."""
    return Ground(sigma_m, np.array([0.0, 0.0, -1.0]), height_m)


def plane_through(points_m: ArrayLike, sigma_m: float | None = None) -> Ground:
    """The plane through points north, east, down (K, 3) by least squares of their heights.

    `sigma_m` by default is the points' standard deviation about it. Raises InputError where points are too few, or on
    a line.
    """
    points = np.asarray(points_m, dtype=float)
    centre = points.mean(axis=0) if len(points) else np.zeros(3)
    across = np.linalg.svd(points[:, :2] - centre[:2], compute_uv=False) if len(points) else np.zeros(2)
    if len(points) < _FEWEST_POINTS or across[1] <= _FLATTEST * across[0]:
        found = f"{len(points)} points" + (" on a line" if len(points) >= _FEWEST_POINTS else "")
        raise InputError(
            "map.ground", found, "three or more points that span a plane", "write map: {ground: height, height_m: ...}"
        )
    design = np.column_stack([points[:, :2] - centre[:2], np.ones(len(points))])
    (by_north, by_east, down), *_ = np.linalg.lstsq(design, points[:, 2], rcond=None)
    left = points[:, 2] - design @ [by_north, by_east, down]
    free = len(points) - _FEWEST_POINTS
    spread = float(np.sqrt(np.sum(left**2) / free)) if free else _SIGMA_M
    normal = np.array([by_north, by_east, -1.0])
    offset = float(by_north * centre[0] + by_east * centre[1] - down)
    return Ground(spread if sigma_m is None else sigma_m, normal, offset)


def ground_of(calibration: Calibration, section: "MapSection", frame: "SurveyMap", folder: Path) -> Ground:
    """The ground that a platform's file asks for, `folder` being that of its data; raises InputError."""
    sigma_m, offset_m = section.sigma_ground_m, section.height_offset_m
    if section.height_m is not None:
        return flat_ground(section.height_m + offset_m, _SIGMA_M if sigma_m is None else sigma_m)
    if section.dem is not None:
        from linepose.output.map.elevation import read_elevation

        return read_elevation(folder / section.dem, frame, _SIGMA_M if sigma_m is None else sigma_m, offset_m)
    points = calibration.points
    points = points[points["stage"] == INLIERS]
    plane = plane_through(points[list(POSITION_COLUMNS)].to_numpy(), sigma_m)
    if sigma_m is not None:
        return plane
    down = list(POSITION_COVARIANCE_INDICES).index((2, 2))
    known = points[POINT_COVARIANCE_COLUMNS[down]].dropna()  # of many points none is told: their spread has it
    of_points_m = float(np.sqrt(known.mean())) if len(known) else 0.0
    of_pose_m = float(calibration.sigma[2])  # the points' heights were found by this camera, and err with its own
    return Ground(float(np.linalg.norm([plane.sigma_m, of_points_m, of_pose_m])), plane.normal, plane.offset)

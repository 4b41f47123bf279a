"""The ground from a height model: any raster that rasterio reads, on the survey's own axes."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.inputs.height_raster import read_heights
from linepose.inputs.local_frame import LocalFrame, geodetic_from_local, local_from_geodetic

if TYPE_CHECKING:
    from pyproj import Transformer

_STEP_M: Final = 0.5  # for the slope


@dataclass(frozen=True)
class Terrain:
    """Heights (H, W) of a raster, filled where there is none; missing (H, W): where that was.

    to_cell: (3, 3), from the raster's coordinates to column and row of a cell's centre; from_wgs84: longitude, latitude
    to the raster's coordinates; frame: the survey's axes, and origin_m (3,): where its positions count from.
    """

    heights_m: Floats
    missing: np.ndarray
    to_cell: Floats
    from_wgs84: "Transformer"
    frame: LocalFrame
    origin_m: Floats
    height_offset_m: float

    def __call__(self, north_east_m: Floats) -> tuple[Floats, Floats]:
        """Down (K,) from the survey's origin (m), and its slopes by north and east (K, 2), at places (K, 2)."""
        down_m = self._down(north_east_m)
        slopes = [
            (self._down(north_east_m + step) - self._down(north_east_m - step)) / (2 * _STEP_M)
            for step in _STEP_M * np.eye(2)
        ]
        return down_m, np.stack(slopes, axis=-1)

    def covers(self, north_east_m: Floats) -> np.ndarray:
        """Whether there are heights at places (K, 2)."""
        row, column = self._cells(north_east_m)
        height, width = self.heights_m.shape
        inside = (row > -0.5) & (row < height - 0.5) & (column > -0.5) & (column < width - 0.5)
        nearest = np.rint(row).astype(int).clip(0, height - 1), np.rint(column).astype(int).clip(0, width - 1)
        return np.asarray(inside & ~self.missing[nearest])

    def _down(self, north_east_m: Floats) -> Floats:
        from scipy.ndimage import map_coordinates

        height = map_coordinates(self.heights_m, self._cells(north_east_m), order=1, mode="nearest")
        at = np.column_stack([self._wgs84(north_east_m), height + self.height_offset_m])
        return np.asarray(local_from_geodetic(self.frame, at[:, [1, 0, 2]])[0][:, 2] - self.origin_m[2])

    def _wgs84(self, north_east_m: Floats) -> Floats:
        """Longitude and latitude (deg) of places (K, 2)."""
        here = np.column_stack([north_east_m + self.origin_m[:2], np.full(len(north_east_m), self.origin_m[2])])
        return geodetic_from_local(self.frame, here)[:, [1, 0]]

    def _cells(self, north_east_m: Floats) -> tuple[Floats, Floats]:
        """Rows and columns (K,) of places (K, 2)."""
        x, y = self.from_wgs84.transform(*self._wgs84(north_east_m).T)
        column, row, _ = self.to_cell @ np.stack([x, y, np.ones_like(x)])
        return row, column


def read_terrain(path: Path, frame: LocalFrame | None, origin_m: Floats, height_offset_m: float) -> Terrain:
    """The height model of a file; raises InputError for one that cannot be used."""
    from pyproj import Transformer
    from pyproj.exceptions import ProjError

    key = "points.ground.dem"
    if frame is None:
        raise InputError(key, str(path), "a survey whose place on the Earth is known", "add map_frame")
    raster = read_heights(path, key)
    if raster.crs is None:
        raise InputError(str(path), "no reference system", "one in the file", "add it with gdal_edit -a_srs")
    try:
        from_wgs84 = Transformer.from_crs("EPSG:4326", raster.crs, always_xy=True)
    except ProjError:
        raise InputError(str(path), "a system of no place on the Earth", "one of the Earth", "warp it") from None
    to_cell = np.array(~raster.transform, dtype=float).reshape(3, 3)
    to_cell[:2, 2] -= 0.5
    missing = np.isnan(raster.height_m)
    filled = _filled(raster.height_m.astype(float), missing)
    return Terrain(filled, missing, to_cell, from_wgs84, frame, origin_m, height_offset_m)


def _filled(heights: Floats, missing: np.ndarray) -> Floats:
    """The heights (H, W) with the nearest one where there is none."""
    from scipy.ndimage import distance_transform_edt

    if not missing.any():
        return heights
    nearest = distance_transform_edt(missing, return_distances=False, return_indices=True)
    return np.asarray(heights[tuple(nearest)])

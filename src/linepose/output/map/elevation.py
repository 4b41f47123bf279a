"""Elevation models: GeoTIFF files of heights in the survey's projected system."""

from pathlib import Path
from typing import Any, Final

import numpy as np

from linepose.errors import InputError
from linepose.output.map.frame import SurveyMap
from linepose.output.map.ground import Ground

_SMALLEST: Final = 2  # cells along either axis
_LARGEST_CELLS: Final = 400_000_000


def read_elevation(path: Path, frame: SurveyMap, sigma_m: float) -> Ground:
    """The heights of a GeoTIFF file; cells without a value are holes.

    Raises InputError where the file is missing, is no grid of heights, or lies in another system than the survey.
    """
    import rasterio
    from rasterio.errors import RasterioIOError

    if not path.is_file():
        raise InputError(str(path), "no such file", "an elevation model", "put it there, or correct map.dem")
    if frame.is_tangent:
        raise InputError(
            "map.dem",
            "a survey in north, east, down from an origin",
            "one in a projected system, as elevation models are",
            "write `ground: height`, or read the navigation log with `frame: projected`",
        )
    try:
        with rasterio.open(path) as file:
            _check(file, frame, path)
            heights = file.read(1, masked=True).astype(np.float32).filled(np.nan)
            transform = file.transform
    except RasterioIOError as error:
        raise InputError(str(path), " ".join(str(error).split()), "a GeoTIFF", "restore the file") from None
    heights[~np.isfinite(heights)] = np.nan
    if np.all(np.isnan(heights)):
        raise InputError(str(path), "no height in any cell", "an elevation model", "restore the file")
    south, east = -transform.e, transform.a
    corner = (transform.f - south / 2, transform.c + east / 2)
    return Ground(sigma_m, np.array([0.0, 0.0, -1.0]), 0.0, heights, corner, (south, east))


def _check(file: Any, frame: SurveyMap, path: Path) -> None:
    transform = file.transform
    if file.count != 1 or min(file.shape) < _SMALLEST or file.width * file.height > _LARGEST_CELLS:
        found = f"{file.count} bands of {file.width} x {file.height} cells"
        expected = f"one band of at least {_SMALLEST} x {_SMALLEST} and at most {_LARGEST_CELLS} cells"
        raise InputError(str(path), found, expected, "cut the survey's part of one band out of it")
    if transform.b or transform.d or transform.a <= 0 or transform.e >= 0:
        found = "rows that do not run from north to south, from west to east"
        raise InputError(str(path), found, "a model with north up", "warp it with gdalwarp")
    if frame.crs is None:
        if file.crs is not None:
            found = f"{file.crs}, of a survey in local coordinates"
            raise InputError(str(path), found, "the survey's own system", "say where it is: map_frame.crs")
        return
    from pyproj import CRS
    from pyproj.exceptions import CRSError

    try:
        same = file.crs is not None and CRS.from_user_input(file.crs).to_2d().equals(
            CRS.from_user_input(frame.crs).to_2d(), ignore_axis_order=True
        )
    except CRSError:
        same = False
    if not same:
        remedy = f"warp it: gdalwarp -t_srs {frame.crs} {path.name} OTHER.tif"
        raise InputError(str(path), str(file.crs or "no reference system"), f"{frame.crs}, as the survey", remedy)

"""Elevation models: GeoTIFF files of heights in the survey's projected system."""

from pathlib import Path

import numpy as np

from linepose.errors import InputError
from linepose.inputs.height_raster import HeightRaster, read_heights
from linepose.output.map.frame import SurveyMap
from linepose.output.map.ground import Ground


def read_elevation(path: Path, frame: SurveyMap, sigma_m: float, height_offset_m: float = 0.0) -> Ground:
    """The heights of a GeoTIFF file, the offset added to them; cells without a value are holes.

    Raises InputError where the file is missing, is no grid of heights, or lies in another system than the survey.
    """
    if frame.is_tangent:
        raise InputError(
            "map.dem",
            "a survey in north, east, down from an origin",
            "one in a projected system, as elevation models are",
            "write `ground: height`, or read the navigation log with `frame: projected`",
        )
    raster = read_heights(path, "map.dem")
    _check(raster, frame, path)
    south, east = -raster.transform.e, raster.transform.a
    corner = (raster.transform.f - south / 2, raster.transform.c + east / 2)
    heights_m = raster.height_m + np.float32(height_offset_m)
    return Ground(sigma_m, np.array([0.0, 0.0, -1.0]), 0.0, heights_m, corner, (south, east))


def _check(raster: HeightRaster, frame: SurveyMap, path: Path) -> None:
    transform = raster.transform
    if transform.b or transform.d or transform.a <= 0 or transform.e >= 0:
        found = "rows that do not run from north to south, from west to east"
        raise InputError(str(path), found, "a model with north up", "warp it with gdalwarp")
    if frame.crs is None:
        if raster.crs is not None:
            found = f"{raster.crs}, of a survey in local coordinates"
            raise InputError(str(path), found, "the survey's own system", "say where it is: map_frame.crs")
        return
    from pyproj import CRS
    from pyproj.exceptions import CRSError

    try:
        same = raster.crs is not None and CRS.from_user_input(raster.crs).to_2d().equals(
            CRS.from_user_input(frame.crs).to_2d(), ignore_axis_order=True
        )
    except CRSError:
        same = False
    if not same:
        remedy = f"warp it: gdalwarp -t_srs {frame.crs} {path.name} OTHER.tif"
        raise InputError(str(path), str(raster.crs or "no reference system"), f"{frame.crs}, as the survey", remedy)

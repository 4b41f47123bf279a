"""Mapped points as a GeoPackage in the survey's reference system, one layer a kind of point."""

import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Final

from linepose.pipeline.exports.format import ExportFormat
from linepose.pipeline.exports.options import ExportOptions

if TYPE_CHECKING:
    from linepose.pipeline.calibration import Calibration

_DATE: Final = "1970-01-01T00:00:00Z"  # the file's own date, so that the same points are the same bytes


def write_geopackage(calibration: "Calibration", options: ExportOptions, path: Path) -> None:  # noqa: ARG001
    """Write points of easting, northing, height; every column of a layer is an attribute too."""
    import geopandas
    import pyogrio

    from linepose.output.exports.points import MAP_COLUMNS, frame_of, mapped_points

    frame = frame_of(calibration)
    layers = mapped_points(calibration, frame)

    path.unlink(missing_ok=True)  # a file that is there is taken for a GeoPackage to add to
    pyogrio.set_gdal_config_options({"OGR_CURRENT_DATE": _DATE})
    try:
        for name, table in layers.items():
            points = geopandas.points_from_xy(*(table[column] for column in MAP_COLUMNS))
            frame_of_points = geopandas.GeoDataFrame(table, geometry=points, crs=frame.crs)
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", RuntimeWarning)  # of a name that does not end in .gpkg
                frame_of_points.to_file(path, layer=name, driver="GPKG", engine="pyogrio")
    finally:
        pyogrio.set_gdal_config_options({"OGR_CURRENT_DATE": None})


FORMAT: Final = ExportFormat("geopackage", "mapped points in the survey's reference system", ".gpkg", write_geopackage)

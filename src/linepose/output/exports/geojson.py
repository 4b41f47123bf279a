"""Mapped points as GeoJSON (RFC 7946): longitude, latitude and ellipsoidal height in WGS84."""

from pathlib import Path
from typing import TYPE_CHECKING, Final

from linepose.pipeline.exports.format import ExportFormat
from linepose.pipeline.exports.options import ExportOptions

if TYPE_CHECKING:
    from linepose.pipeline.calibration import Calibration


def write_geojson(calibration: "Calibration", options: ExportOptions, path: Path) -> None:  # noqa: ARG001
    """Write one feature a point; its properties say which layer it is of, and hold easting, northing, height, sigmas.

    Sigmas and covariances stay those of the survey's easting, northing and height, in metres.
    """
    import geopandas
    import pandas as pd

    from linepose.output.exports.points import MAP_COLUMNS, frame_of, mapped_points

    frame = frame_of(calibration)
    layers = mapped_points(calibration, frame)

    parts = [table.assign(layer=name, survey_crs=frame.name) for name, table in layers.items()]
    table = pd.concat(parts, ignore_index=True)
    table = table.astype({"observation": "Int64"})[
        ["layer", "observation", *table.columns.drop(["layer", "observation"])]
    ]
    longitude, latitude, height = frame.wgs84(table[list(MAP_COLUMNS)].to_numpy()).T
    points = geopandas.points_from_xy(longitude, latitude, height)
    collection = geopandas.GeoDataFrame(table, geometry=points, crs="EPSG:4326")
    path.write_text(collection.to_json(drop_id=True, na="drop", ensure_ascii=False) + "\n", encoding="utf-8")


FORMAT: Final = ExportFormat("geojson", "mapped points in WGS84", ".geojson", write_geojson)

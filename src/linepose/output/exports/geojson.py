"""Mapped points as GeoJSON (RFC 7946): longitude, latitude and ellipsoidal height in WGS84."""

from collections.abc import Mapping
from pathlib import Path

import pandas as pd

from linepose.output.exports.map_frame import MapFrame
from linepose.output.exports.points import MAP_COLUMNS


def write_geojson(layers: Mapping[str, pd.DataFrame], frame: MapFrame, path: Path) -> None:
    """Write one feature a point; its properties say which layer it is of, and hold easting, northing, height, sigmas.

    Sigmas and covariances stay those of the survey's easting, northing and height, in metres.
    """
    import geopandas

    parts = [table.assign(layer=name, survey_crs=frame.name) for name, table in layers.items()]
    table = pd.concat(parts, ignore_index=True)
    table = table.astype({"observation": "Int64"})[
        ["layer", "observation", *table.columns.drop(["layer", "observation"])]
    ]
    longitude, latitude, height = frame.wgs84(table[list(MAP_COLUMNS)].to_numpy()).T
    points = geopandas.points_from_xy(longitude, latitude, height)
    collection = geopandas.GeoDataFrame(table, geometry=points, crs="EPSG:4326")
    path.write_text(collection.to_json(drop_id=True, na="drop", ensure_ascii=False) + "\n", encoding="utf-8")

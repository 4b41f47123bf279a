"""The mapped points of a finished calibration in easting, northing and height, with their covariances."""

from dataclasses import replace
from typing import Final

import numpy as np
import pandas as pd

from linepose.errors import InputError
from linepose.experiments.mapping import MAPPING, PROJECTED_COLUMNS, PROJECTED_COVARIANCE_COLUMNS
from linepose.inputs.local_frame import GEODETIC, MAP_FRAME
from linepose.output.exports.map_frame import MapFrame, projected_map, tangent_map
from linepose.pipeline.calibration import INLIERS, Calibration
from linepose.pipeline.residual_tables import POINT_COVARIANCE_COLUMNS
from linepose.survey.observations import POSITION_COLUMNS, POSITION_COVARIANCE_INDICES
from linepose.tables import read_table

MAP_COLUMNS: Final = ("easting_m", "northing_m", "height_m")
_SHORT: Final = ("easting", "northing", "height")
MAP_COVARIANCE_COLUMNS: Final = tuple(f"covariance_{_SHORT[i]}_{_SHORT[j]}_m2" for i, j in POSITION_COVARIANCE_INDICES)
MAP_SIGMA_COLUMNS: Final = tuple(f"sigma_{name}" for name in MAP_COLUMNS)
PROJECTED_POSES: Final = ("calibrated", "hand_measured")


def frame_of(calibration: Calibration) -> MapFrame:
    """The map that a platform's points go to: what its file says, or its navigation log.

    Raises InputError where neither says where the survey lies.
    """
    results, place = calibration.results, f"{calibration.name}.yaml: map_frame"
    section = calibration.platform.map_frame if calibration.platform else None
    if section is not None and section.crs is not None:
        return projected_map(section.crs, f"{place}.crs")
    if section is not None and section.origin is not None:
        return replace(tangent_map(section.origin, f"{place}.origin"), key=f"{place}.origin")
    of_log = results.path("map_frame")
    recorded = read_table(of_log, MAP_FRAME) if of_log.is_file() else None
    if recorded is not None and len(recorded):
        row = recorded.iloc[0]
        if row["crs"] != GEODETIC:
            return projected_map(row["crs"], f"{of_log}: crs")
        origin = (float(row["latitude_deg"]), float(row["longitude_deg"]), float(row["height_m"]))
        return tangent_map(origin, str(of_log))
    raise InputError(
        place,
        "nothing",
        "where on the Earth north, east and down are",
        "add `map_frame: {crs: EPSG:...}` with their projected system, or its `origin` for local coordinates",
    )


def mapped_points(calibration: Calibration, frame: MapFrame) -> dict[str, pd.DataFrame]:
    """Layers of points: `estimated_points`, and `projected_POSE` for each pose of PROJECTED_POSES.

    Columns: point, of projections the observation too, then easting, northing, height (m), the sigma of each, and
    their covariances. Raises InputError where the mapping was not run, or another stage than the accepted is asked for.
    """
    results = calibration.results
    if calibration.stage != INLIERS:
        expected = f"{INLIERS}, whose pose points are mapped with"
        raise InputError(f"stage of {calibration.name}", repr(calibration.stage), expected, "leave the stage out")
    estimated = calibration.points
    if not results.has("mapping"):
        raise InputError(
            str(results.path("mapping")),
            "no such result",
            "that of the mapping experiment",
            f"run `linepose run {calibration.name}`, with `experiments.mapping` not null in its file",
        )
    projected = results.table("mapping", MAPPING).dropna()
    estimated = estimated[estimated["stage"] == INLIERS]
    layers = {"estimated_points": _on_map(estimated, POSITION_COLUMNS, POINT_COVARIANCE_COLUMNS, frame)}
    for pose in PROJECTED_POSES:
        table = projected[projected["pose"] == pose]
        layers[f"projected_{pose}"] = _on_map(table, PROJECTED_COLUMNS, PROJECTED_COVARIANCE_COLUMNS, frame)
    return layers


def _on_map(
    table: pd.DataFrame, position_columns: tuple[str, ...], covariance_columns: tuple[str, ...], frame: MapFrame
) -> pd.DataFrame:
    names = [name for name in ("observation", "point") if name in table]
    upper = table[list(covariance_columns)].to_numpy()
    covariance = np.zeros((len(table), 3, 3))
    for k, (i, j) in enumerate(POSITION_COVARIANCE_INDICES):
        covariance[:, i, j] = covariance[:, j, i] = upper[:, k]
    north_east_down = table[list(position_columns)].to_numpy()
    place, on_map = frame.places(north_east_down), frame.covariances(north_east_down, covariance)
    sigma = np.sqrt(np.maximum(np.diagonal(on_map, axis1=1, axis2=2), 0.0))
    columns = dict(zip(MAP_COLUMNS, place.T, strict=True)) | dict(zip(MAP_SIGMA_COLUMNS, sigma.T, strict=True))
    columns |= {
        key: on_map[:, i, j] for key, (i, j) in zip(MAP_COVARIANCE_COLUMNS, POSITION_COVARIANCE_INDICES, strict=True)
    }
    return table[names].reset_index(drop=True).assign(**columns)

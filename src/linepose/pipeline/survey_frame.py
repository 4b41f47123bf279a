"""Where a survey's north, east and down lie on the Earth: as the platform's file says, or its log."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pandas as pd

from linepose.config.map_frame import MapFrameSection
from linepose.config.platform import Platform
from linepose.inputs.local_frame import LocalFrame, projected_frame, tangent_frame
from linepose.inputs.navigation import read_navigation
from linepose.inputs.source import ScansSection


def survey_frame(section: Mapping[str, Any] | None, table: pd.DataFrame) -> LocalFrame | None:
    """Where north, east, down are on the Earth: as the platform's file says, or its log; None if neither does.

    section: `map_frame` of the file; table: of the log, columns as in `MAP_FRAME`.
    """
    if section is not None:
        said = MapFrameSection.model_validate(section)
        return tangent_frame(said.origin) if said.origin is not None else projected_frame(said.crs or "")
    if table.empty:
        return None
    row = table.iloc[0]
    if pd.isna(row["latitude_deg"]):
        return projected_frame(str(row["crs"]))
    return tangent_frame((float(row["latitude_deg"]), float(row["longitude_deg"]), float(row["height_m"])))


def map_frame_table(platform: Platform, folder: Path) -> pd.DataFrame:
    """Where the log says that north, east, down are; no row where it does not.

    A projected system, or EPSG:4979 and the origin of local coordinates: latitude, longitude (deg), height (m).
    Columns as in `MAP_FRAME`.
    """
    record = read_navigation(platform.source, folder) if isinstance(platform.source, ScansSection) else None
    columns = ["crs", "latitude_deg", "longitude_deg", "height_m"]
    if record is None or record.crs is None:
        return pd.DataFrame({name: pd.Series(dtype=str if name == "crs" else float) for name in columns})
    return pd.DataFrame([[record.crs, *(record.origin or (None, None, None))]], columns=columns)

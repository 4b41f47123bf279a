"""Control points: a table of names, coordinates in a reference system, and sigmas, one row a point.

    id, easting_m, northing_m, height_m, sigma_m

Coordinates: `easting_m, northing_m, height_m` of a projected system, `latitude_deg, longitude_deg, height_m` of a
geographic one, or `north_m, east_m, down_m` in the survey's own axes. Sigmas: `sigma_m` of all three, or
`sigma_horizontal_m` and `sigma_height_m`. A row without both horizontal coordinates is a height alone.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.inputs.local_frame import LocalFrame, local_from_geodetic
from linepose.inputs.number_files import check_cells, check_commas
from linepose.inputs.text_files import check_text
from linepose.survey.point_knowledge import PointKnowledge
from linepose.survey.point_names import WHAT, nameless

_OWN: Final = ("north_m", "east_m", "down_m")
_PROJECTED: Final = ("easting_m", "northing_m", "height_m")
_GEOGRAPHIC: Final = ("latitude_deg", "longitude_deg", "height_m")
_FARTHEST_M: Final = 1e8
_LEAST_SIGMA_M: Final = 1e-6
_REMEDY: Final = "correct points.control_points, or the file"


def read_control_points(
    path: Path, crs: str | None, frame: LocalFrame | None, height_offset_m: float = 0.0
) -> Mapping[str, PointKnowledge]:
    """What is known of points by their names, north, east, down as the survey has them.

    crs: of the coordinates, those of the survey's own axes if None; frame: where these lie; height_offset_m: added to
    heights. Raises InputError that names the row.
    """
    table = _table(path)
    columns = _OWN if crs is None else _coordinate_columns(table, path)
    values = {name: _numbers(table, name, path) for name in columns}
    horizontal, vertical = _sigmas(table, path)
    position = _positions(values, columns, crs, frame, path)
    position[:, 2] -= height_offset_m
    known = {}
    for row, name in enumerate(table["id"]):
        flat = np.isfinite(position[row, :2]).all()
        sigma = np.array([horizontal[row] if flat else np.inf] * 2 + [vertical[row]])
        far = not np.all(np.abs(position[row][np.isfinite(position[row])]) < _FARTHEST_M)
        if not np.isfinite(position[row, 2]) or far or not np.all(sigma >= _LEAST_SIGMA_M):
            found, expected = "a place or sigma that is none", f"a height, and sigmas of {_LEAST_SIGMA_M:g} m or more"
            raise InputError(f"{path}, row {row + 2}", found, expected, _REMEDY)
        known[name.strip()] = PointKnowledge(np.nan_to_num(position[row], nan=0.0), np.diag(sigma**-2.0))
    return known


def _table(path: Path) -> pd.DataFrame:
    if not path.is_file():
        raise InputError(str(path), "no such file", "a table of control points", _REMEDY)
    check_text(path, "a table of control points")
    check_commas(path)
    try:
        table = pd.read_csv(path, dtype=str, skipinitialspace=True, keep_default_na=False)
    except (UnicodeDecodeError, pd.errors.ParserError, pd.errors.EmptyDataError) as error:
        raise InputError(str(path), " ".join(str(error).split())[:80], "a CSV table with a header", _REMEDY) from None
    check_cells(table, path)
    table.columns = table.columns.str.strip()
    twice = [name for name in table.columns if f"{name}.1" in table.columns]
    if twice:
        raise InputError(str(path), f"column {twice[0]} twice", "each column once", "remove or rename one of them")
    if "id" not in table.columns or table.empty:
        found = f"columns {', '.join(table.columns[:6])}" if len(table) else "no row"
        raise InputError(str(path), found, "id, coordinates and sigmas, a row a point", _REMEDY)
    for row in nameless(table["id"])[:1]:
        raise InputError(f"{path}, row {row + 2}, id", repr(table["id"].iloc[row]), WHAT, "correct or remove the row")
    for row in np.flatnonzero(table["id"].str.strip().duplicated())[:1]:
        name = table["id"].iloc[row].strip()
        raise InputError(f"{path}, row {row + 2}", f"point {name} again", "each name once", "rename or remove one")
    return table


def _coordinate_columns(table: pd.DataFrame, path: Path) -> tuple[str, str, str]:
    for columns in (_PROJECTED, _GEOGRAPHIC):
        if set(columns) <= set(table.columns):
            return columns
    expected = f"{', '.join(_PROJECTED)} or {', '.join(_GEOGRAPHIC)}"
    raise InputError(str(path), f"columns {', '.join(table.columns)}", expected, _REMEDY)


def _numbers(table: pd.DataFrame, name: str, path: Path) -> Floats:
    """A column (R,), NaN where it is empty."""
    if name not in table.columns:
        raise InputError(
            str(path), f"no column {name}", f"{', '.join(_OWN)} without points.crs", "add it, or give points.crs"
        )
    texts = table[name].str.strip()
    numbers = pd.to_numeric(texts, errors="coerce").to_numpy(dtype=float)
    for row in np.flatnonzero(~np.isfinite(numbers) & (texts != "").to_numpy())[:1]:
        raise InputError(f"{path}, row {row + 2}, {name}", repr(texts.iloc[row]), "a number", "mend the cell")
    return np.asarray(numbers)


def _sigmas(table: pd.DataFrame, path: Path) -> tuple[Floats, Floats]:
    """Sigmas horizontally and of the height (R,) each."""
    if "sigma_m" in table.columns:
        both = _numbers(table, "sigma_m", path)
        return both, both
    if {"sigma_horizontal_m", "sigma_height_m"} <= set(table.columns):
        return _numbers(table, "sigma_horizontal_m", path), _numbers(table, "sigma_height_m", path)
    raise InputError(str(path), "no sigmas", "sigma_m, or sigma_horizontal_m and sigma_height_m", "add the columns")


def _positions(
    values: Mapping[str, Floats], columns: tuple[str, str, str], crs: str | None, frame: LocalFrame | None, path: Path
) -> Floats:
    """North, east, down (R, 3); NaN horizontally where a row has none."""
    first, second, third = (values[name] for name in columns)
    for row in np.flatnonzero(np.isfinite(first) != np.isfinite(second))[:1]:
        given, lacking = columns[:2] if np.isfinite(first[row]) else columns[1::-1]
        found = f"{given} without {lacking}"
        raise InputError(f"{path}, row {row + 2}", found, "both, or neither for a height alone", "complete the row")
    if crs is None:
        return np.column_stack([first, second, third])
    if frame is None:
        raise InputError(
            "points.crs", crs, "a survey whose place on the Earth is known", "add map_frame, or remove points.crs"
        )
    longitude, latitude = _geodetic(crs, columns, first, second, path)
    out = np.full((len(first), 3), np.nan)
    flat = np.isfinite(longitude) & np.isfinite(latitude)
    out[:, 2] = -third
    if np.any(flat):
        geodetic = np.column_stack([latitude, longitude, third])[flat]
        out[flat] = local_from_geodetic(frame, geodetic)[0]
    if frame.origin is not None:  # of a height alone too, which counts from the origin's
        out[~flat, 2] += frame.origin[2]
    return out


def _geodetic(
    crs: str, columns: tuple[str, str, str], first: Floats, second: Floats, path: Path
) -> tuple[Floats, Floats]:
    """Longitude and latitude (deg, WGS 84) of coordinates (R,) each."""
    from pyproj import CRS, Transformer
    from pyproj.exceptions import CRSError, ProjError

    try:
        system = CRS.from_user_input(crs)
    except CRSError:
        raise InputError("points.crs", repr(crs), "a code such as EPSG:32756", "correct it") from None
    if system.is_projected != (columns == _PROJECTED):
        expected = ", ".join(_PROJECTED if system.is_projected else _GEOGRAPHIC)
        raise InputError(str(path), f"{', '.join(columns)} with points.crs {crs}", expected, "correct one of them")
    east, north = (first, second) if columns == _PROJECTED else (second, first)
    try:
        longitude, latitude = Transformer.from_crs(system, "EPSG:4326", always_xy=True).transform(east, north)
    except ProjError:
        raise InputError("points.crs", crs, "a system of places on the Earth", "correct it") from None
    wrong = np.isfinite(east) & ~(np.isfinite(longitude) & np.isfinite(latitude))
    for row in np.flatnonzero(wrong)[:1]:
        place = f"{path}, row {row + 2}"
        raise InputError(place, f"{first[row]:g}, {second[row]:g}", f"coordinates of {crs}", "correct points.crs")
    return np.where(np.isfinite(longitude), longitude, np.nan), np.where(np.isfinite(latitude), latitude, np.nan)

"""Labelled views: CSV files, one a view of the pattern, each row a point with its pixel, time and body pose."""

import logging
from collections.abc import Sequence
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd
import pyarrow as pa

from linepose.errors import InputError, quoted
from linepose.inputs.number_files import check_microseconds, read_named_numbers
from linepose.inputs.patterns import matching
from linepose.survey.observations import EULER_COLUMNS, POINT_FIELDS, POSITION_COLUMNS
from linepose.survey.point_names import WHAT, in_words, nameless, point_name, point_names

POINTS: Final = pa.schema(POINT_FIELDS)
_NUMBERS: Final = ("u_px", *POSITION_COLUMNS, *EULER_COLUMNS)
_WHAT: Final = "time (us), point, u (px), north, east, down (m), roll, pitch, yaw (rad)"

log = logging.getLogger(__name__)


def select_views(folder: Path, pattern: str, first: int, step: int) -> list[Path]:
    """View files that match the pattern, sorted by name, every `step`-th from the `first` (counted from 1).

    Raises InputError where that leaves none.
    """
    found = matching(folder, pattern)
    paths = found[first - 1 :: step]
    if not paths:
        remedy = "correct source.views and source.first, or put the files there"
        raise InputError(str(folder / pattern), f"{len(found)} files", "one file a view", remedy)
    return paths


def read_labelled_views(paths: Sequence[Path], n_pixels: int) -> pd.DataFrame:
    """All points of all views, the views numbered from 1 in the given order; a point whose u is NaN is left out.

    Columns: observation, point, time_us, u_px, north_m, east_m, down_m, roll_rad, pitch_rad, yaw_rad.
    Raises InputError naming file, row and remedy for whatever cannot be used.
    """
    views = []
    last_us = np.int64(0)
    for number, path in enumerate(paths, start=1):
        view = _read_view(path, n_pixels)
        if view["time_us"].iloc[0] <= last_us:
            raise InputError(
                f"{path}, row {view.index[0] + 1}, column 1",
                f"time {view['time_us'].iloc[0]}",
                f"a time after the view before it ({last_us})",
                "name the files so that their order is that of time",
            )
        last_us = view["time_us"].max()
        views.append(view.assign(observation=number))
    table = pd.concat(views, ignore_index=True).assign(point=point_names([name for v in views for name in v["point"]]))
    return table.sort_values(["observation", "point"], ignore_index=True)[POINTS.names]


def _read_view(path: Path, n_pixels: int) -> pd.DataFrame:
    """Points of one view, ordered by time; the index counts the file's rows from 0."""
    time_us, names, numbers = read_named_numbers(path, 2 + len(_NUMBERS), _WHAT)
    check_microseconds(time_us, path)
    view = pd.DataFrame(numbers, columns=list(_NUMBERS)).assign(time_us=time_us)
    labelled = ~np.isnan(view["u_px"].to_numpy())
    if not labelled.all():
        missing = in_words(name for name, has_label in zip(names, labelled, strict=True) if not has_label)
        log.warning("%s: no label for point %s: left out", path, missing)
    for row in nameless(names):
        if labelled[row]:
            place, found = f"{path}, row {row + 1}, column 2", f"point {quoted(names[row])}"
            raise InputError(place, found, WHAT, "correct the point's id")
    for row in np.flatnonzero(labelled & _is_doubtful(view, n_pixels))[:1]:
        _check_row(view.iloc[row], f"{path}, row {row + 1}", n_pixels)
    view = view.assign(point=pd.Series([point_name(name) for name in names], dtype=object))[labelled]
    repeated = np.flatnonzero(view["point"].duplicated())
    if repeated.size:
        again = int(np.flatnonzero(labelled)[repeated[0]])
        point = view["point"].iloc[repeated[0]]
        raise InputError(
            f"{path}, row {again + 1}, column 2",
            f"point {point} again",
            "each point once a view",
            "remove one of the rows",
        )
    if view.empty:
        raise InputError(str(path), "no labelled point", "at least one", "leave the file out")
    return view.sort_values("time_us")


def _is_doubtful(view: pd.DataFrame, n_pixels: int) -> np.ndarray:
    """Rows (R,) that `_check_row` refuses."""
    u_px = view["u_px"].to_numpy()
    good = np.all(np.isfinite(view.to_numpy(dtype=float)), axis=1) & (u_px >= -0.5) & (u_px <= n_pixels - 0.5)
    good &= np.all(np.abs(view[list(EULER_COLUMNS)].to_numpy()) <= 2 * np.pi, axis=1)
    return np.asarray(~good)


def _check_row(row: pd.Series, place: str, n_pixels: int) -> None:
    if not np.all(np.isfinite(row.to_numpy(dtype=float))):
        name = row.index[~np.isfinite(row.to_numpy(dtype=float))][0]
        raise InputError(f"{place}, {name}", "no number", "a number in each cell of a labelled point", "mend the cell")
    if not -0.5 <= row["u_px"] <= n_pixels - 0.5:
        raise InputError(
            f"{place}, column 3",
            f"pixel {row['u_px']:g}",
            f"a pixel of the sensor, -0.5 to {n_pixels - 0.5:g}",
            "correct the label, or camera.n_pixels",
        )
    angles = row[list(EULER_COLUMNS)].to_numpy(dtype=float)
    if np.any(np.abs(angles) > 2 * np.pi):
        raise InputError(f"{place}, columns 7-9", f"angles {angles.tolist()}", "radians", "convert degrees to radians")

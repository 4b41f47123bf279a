"""The navigation system's raw log: the body pose over time, and which pose holds for a point."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.csv as pa_csv
import pyarrow.parquet as pq
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation, Slerp

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.geometry import rotations
from linepose.inputs.number_files import check_microseconds
from linepose.survey.observations import EULER_COLUMNS, POSITION_COLUMNS

_COLUMNS: Final = ("time_us", *POSITION_COLUMNS, *EULER_COLUMNS)
_FEWEST_ROWS: Final = 2


@dataclass(frozen=True)
class NavigationLog:
    """Body poses: time_us (K,) increasing, position_m (K, 3) north, east, down, euler_rad (K, 3) roll, pitch, yaw.

    `source` names where they come from, for messages.
    """

    time_us: NDArray[np.int64]
    position_m: Floats
    euler_rad: Floats
    source: str = "navigation"


PoseAt = Callable[[NavigationLog, NDArray[np.int64]], tuple[Floats, Floats]]


def read_navigation_log(path: Path) -> NavigationLog:
    """The log of a Parquet file, or a CSV file with a heading: time_us, north_m, east_m, down_m, roll_rad, ...

    Raises InputError naming the row of a time that does not increase or a value that is no number.
    """
    table = _read_columns(path)
    time_us = table["time_us"].to_numpy()
    check_microseconds(time_us, path)
    backwards = np.flatnonzero(np.diff(time_us) <= 0)
    if backwards.size:
        row = int(backwards[0]) + 1
        expected = f"a time after the row before it ({time_us[row - 1]})"
        raise InputError(f"{path}, row {row + 1}, time_us", f"time {time_us[row]}", expected, "sort the rows by time")
    position = np.stack([table[name].to_numpy() for name in POSITION_COLUMNS], axis=-1)
    euler = np.stack([table[name].to_numpy() for name in EULER_COLUMNS], axis=-1)
    _check_values(path, np.hstack([position, euler]))
    return NavigationLog(time_us, position, euler, str(path))


def _read_columns(path: Path) -> pa.Table:
    if not path.is_file():
        raise InputError(str(path), "no such file", "the navigation log", "restore it, or correct source.navigation")
    types = {name: pa.float64() for name in _COLUMNS} | {"time_us": pa.int64()}
    try:
        if path.suffix == ".parquet":
            table = pq.read_table(path)
        else:
            table = pa_csv.read_csv(path, convert_options=pa_csv.ConvertOptions(column_types=types))
        missing = [name for name in _COLUMNS if name not in table.column_names]
        if missing:
            expected = f"columns {', '.join(_COLUMNS)}"
            raise InputError(str(path), f"no column {', '.join(missing)}", expected, "name the columns so")
        table = table.select(list(_COLUMNS)).cast(pa.schema(list(types.items())))
    except (pa.ArrowException, UnicodeDecodeError) as error:
        found = " ".join(str(error).split())
        raise InputError(str(path), found, "Parquet, or CSV with a heading", "mend the file") from None
    if table.num_rows < _FEWEST_ROWS:
        raise InputError(str(path), f"{table.num_rows} rows", "two or more", "restore the log")
    return table


def _check_values(path: Path, values: Floats) -> None:
    broken = np.argwhere(~np.isfinite(values))
    if len(broken):
        row, column = broken[0]
        raise InputError(
            f"{path}, row {row + 1}, {_COLUMNS[1 + column]}", "no number", "a number in each row", "remove the row"
        )
    far = np.flatnonzero(np.any(np.abs(values[:, 3:]) > 2 * np.pi, axis=1))
    if far.size:
        place = f"{path}, row {far[0] + 1}, {EULER_COLUMNS[0]} to {EULER_COLUMNS[-1]}"
        raise InputError(place, f"angles {values[far[0], 3:].tolist()}", "radians", "convert degrees to radians")


def nearest_pose(log: NavigationLog, time_us: NDArray[np.int64]) -> tuple[Floats, Floats]:
    """Positions (P, 3) and Euler angles (P, 3) of the nearest time stamps, as the paper takes them (section 3.3)."""
    before, after = _neighbours(log, time_us)
    nearer = np.abs(log.time_us[after] - time_us) < np.abs(log.time_us[before] - time_us)
    index = np.where(nearer, after, before)
    return log.position_m[index], log.euler_rad[index]


def interpolated_pose(log: NavigationLog, time_us: NDArray[np.int64]) -> tuple[Floats, Floats]:
    """Positions (P, 3), linear between the two time stamps around, and Euler angles (P, 3), at constant turn rate."""
    before, after = _neighbours(log, time_us)
    share = (time_us - log.time_us[before]) / (log.time_us[after] - log.time_us[before])
    step = log.position_m[after] - log.position_m[before]
    needed, place = np.unique(np.concatenate([before, after]), return_inverse=True)
    keys = Rotation.from_matrix(rotations.matrix_from_euler(log.euler_rad[needed]))
    # in rows of the needed keys, because Slerp prepares every interval it is given
    at = place[: len(before)] + share * (place[len(before) :] - place[: len(before)])
    matrices = Slerp(np.arange(len(needed)), keys)(at).as_matrix()
    return log.position_m[before] + share[:, None] * step, rotations.euler_from_matrix(matrices)


POSE_AT: Final[dict[str, PoseAt]] = {"nearest": nearest_pose, "interpolate": interpolated_pose}


def _neighbours(log: NavigationLog, time_us: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Rows of the log before and after times (P,) within it."""
    after = np.searchsorted(log.time_us, time_us).clip(1, len(log.time_us) - 1)
    return after - 1, after


def associate_poses(points: pd.DataFrame, log: NavigationLog, pose_at: PoseAt, maximum_gap_s: float) -> pd.DataFrame:
    """The points with the body pose at their times: columns of position and Euler angles added.

    Raises InputError naming the log, and the observation outside it or in a gap of it longer than `maximum_gap_s`.
    """
    time_us = points["time_us"].to_numpy()
    outside = np.flatnonzero((time_us < log.time_us[0]) | (time_us > log.time_us[-1]))
    if outside.size:
        remedy = "complete the navigation log, or correct the clocks"
        expected = f"a time within the navigation log ({log.time_us[0]} to {log.time_us[-1]})"
        raise InputError(_place(log, points, outside[0]), f"time {time_us[outside[0]]}", expected, remedy)
    before, after = _neighbours(log, time_us)
    gap_s = (log.time_us[after] - log.time_us[before]) / 1e6
    if gap_s.max() > maximum_gap_s:
        worst = int(gap_s.argmax())
        raise InputError(
            _place(log, points, worst),
            f"a gap of {gap_s[worst]:.3f} s in the navigation log around its time",
            f"at most {maximum_gap_s:g} s",
            "complete the log, leave the observation out, or raise navigation.maximum_pose_gap_s",
        )
    position, euler = pose_at(log, time_us)
    columns = dict(zip((*POSITION_COLUMNS, *EULER_COLUMNS), np.hstack([position, euler]).T, strict=True))
    return points.assign(**columns)


def _place(log: NavigationLog, points: pd.DataFrame, row: int) -> str:
    point = points.iloc[row]
    return f"{log.source}: observation {point['observation']:g}, point {point['point']:g}"

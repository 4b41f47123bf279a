"""Navigation format `table`: CSV or Parquet, its columns named in the platform file."""

import re
from dataclasses import replace
from pathlib import Path
from typing import Final, Literal

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.csv as pa_csv
import pyarrow.parquet as pq
from numpy.typing import NDArray
from pydantic import Field, model_validator

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.geometry import rotations
from linepose.inputs import axes, gps_time
from linepose.inputs.local_frame import projected_frame, tangent_frame
from linepose.inputs.navigation.format import GeodeticSection, NavigationFormat
from linepose.inputs.navigation.record import Covariances, NavigationRecord, Poses, geodetic_record, local_record
from linepose.settings import Settings

_BRIEFLY: Final = 120
_PARQUET: Final = {".parquet", ".pq"}
_ENU_SIGMAS: Final = [1, 0, 2]  # standard deviations of east, north, up in the order north, east, down


Names = tuple[str, str, str]


class ColumnsSection(Settings):
    """Which column holds what; a file without a heading has the columns "1", "2", ..."""

    time: str = Field("time_us", description="Time, in `time_unit` and `time_scale`.")
    week: str | None = Field(None, description="GPS week, where the time is `gps_week` and not all is of one week.")
    position: Names = Field(
        ("north_m", "east_m", "down_m"), description="Position, in the order that `coordinates` says."
    )
    attitude: Names = Field(("roll_rad", "pitch_rad", "yaw_rad"), description="Roll, pitch, yaw.")
    sigma_position: Names | None = Field(
        None, description="One standard deviation (m) north, east, down; of `coordinates: enu` east, north, up."
    )
    sigma_attitude: Names | None = Field(
        None, description="One standard deviation of roll, pitch, yaw, in `angle_unit`; both sigmas or none."
    )


class TableSection(GeodeticSection):
    """Keys of the format `table`."""

    format: Literal["table"] = Field(description="`table`: CSV or Parquet with a column map.")
    columns: ColumnsSection = Field(ColumnsSection(), description="Which column holds what.")
    heading: bool = Field(True, description="Whether the first row of a CSV file names the columns.")
    delimiter: str = Field(",", description="What stands between the cells of a CSV file.", min_length=1, max_length=1)
    time_unit: Literal["s", "ms", "us", "ns"] = Field("us", description="Unit of the time, unless it is `iso`.")
    time_scale: Literal["unix", "iso", "gps", "gps_week"] = Field(
        "unix",
        description="`unix`: UTC since 1970; `iso`: UTC as text, 2026-05-01T12:00:00.25Z; `gps`: since 1980-01-06, "
        "leap seconds counted; `gps_week`: since the start of the GPS week.",
    )
    gps_week: int | None = Field(
        None, ge=0, description="The GPS week of the first row, for `gps_week`; if not given, that of the scans."
    )
    coordinates: Literal["ned", "enu", "geodetic"] = Field(
        "ned",
        description="Position as north, east, down (m), east, north, up (m), or latitude, longitude, ellipsoidal "
        "height (m).",
    )
    attitude_axes: Literal["ned", "enu"] = Field(
        "ned",
        description="Angles of a body x forward, y right, z down in north, east, down, or of x forward, y left, z up "
        "in east, north, up (ROS).",
    )
    angle_unit: Literal["degrees", "radians"] = Field("radians", description="Of roll, pitch, yaw and their sigmas.")
    latitude_unit: Literal["degrees", "radians"] = Field("degrees", description="Of latitude and longitude.")

    @model_validator(mode="after")
    def _has_both_sigmas(self) -> "TableSection":
        if (self.columns.sigma_position is None) != (self.columns.sigma_attitude is None):
            raise ValueError("columns.sigma_position and columns.sigma_attitude, or none of them")
        return self


def read(section: TableSection, folder: Path) -> NavigationRecord:
    """The record of the table's files; raises InputError naming a missing column or a broken row."""
    parts = [_read_file(path, section) for path in section.paths(folder)]
    poses, covariances = [part[0] for part in parts], [part[1] for part in parts]
    if section.coordinates == "geodetic":
        return geodetic_record(poses, covariances, section)
    frame = None if section.crs is None else projected_frame(section.crs)
    if section.origin is not None:
        frame = tangent_frame(section.origin)
    record = local_record(poses, covariances)
    return record if frame is None else replace(record, crs=frame.crs, origin=frame.origin)


FORMAT: Final = NavigationFormat("table", TableSection, read, has_covariances=False)


def _read_file(path: Path, section: TableSection) -> tuple[Poses, Covariances]:
    table = _Table(path, section)
    columns, time_us = section.columns, table.time_us()
    position, angles = table.numbers(columns.position), table.numbers(columns.attitude)
    to_rad = np.pi / 180 if section.angle_unit == "degrees" else 1.0
    euler = angles * to_rad
    if section.attitude_axes == "enu":
        euler = rotations.euler_from_matrix(axes.matrix_from_enu_flu(rotations.matrix_from_euler(euler)))
    if section.coordinates == "enu":
        position = axes.ned_from_enu(position)
    elif section.coordinates == "geodetic" and section.latitude_unit == "radians":
        position = position * [180 / np.pi, 180 / np.pi, 1.0]
    poses = Poses(time_us, position, euler, str(path))
    if columns.sigma_position is None or columns.sigma_attitude is None:
        return poses, Covariances(time_us[:0], np.empty((0, 6, 6)), str(path))
    sigma_position = table.numbers(columns.sigma_position)
    if section.coordinates == "enu":
        sigma_position = sigma_position[:, _ENU_SIGMAS]
    sigma = np.hstack([sigma_position, table.numbers(columns.sigma_attitude) * to_rad])
    return poses, Covariances(time_us, axes.diagonal_covariance(sigma), str(path))


class _Table:
    """The columns of one file; a fault is told with the file, the row and the column."""

    def __init__(self, path: Path, section: TableSection) -> None:
        self.path, self.section = path, section
        columns = section.columns
        triples = (columns.position, columns.attitude, columns.sigma_position, columns.sigma_attitude)
        wanted = [columns.time, *([columns.week] if columns.week else []), *(one for t in triples if t for one in t)]
        try:
            if path.suffix.lower() in _PARQUET:
                self.table = pq.read_table(path)
            else:
                self.table = _read_csv(path, section)
        except (pa.ArrowException, UnicodeDecodeError, OSError) as error:
            found = " ".join(str(error).split())
            raise InputError(str(path), found, "Parquet, or CSV with the same cells in each row", "mend it") from None
        missing = [name for name in wanted if name not in self.table.column_names]
        if missing:
            found = f"columns {', '.join(self.table.column_names)}"
            remedy = "correct source.navigation.columns"
            raise InputError(str(path), found, f"among them {', '.join(missing)}", remedy)

    def numbers(self, names: Names) -> Floats:
        """Columns (K, 3) as numbers."""
        return np.stack([self._column(name, pa.float64()) for name in names], axis=-1)

    def time_us(self) -> NDArray[np.int64]:
        """The times (K,) in Unix microseconds."""
        section, name = self.section, self.section.columns.time
        if section.time_scale == "iso":
            text = self._cast(name, pa.string())
            try:
                return np.asarray(pc.cast(text, pa.timestamp("us", "UTC")).cast(pa.int64()).to_numpy())
            except pa.ArrowException as error:
                found = _brief(error)
                expected = "UTC such as 2026-05-01T12:00:00.25Z"
                raise InputError(
                    f"{self.path}, {name}", found, expected, "correct source.navigation.time_scale"
                ) from None
        whole = pa.types.is_integer(self.table[name].type)
        times = self._column(name, pa.int64() if whole else pa.float64())
        if section.time_scale == "gps_week":
            return self._unix_from_week(gps_time.microseconds(times, section.time_unit))
        since_epoch = gps_time.microseconds(times, section.time_unit)
        return gps_time.unix_from_gps(since_epoch) if section.time_scale == "gps" else since_epoch

    def _unix_from_week(self, of_week_us: NDArray[np.int64]) -> NDArray[np.int64]:
        if self.section.columns.week:
            week = self._column(self.section.columns.week, pa.int64())
            return gps_time.unix_from_gps(week * gps_time.WEEK_US + of_week_us)
        return gps_time.unix_from_week_of_first(self.section.gps_week, of_week_us, str(self.path))

    def _column(self, name: str, kind: pa.DataType) -> np.ndarray:
        return np.asarray(self._cast(name, kind).to_numpy())

    def _cast(self, name: str, kind: pa.DataType) -> pa.ChunkedArray:
        column = self.table[name]
        if column.null_count:
            has_heading = self.section.heading and self.path.suffix.lower() not in _PARQUET
            row = int(pc.index(pc.is_null(column), True).as_py()) + 1 + has_heading
            raise InputError(f"{self.path}, row {row}, {name}", "an empty cell", "a value", "remove the row")
        try:
            return column.cast(kind)
        except pa.ArrowException as error:
            what = "text" if pa.types.is_string(kind) else "whole numbers" if pa.types.is_integer(kind) else "numbers"
            raise InputError(f"{self.path}, {name}", _brief(error), what, "mend the column") from None


def _brief(error: Exception) -> str:
    """The value that could not be read, where pyarrow names one, else its first words."""
    named = re.search(r"string: ('.*?') as", str(error))
    return named.group(1) if named else " ".join(str(error).split())[:_BRIEFLY]


def _read_csv(path: Path, section: TableSection) -> pa.Table:
    table = pa_csv.read_csv(
        path,
        read_options=pa_csv.ReadOptions(autogenerate_column_names=not section.heading),
        parse_options=pa_csv.ParseOptions(delimiter=section.delimiter),
        convert_options=pa_csv.ConvertOptions(
            timestamp_parsers=[],
            column_types={section.columns.time: pa.string()} if section.time_scale == "iso" else {},
        ),
    )
    names = [str(number + 1) for number in range(table.num_columns)] if not section.heading else table.column_names
    return table.rename_columns([name.strip() for name in names])

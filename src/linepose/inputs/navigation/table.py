"""Navigation format `table`: Parquet or text of any layout, its columns named in the platform file or by a preset."""

import datetime
import logging
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any, Final, Literal

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import NDArray
from pydantic import Field, model_validator
from scipy.spatial.transform import Rotation

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.geometry import rotations
from linepose.inputs import axes, gps_time
from linepose.inputs.local_frame import projected_frame, tangent_frame
from linepose.inputs.navigation import presets
from linepose.inputs.navigation.format import NavigationFormat
from linepose.inputs.navigation.record import Covariances, NavigationRecord, Poses, geodetic_record, local_record
from linepose.inputs.navigation.table_columns import Columns, Name, parts_of
from linepose.inputs.navigation.table_times import OF_DAY, OF_TEXT, TableScale, unix_from_day, unix_from_text
from linepose.inputs.navigation.text_file import TextSection, read_text
from linepose.settings import Settings

_PARQUET: Final = {".parquet", ".pq"}
_ENU_SIGMAS: Final = [1, 0, 2]  # standard deviations of east, north, up in the order north, east, down
_NOT_UNIT: Final = 1e-3

Names = tuple[Name, Name, Name]

log = logging.getLogger(__name__)


class ColumnsSection(Settings):
    """Which column holds what; a file without a heading has the columns "1", "2", ...

    A list of columns in the place of one is a value in several cells: a date and a time, or degrees, minutes, seconds.
    """

    time: Name = Field("time_us", description="Time, in `time_unit` and `time_scale`.")
    week: str | None = Field(None, description="GPS week, where the time is `gps_week` and not all is of one week.")
    position: Names = Field(
        ("north_m", "east_m", "down_m"), description="Position, in the order that `coordinates` says."
    )
    attitude: Names | tuple[Name, Name, Name, Name] = Field(
        ("roll_rad", "pitch_rad", "yaw_rad"), description="Roll, pitch, yaw; or a quaternion x, y, z, w."
    )
    sigma_position: Names | None = Field(
        None, description="One standard deviation (m) north, east, down; of `coordinates: enu` east, north, up."
    )
    sigma_attitude: Names | None = Field(
        None, description="One standard deviation of roll, pitch, yaw, in `angle_unit`; both sigmas or none."
    )

    def of_poses(self) -> list[Name]:
        """The columns that a pose is made of."""
        return [self.time, *([self.week] if self.week else []), *self.position, *self.attitude]

    def of_sigmas(self) -> list[Name]:
        """The columns of the standard deviations, if there are any."""
        return [*(self.sigma_position or ()), *(self.sigma_attitude or ())]


class TableSection(TextSection):
    """Keys of the format `table`."""

    format: Literal["table"] = Field(description="`table`: Parquet or text, with a preset or a column map.")
    preset: str | None = Field(
        None,
        description=f"Layout, columns and units of a known program, which other keys then change: {presets.NAMES}.",
    )
    columns: ColumnsSection = Field(ColumnsSection(), description="Which column holds what.")
    time_unit: Literal["s", "ms", "us", "ns"] = Field("us", description="Unit of the time, unless it is text.")
    time_scale: TableScale = Field(
        "unix",
        description="`unix`: UTC since 1970; `iso`: UTC as text, 2026-05-01T12:00:00.25Z; `gps`: since 1980-01-06, "
        "leap seconds counted; `gps_week`: since the start of the GPS week; `gps_iso`: GPS time as text; `day`, "
        "`gps_day`: since midnight, of UTC or GPS time.",
    )
    time_format: str | None = Field(
        None, description="Layout of a time as text, where it is not ISO 8601: `%d.%m.%Y %H:%M:%S.%f`."
    )
    gps_week: int | None = Field(
        None, ge=0, description="The GPS week of the first row, for `gps_week`; if not given, that of the scans."
    )
    date: datetime.date | None = Field(
        None, description="The day of the first row, for `day` and `gps_day`; if not given, that of the scans."
    )
    times: str | None = Field(
        None, description="File of the rows' times, one a line, where the log has none; its column is then `time`."
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
    latitude_unit: Literal["degrees", "radians", "dms"] = Field(
        "degrees", description="Of latitude and longitude; `dms`: degrees, minutes, seconds in one cell or three."
    )

    @model_validator(mode="before")
    @classmethod
    def _with_preset(cls, values: Any) -> Any:
        return presets.overlaid(values)

    @model_validator(mode="after")
    def _has_both_sigmas(self) -> "TableSection":
        if (self.columns.sigma_position is None) != (self.columns.sigma_attitude is None):
            raise ValueError("columns.sigma_position and columns.sigma_attitude, or none of them")
        return self

    def files(self, folder: Path) -> set[Path]:
        """Every file that is read."""
        return super().files(folder) | ({folder / self.times} if self.times else set())

    def lacking(self, folder: Path) -> Literal["gps_week", "date"] | None:  # noqa: ARG002
        """The week or the day, where the time counts from it and it is not given."""
        if self.time_scale == "gps_week" and self.gps_week is None and self.columns.week is None:
            return "gps_week"
        return "date" if self.time_scale in OF_DAY and self.date is None else None


def read(section: TableSection, folder: Path) -> NavigationRecord:
    """The record of the table's files; raises InputError naming a missing column or a broken row."""
    parts = [_read_part(one, section) for one in _tables(section, folder)]
    poses, covariances = [part[0] for part in parts], [part[1] for part in parts]
    if section.coordinates == "geodetic":
        return geodetic_record(poses, covariances, section)
    frame = None if section.crs is None else projected_frame(section.crs)
    if section.origin is not None:
        frame = tangent_frame(section.origin)
    record = local_record(poses, covariances)
    return record if frame is None else replace(record, crs=frame.crs, origin=frame.origin)


FORMAT: Final = NavigationFormat("table", TableSection, read, has_covariances=False, recognise=presets.recognised)


def _tables(section: TableSection, folder: Path) -> Iterator[Columns]:
    """The columns of each file; with a file of times, those of all files as one."""
    tables = (_columns(path, section) for path in section.paths(folder))
    if section.times is None:
        yield from tables
        return
    cells = pd.concat([one.cells for one in tables], ignore_index=True)
    path = folder / section.times
    if not path.is_file():
        raise InputError(
            str(path), "no such file", "the times of the rows", "restore it, or correct source.navigation.times"
        )
    times = path.read_text(encoding=section.encoding).split("\n")
    times = times[:-1] if not times[-1] else times
    if len(times) != len(cells):
        raise InputError(str(path), f"{len(times)} times", f"{len(cells)}, one a row of the log", "restore the files")
    yield Columns(path, cells.assign(time=times), 0)


def _columns(path: Path, section: TableSection) -> Columns:
    columns = section.columns
    apart = [name for name in columns.position[:2] if isinstance(name, str)] if section.latitude_unit == "dms" else []
    as_text = [*apart, *(part for name in _several(columns) for part in parts_of(name))]
    if section.time_scale in OF_TEXT:
        as_text += parts_of(columns.time)
    if path.suffix.lower() not in _PARQUET:
        used = [part for name in [*columns.of_poses(), *columns.of_sigmas()] for part in parts_of(name)]
        table = read_text(path, section, used, as_text, apart)
        return Columns(path, table.cells, table.first_line, table.names)
    try:
        return Columns(path, pq.read_table(path).to_pandas(timestamp_as_object=False), 0)
    except (pa.ArrowException, OSError) as error:
        raise InputError(str(path), " ".join(str(error).split()), "a Parquet file", "restore it") from None


def _several(columns: ColumnsSection) -> list[Name]:
    """Values in several cells, which are joined as text."""
    return [name for name in columns.of_poses() if not isinstance(name, str)]


def _in_three(columns: Columns, section: TableSection) -> ColumnsSection:
    """The column map, where latitude and longitude take three cells each with those cells."""

    def cells(name: Name) -> Name:
        return tuple(f"{name} {part}" for part in "dms") if f"{name} d" in columns.cells.columns else name

    latitude, longitude, height = section.columns.position
    return section.columns.model_copy(update={"position": (cells(latitude), cells(longitude), height)})


def _read_part(table: Columns, section: TableSection) -> tuple[Poses, Covariances]:
    columns = _in_three(table, section)
    table.check([*columns.of_poses(), *columns.of_sigmas()])
    kept, place = table.filled(columns.of_poses()), str(table.path)
    if not kept.all():
        told = "%s: %d of %d rows have no time, position or attitude and are left out"
        log.warning(told, place, np.count_nonzero(~kept), len(kept))
        table = table.rows(kept)
    time_us = _time_us(table, section, columns)
    euler = _euler(table, section, columns)
    position = _position(table, section, columns)
    poses = Poses(time_us, position, euler, place)
    if columns.sigma_position is None or columns.sigma_attitude is None:
        return poses, Covariances(time_us[:0], np.empty((0, 6, 6)), place)
    return poses, _covariances(table, section, columns, time_us)


def _covariances(
    table: Columns, section: TableSection, columns: ColumnsSection, time_us: NDArray[np.int64]
) -> Covariances:
    known = table.filled(columns.of_sigmas())
    if not known.all():
        log.warning("%s: %d rows have no standard deviations", table.path, np.count_nonzero(~known))
        table, time_us = table.rows(known), time_us[known]
    position, attitude = table.numbers(columns.sigma_position or ()), table.numbers(columns.sigma_attitude or ())
    if section.coordinates == "enu":
        position = position[:, _ENU_SIGMAS]
    sigma = np.hstack([position, attitude * _to_rad(section)])
    return Covariances(time_us, axes.diagonal_covariance(sigma), str(table.path))


def _to_rad(section: TableSection) -> float:
    return np.pi / 180 if section.angle_unit == "degrees" else 1.0


def _position(table: Columns, section: TableSection, columns: ColumnsSection) -> Floats:
    if section.coordinates == "geodetic" and section.latitude_unit == "dms":
        latitude, longitude, height = columns.position
        return np.stack(
            [table.degrees(latitude), table.degrees(longitude), table.number(height).astype(float)], axis=-1
        )
    position = table.numbers(columns.position)
    if section.coordinates == "enu":
        return axes.ned_from_enu(position)
    if section.coordinates == "geodetic" and section.latitude_unit == "radians":
        return position * [180 / np.pi, 180 / np.pi, 1.0]
    return position


def _euler(table: Columns, section: TableSection, columns: ColumnsSection) -> Floats:
    """Our roll, pitch, yaw (K, 3) of three angles or of a quaternion."""
    values = table.numbers(columns.attitude)
    if values.shape[1] == 3 and section.attitude_axes == "ned":
        return values * _to_rad(section)
    if values.shape[1] == 3:
        matrices = rotations.matrix_from_euler(values * _to_rad(section))
    else:
        for row in np.flatnonzero(~(np.abs(np.linalg.norm(values, axis=1) - 1) < _NOT_UNIT))[:1]:
            found = f"quaternion {', '.join(f'{one:g}' for one in values[row])}"
            place = table.place(row, " ".join(part for name in columns.attitude for part in parts_of(name)))
            raise InputError(place, found, "one of length 1 in the order x, y, z, w", "correct columns.attitude")
        matrices = Rotation.from_quat(values).as_matrix()
    return rotations.euler_from_matrix(
        matrices if section.attitude_axes == "ned" else axes.matrix_from_enu_flu(matrices)
    )


def _time_us(table: Columns, section: TableSection, columns: ColumnsSection) -> NDArray[np.int64]:
    """The times (K,) in Unix microseconds."""
    scale, place = section.time_scale, f"{table.path}, {' '.join(parts_of(columns.time))}"
    if scale in OF_TEXT:
        texts = (piece.text(columns.time) for piece in table.pieces())
        return np.concatenate([unix_from_text(text, scale, section.time_format, place) for text in texts])
    times = gps_time.microseconds(table.number(columns.time), section.time_unit)
    if scale in OF_DAY:
        return unix_from_day(times, section.date, scale, str(table.path))
    if scale == "gps_week" and columns.week:
        return gps_time.unix_from_gps(np.rint(table.number(columns.week)).astype(np.int64) * gps_time.WEEK_US + times)
    if scale == "gps_week":
        return gps_time.unix_from_week_of_first(section.gps_week, times, str(table.path))
    if scale == "gps" and len(times) and 0 <= times.max() < gps_time.WEEK_US:
        found, expected = f"times up to {times.max() / 1e6:g} s", "seconds since 1980"
        raise InputError(place, found, expected, "set source.navigation.time_scale to gps_week")
    return gps_time.unix_from_gps(times) if scale == "gps" else times

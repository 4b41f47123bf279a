"""Navigation format `table`: Parquet or text of any layout, its columns named in the platform file or by a preset."""

import logging
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any, Final, Literal

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from pydantic import Field, PositiveFloat, model_validator

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.inputs import axes
from linepose.inputs.local_frame import check_local, projected_frame, tangent_frame
from linepose.inputs.navigation import presets
from linepose.inputs.navigation.attitude_log import AttitudeSection, with_attitudes
from linepose.inputs.navigation.format import GeodeticSection, NavigationFormat
from linepose.inputs.navigation.named_columns import keys_by_names
from linepose.inputs.navigation.poses import Poses
from linepose.inputs.navigation.positions_between import DEFAULT_GAP_S
from linepose.inputs.navigation.preset_files import as_written, tell_heights, without_absent_sigmas
from linepose.inputs.navigation.record import Covariances, NavigationRecord, geodetic_record, local_record
from linepose.inputs.navigation.table_axes import keys_against
from linepose.inputs.navigation.table_columns import Columns, Name, Names, parts_of
from linepose.inputs.navigation.table_file import read_columns
from linepose.inputs.navigation.table_poses import TimedLayout, euler_of, time_us_of, to_rad, with_orientation
from linepose.inputs.navigation.table_times import OF_TEXT
from linepose.inputs.navigation.usable_rows import placed
from linepose.inputs.patterns import Files
from linepose.settings import Settings, SettingsError

_ENU_SIGMAS: Final = [1, 0, 2]  # standard deviations of east, north, up in the order north, east, down

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

    def of_sigmas(self) -> list[Name]:
        """The columns of the standard deviations, if there are any."""
        return [*(self.sigma_position or ()), *(self.sigma_attitude or ())]


class TableSection(TimedLayout, GeodeticSection):
    """Keys of the format `table`."""

    format: Literal["table"] = Field(description="`table`: Parquet or text, with a preset or a column map.")
    preset: str | None = Field(
        None,
        description=f"Layout, columns and units of a known program, which other keys then change: {presets.NAMES}.",
    )
    columns: ColumnsSection = Field(ColumnsSection(), description="Which column holds what.")
    attitude_log: AttitudeSection | None = Field(
        None, description="A second log that holds the attitudes, where this one holds positions alone."
    )
    maximum_fix_gap_s: PositiveFloat = Field(
        DEFAULT_GAP_S,
        description="Longest time between two positions over which they are interpolated to an attitude of the second "
        "log (s).",
    )
    times: Files | None = Field(
        None, description="File of the rows' times, one a line, where the log has none; its column is then `time`."
    )
    coordinates: Literal["ned", "enu", "geodetic"] = Field(
        "ned",
        description="Position as north, east, down (m), east, north, up (m), or latitude, longitude, ellipsoidal "
        "height (m).",
    )
    latitude_unit: Literal["degrees", "radians", "dms"] = Field(
        "degrees", description="Of latitude and longitude; `dms`: degrees, minutes, seconds in one cell or three."
    )

    @model_validator(mode="before")
    @classmethod
    def _with_preset(cls, values: Any) -> Any:
        return presets.overlaid(values)

    @model_validator(mode="after")
    def _has_both_sigmas(self) -> "TableSection":
        of_attitude = self.columns if self.attitude_log is None else self.attitude_log.columns
        if (self.columns.sigma_position is None) != (of_attitude.sigma_attitude is None):
            of_both = ["columns.sigma_position", "columns.sigma_attitude"]
            of_both[1] = of_both[1] if self.attitude_log is None else f"attitude_log.{of_both[1]}"
            given, lacks = of_both if of_attitude.sigma_attitude is None else of_both[::-1]
            raise SettingsError(f"{given} without {lacks}", "both, or none of them", f"add {lacks}")
        return self

    def of_poses(self) -> list[Name]:
        """The columns that a row must have."""
        columns = self.columns
        week = [columns.week] if columns.week else []
        return [columns.time, *week, *columns.position, *(() if self.attitude_log else columns.attitude)]

    def files(self, folder: Path) -> set[Path]:
        """Every file that is read."""
        attitudes = set() if self.attitude_log is None else set(self.attitude_log.files(folder))
        return super().files(folder) | attitudes | ({folder / self.times} if self.times else set())

    def lacking(self, folder: Path) -> Literal["gps_week", "date"] | None:
        """The week or the day, where a log's time counts from it and it is neither given nor in the log."""
        for path in self.paths(folder):
            of_file = as_written(path, self)
            mine = of_file.lacks(of_file.columns.week)
            if mine is not None:
                return mine
        other = self.attitude_log
        return other.lacks(other.columns.week) if other is not None else None


def read(section: TableSection, folder: Path) -> NavigationRecord:
    """The record of the table's files; raises InputError naming a missing column or a broken row."""
    if section.attitude_log is None:
        parts = [_read_part(*one) for one in _tables(section, folder)]
    else:
        parts = [_joined(section, section.attitude_log, folder)]
    poses, covariances = [part[0] for part in parts], [part[1] for part in parts]
    if section.coordinates == "geodetic":
        return geodetic_record(poses, covariances, section)
    frame = None if section.crs is None else projected_frame(section.crs)
    if section.origin is not None:
        frame = tangent_frame(section.origin)
    record = local_record(poses, covariances, section)
    if section.origin is not None:
        check_local(record.log.position_m, "source.navigation.origin", "source.navigation.crs")
    return record if frame is None else replace(record, crs=frame.crs, origin=frame.origin)


def _recognised(path: Path) -> dict[str, Any] | None:
    """The keys of a log by its preset, else by the names of its columns; None where neither tells them."""
    return presets.recognised(path) or keys_by_names(path)


FORMAT: Final = NavigationFormat(
    "table", TableSection, read, has_covariances=False, recognise=_recognised, keys_against=keys_against
)


def _tables(section: TableSection, folder: Path) -> Iterator[tuple[Columns, TableSection]]:
    """The columns of each file, and the section as it is for that file; with a file of times, those of all as one."""
    sections = [(path, as_written(path, section)) for path in section.paths(folder)]
    for path, _ in sections:
        tell_heights(path, section)
    tables = ((_columns(path, of_file), of_file) for path, of_file in sections)
    if section.times is None:
        yield from tables
        return
    cells = pd.concat([one.cells for one, _ in tables], ignore_index=True)
    path = folder / section.times
    if not path.is_file():
        raise InputError(
            str(path), "no such file", "the times of the rows", "restore it, or correct source.navigation.times"
        )
    try:
        times = path.read_text(encoding=section.encoding).split("\n")
    except UnicodeError:
        found, expected = f"bytes that are not {section.encoding}", "a time a row"
        raise InputError(str(path), found, expected, "restore it, or correct source.navigation.encoding") from None
    times = times[:-1] if not times[-1] else times
    if len(times) != len(cells):
        raise InputError(str(path), f"{len(times)} times", f"{len(cells)}, one a row of the log", "restore the files")
    yield Columns(path, cells.assign(time=times), 0, decimal=section.decimal), section


def _columns(path: Path, section: TableSection) -> Columns:
    columns = section.columns
    apart = [name for name in columns.position[:2] if isinstance(name, str)] if section.latitude_unit == "dms" else []
    several = [name for name in section.of_poses() if not isinstance(name, str)]
    in_three = [f"{name} {part}" for name in apart for part in "dms"]  # as text, for the sign of -0
    as_text = [*apart, *in_three, *(part for name in several for part in parts_of(name))]
    if section.time_scale in OF_TEXT:
        as_text += parts_of(columns.time)
    return read_columns(path, section, [*section.of_poses(), *columns.of_sigmas()], as_text, apart)


def _in_three(columns: Columns, section: TableSection) -> ColumnsSection:
    """The column map, where latitude and longitude take three cells each with those cells."""

    def cells(name: Name) -> Name:
        return tuple(f"{name} {part}" for part in "dms") if f"{name} d" in columns.cells.columns else name

    latitude, longitude, height = section.columns.position
    return section.columns.model_copy(update={"position": (cells(latitude), cells(longitude), height)})


def _joined(section: TableSection, of_attitudes: AttitudeSection, folder: Path) -> tuple[Poses, Covariances]:
    """Poses of this log's positions and the second log's attitudes, which takes the week and day that it lacks here."""
    given = {key: getattr(section, key) for key in ("gps_week", "date") if getattr(of_attitudes, key) is None}
    parts = [_fixes(*one) for one in _tables(section, folder)]
    time_us, position, sigma = (np.concatenate(values) for values in zip(*parts, strict=True))
    attitudes = of_attitudes.model_copy(update=given)
    place = str(folder / section.file)
    return with_attitudes((time_us, position, sigma), attitudes, folder, section.maximum_fix_gap_s, place)


def _fixes(table: Columns, section: TableSection) -> tuple[NDArray[np.int64], Floats, Floats]:
    """Times (F,), positions (F, 3) and standard deviations north, east, down (F, 3), NaN where there are none."""
    table, columns = _whole_rows(table, without_absent_sigmas(table.path, section, table.names))
    time_us = time_us_of(table, section, columns.time, columns.week)
    sigma = np.full((len(time_us), 3), np.nan)
    if columns.sigma_position is not None:
        sigma = table.numbers(columns.sigma_position)
        sigma = sigma[:, _ENU_SIGMAS] if section.coordinates == "enu" else sigma
    position = _position(table, section, columns)
    if section.coordinates != "geodetic":
        return time_us, position, sigma
    kept = placed(position, str(table.path))
    return time_us[kept], position[kept], sigma[kept]


def _whole_rows(table: Columns, section: TableSection) -> tuple[Columns, ColumnsSection]:
    """The rows with a value in each column that a pose needs, and the column map; how many others there are is told."""
    columns = _in_three(table, section)
    names = section.model_copy(update={"columns": columns}).of_poses()
    table.check([*names, *columns.of_sigmas()])
    kept = table.filled(names)
    if kept.all():
        return table, columns
    told = "%s: %d of %d rows have no time, position or attitude and are left out"
    log.warning(told, table.path, np.count_nonzero(~kept), len(kept))
    return table.rows(kept), columns


def _read_part(table: Columns, section: TableSection) -> tuple[Poses, Covariances]:
    table, columns = _whole_rows(table, without_absent_sigmas(table.path, section, table.names))
    table = with_orientation(table, columns.attitude)
    place = str(table.path)
    time_us = time_us_of(table, section, columns.time, columns.week)
    euler = euler_of(table, section, columns.attitude)
    position = _position(table, section, columns)
    poses = Poses(time_us, position, euler, place, records=table.cells.index.to_numpy() + 1)
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
    sigma = np.hstack([position, attitude * to_rad(section)])
    return Covariances(time_us, axes.diagonal_covariance(sigma), str(table.path))


def _position(table: Columns, section: TableSection, columns: ColumnsSection) -> Floats:
    if section.coordinates == "geodetic" and section.latitude_unit == "dms":
        latitude, longitude, height = columns.position
        return np.stack(
            [table.degrees(latitude), table.degrees(longitude), table.number(height).astype(float)], axis=-1
        )
    remedy = "set source.navigation.latitude_unit: dms" if section.coordinates == "geodetic" else ""
    position = table.numbers(columns.position, remedy)
    if section.coordinates == "enu":
        return axes.ned_from_enu(position)
    if section.coordinates == "geodetic" and section.latitude_unit == "radians":
        return position * [180 / np.pi, 180 / np.pi, 1.0]
    return position

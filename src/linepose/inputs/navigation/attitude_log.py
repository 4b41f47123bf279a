"""Attitudes of a second log beside a table of positions, such as an AHRS beside RTKLIB's .pos."""

import logging
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.inputs import axes
from linepose.inputs.navigation.poses import Poses, check_increasing
from linepose.inputs.navigation.positions_between import positions_between
from linepose.inputs.navigation.record import Covariances, nearest_rows
from linepose.inputs.navigation.table_columns import Columns, Name, Names, parts_of
from linepose.inputs.navigation.table_file import read_columns
from linepose.inputs.navigation.table_poses import TimedLayout, euler_of, time_us_of, to_rad, with_orientation
from linepose.inputs.navigation.table_times import OF_TEXT
from linepose.inputs.navigation.usable_rows import usable_rows
from linepose.inputs.patterns import Files, matching
from linepose.settings import Settings

log = logging.getLogger(__name__)


class AttitudeColumns(Settings):
    """Which column of the second log holds what."""

    time: Name = Field("time", description="Time, in `time_unit` and `time_scale` of this log.")
    week: str | None = Field(None, description="GPS week, where the time is `gps_week` and not all is of one week.")
    attitude: Names | tuple[Name, Name, Name, Name] = Field(
        ("roll", "pitch", "heading"), description="Roll, pitch, yaw; or a quaternion x, y, z, w."
    )
    sigma_attitude: Names | None = Field(
        None, description="One standard deviation of roll, pitch, yaw, in `angle_unit`; with columns.sigma_position."
    )


class AttitudeSection(TimedLayout):
    """Keys of the log of attitudes beside one of positions; those of its layout, clock and units are its own."""

    file: Files = Field(description="Log of attitudes below the data set's folder, or a pattern: Parquet or text.")
    columns: AttitudeColumns = Field(AttitudeColumns(), description="Which column holds what.")

    def files(self, folder: Path) -> list[Path]:
        """The logs, sorted by name."""
        return matching(folder, self.file)


def with_attitudes(
    fixes: tuple[NDArray[np.int64], Floats, Floats],
    section: AttitudeSection,
    folder: Path,
    maximum_gap_s: float,
    place: str,
) -> tuple[Poses, Covariances]:
    """Poses at the times of the attitudes; positions are linear between fixes at most `maximum_gap_s` apart.

    `fixes` are times (F,), positions (F, 3) and their standard deviations north, east, down (F, 3), NaN where unknown.
    Covariances stand at the times of the fixes.
    """
    fix_us, position, sigma_m = fixes
    rows = usable_rows(fix_us, position, place)
    fix_us, position, sigma_m = fix_us[rows], position[rows], sigma_m[rows]
    check_increasing(fix_us, place, rows + 1)
    attitude_us, euler, sigma_rad = _attitudes(section, folder)
    told = str(folder / section.file)
    if len(fix_us) < 2:
        raise InputError(place, f"{len(fix_us)} positions", "two or more", "restore the log")
    between = positions_between(attitude_us, fix_us, position, maximum_gap_s, told)
    near = between.near
    poses = Poses(attitude_us[near], between.position, euler[near], told, between.gap_key)
    row = nearest_rows(attitude_us[near], fix_us)
    sigma = np.hstack([sigma_m, sigma_rad[near][row]])
    known = np.all(np.isfinite(sigma), axis=1)
    return poses, Covariances(fix_us[known], axes.diagonal_covariance(sigma[known]), place)


def _attitudes(section: AttitudeSection, folder: Path) -> tuple[NDArray[np.int64], Floats, Floats]:
    """Times (A,), roll, pitch, yaw (A, 3) and their standard deviations (A, 3) in rad, in the order of time."""
    paths = section.files(folder)
    if not paths:
        remedy = "restore it, or correct source.navigation.attitude_log.file"
        raise InputError(str(folder / section.file), "no such file", "a log of attitudes", remedy)
    parts = [_read(path, section) for path in paths]
    time_us, euler, sigma = (np.concatenate(values) for values in zip(*parts, strict=True))
    place = str(folder / section.file)
    rows = usable_rows(time_us, euler, place)
    check_increasing(time_us[rows], place, rows + 1)
    return time_us[rows], euler[rows], sigma[rows]


def _read(path: Path, section: AttitudeSection) -> tuple[NDArray[np.int64], Floats, Floats]:
    columns = section.columns
    names = [columns.time, *([columns.week] if columns.week else []), *columns.attitude]
    sigmas = list(columns.sigma_attitude or ())
    as_text = [part for name in names if not isinstance(name, str) for part in name]
    if section.time_scale in OF_TEXT:
        as_text += parts_of(columns.time)
    table = read_columns(path, section, [*names, *sigmas], as_text)
    table.check([*names, *sigmas], "source.navigation.attitude_log.columns")
    table = with_orientation(_filled(table, names), columns.attitude)
    time_us = time_us_of(table, section, columns.time, columns.week)
    sigma = table.numbers(sigmas) * to_rad(section) if sigmas else np.full((len(time_us), 3), np.nan)
    return time_us, euler_of(table, section, columns.attitude), sigma


def _filled(table: Columns, names: list[Name]) -> Columns:
    kept = table.filled(names)
    if kept.all():
        return table
    log.warning("%s: %d of %d rows have no time or attitude and are left out", table.path, np.sum(~kept), len(kept))
    return table.rows(kept)

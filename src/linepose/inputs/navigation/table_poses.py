"""Times and attitudes of a table's rows, and the keys that say in which clock, axes and units they are."""

import datetime
import logging
from collections.abc import Sequence
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field
from scipy.spatial.transform import Rotation

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.geometry import rotations
from linepose.inputs import axes, gps_time
from linepose.inputs.navigation.table_columns import Columns, Name, parts_of
from linepose.inputs.navigation.table_times import OF_DAY, OF_TEXT, TableScale, unix_from_day, unix_from_text
from linepose.inputs.navigation.text_file import TextLayout

_NOT_UNIT: Final = 1e-3

log = logging.getLogger(__name__)


class TimedLayout(TextLayout):
    """Keys of clock, axes and units of a table."""

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
    attitude_axes: Literal["ned", "enu"] = Field(
        "ned",
        description="Angles of a body x forward, y right, z down in north, east, down, or of x forward, y left, z up "
        "in east, north, up (ROS).",
    )
    angle_unit: Literal["degrees", "radians"] = Field("radians", description="Of roll, pitch, yaw and their sigmas.")

    def lacks(self, week: str | None) -> Literal["gps_week", "date"] | None:
        """The week or the day, where the time counts from it and neither key nor the column `week` says it."""
        if self.time_scale == "gps_week" and self.gps_week is None and week is None:
            return "gps_week"
        return "date" if self.time_scale in OF_DAY and self.date is None else None


def to_rad(layout: TimedLayout) -> float:
    """Radians of one of the unit of the angles."""
    return np.pi / 180 if layout.angle_unit == "degrees" else 1.0


def euler_of(table: Columns, layout: TimedLayout, names: Sequence[Name]) -> Floats:
    """Our roll, pitch, yaw (K, 3) of three angles or of a quaternion."""
    values = table.numbers(names)
    for row, column in np.argwhere(np.isinf(values))[:1]:
        told = " ".join(parts_of(names[column]))
        raise InputError(table.place(row, told), f"{values[row, column]:g}", "an angle", "mend or remove the row")
    if values.shape[1] == 3 and layout.attitude_axes == "ned":
        return values * to_rad(layout)
    if values.shape[1] == 3:
        matrices = rotations.matrix_from_euler(values * to_rad(layout))
    else:
        for row in np.flatnonzero(~(np.abs(np.linalg.norm(values, axis=1) - 1) < _NOT_UNIT))[:1]:
            found = f"quaternion {', '.join(f'{one:g}' for one in values[row])}"
            place = table.place(row, " ".join(part for name in names for part in parts_of(name)))
            raise InputError(place, found, "one of length 1 in the order x, y, z, w", "correct columns.attitude")
        matrices = Rotation.from_quat(values).as_matrix()
    return rotations.euler_from_matrix(
        matrices if layout.attitude_axes == "ned" else axes.matrix_from_enu_flu(matrices)
    )


def with_orientation(table: Columns, names: Sequence[Name]) -> Columns:
    """The rows whose quaternion is not zero, as before the attitude is known; how many others there are is told."""
    if len(names) == 3:
        return table
    known = np.any(table.numbers(names) != 0, axis=1)
    if known.all() or not known.any():
        return table
    log.warning("%s: %d of %d rows with a quaternion of zeros are left out", table.path, np.sum(~known), len(known))
    return table.rows(known)


def time_us_of(table: Columns, layout: TimedLayout, time: Name, week: str | None) -> NDArray[np.int64]:
    """The times (K,) in Unix microseconds."""
    scale, place = layout.time_scale, f"{table.path}, {' '.join(parts_of(time))}"
    if scale in OF_TEXT:
        texts = (piece.text(time) for piece in table.pieces())
        return np.concatenate([unix_from_text(text, scale, layout.time_format, place) for text in texts])
    times = gps_time.microseconds(table.number(time), layout.time_unit, place, "time_unit")
    if scale in OF_DAY:
        return unix_from_day(times, layout.date, scale, str(table.path))
    if scale == "gps_week" and week:
        return gps_time.unix_from_week(table.number(week), times / 1e6, place)
    if scale == "gps_week":
        remedy = "correct time_unit or time_scale of the log"
        return gps_time.unix_from_week_of_first(layout.gps_week, times, str(table.path), remedy)
    if scale == "gps" and len(times) and 0 <= times.max() < gps_time.WEEK_US:
        found, expected = f"times up to {times.max() / 1e6:g} s", "seconds since 1980"
        raise InputError(place, found, expected, "set source.navigation.time_scale to gps_week")
    return gps_time.unix_from_gps(times) if scale == "gps" else times

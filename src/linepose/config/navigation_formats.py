"""The keys of `source.navigation`: a path of our own table, or one of the formats in linepose.inputs.navigation.

A format that another package brings is an entry point of the group `linepose.navigation_formats` (docs/formats.md).
"""

import difflib
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from importlib.metadata import entry_points
from pathlib import Path
from typing import Annotated, Any, Final, Literal

from pydantic import BeforeValidator, Discriminator, Field, PositiveFloat, Tag, WithJsonSchema, model_validator

from linepose.errors import InputError
from linepose.settings import Settings, validated

GROUP: Final = "linepose.navigation_formats"
Names = tuple[str, str, str]
TimeScale = Literal["gps", "unix"]


class NavigationFormatSection(Settings):
    """Keys of every navigation format; a format adds its own, and narrows `format` to its name."""

    format: str
    file: str = Field(
        description="Log below the data set's folder, or a pattern of logs (`run-*.gps`) that follow in time."
    )

    def paths(self, folder: Path) -> list[Path]:
        """The logs, sorted by name; raises InputError where there is none."""
        found = sorted(folder.glob(self.file))
        if not found:
            remedy = "restore it, or correct source.navigation.file"
            raise InputError(str(folder / self.file), "no such file", "a navigation log", remedy)
        return found

    def files(self, folder: Path) -> set[Path]:
        """Every file that is read; those of a log that is a folder one by one."""
        return with_contents(folder.glob(self.file))


class GeodeticSection(NavigationFormatSection):
    """Keys of the formats whose positions are latitude, longitude and ellipsoidal height (WGS 84)."""

    frame: Literal["tangent", "projected"] = Field(
        "tangent",
        description="Where positions are taken: in the plane that touches the Earth at `origin`, true in lengths, or "
        "in the projected `crs`.",
    )
    origin: tuple[float, float, float] | None = Field(
        None,
        description="Origin of the tangent plane: latitude, longitude (deg), ellipsoidal height (m); if not given, the "
        "log's first record.",
    )
    crs: str | None = Field(
        None, description="The projected CRS, as in EPSG:32633; if not given, the UTM zone of the log's first record."
    )


@dataclass(frozen=True)
class NavigationFormat:
    """A navigation format: its name, the model of its keys, and what reads the logs of a data set's folder.

    `read` takes the section and the folder and returns a linepose.inputs.navigation.NavigationRecord.
    """

    name: str
    section: type[NavigationFormatSection]
    read: Callable[[Any, Path], Any]


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


class NovatelSection(GeodeticSection):
    """Keys of the format `novatel`."""

    format: Literal["novatel"] = Field(description="`novatel`: ASCII or binary logs of a NovAtel receiver.")
    poses: Literal["INSPVA", "INSPVAX"] | None = Field(
        None, description="Messages that the poses are taken from; if not given, the kind that the log has most of."
    )


class SbetSection(GeodeticSection):
    """Keys of the format `sbet`."""

    format: Literal["sbet"] = Field(description="`sbet`: an SBET trajectory (Applanix, Inertial Explorer) and its RMS.")
    rms: str | None = Field(None, description="File of the trajectory's RMS (smrmsg), or a pattern, like `file`.")
    gps_week: int | None = Field(
        None, ge=0, description="The GPS week of the first record; if not given, that of the scans' first time stamp."
    )

    def files(self, folder: Path) -> set[Path]:
        """Every file that is read."""
        return super().files(folder) | (with_contents(folder.glob(self.rms)) if self.rms else set())


class RosbagSection(GeodeticSection):
    """Keys of the format `rosbag`."""

    format: Literal["rosbag"] = Field(description="`rosbag`: a ROS 1 or ROS 2 bag.")
    odometry_topic: str | None = Field(
        None, description="Topic of nav_msgs/Odometry; if not given, the bag's only one, if it has one."
    )
    fix_topic: str | None = Field(
        None, description="Topic of sensor_msgs/NavSatFix, where there is no odometry; if not given, the only one."
    )
    imu_topic: str | None = Field(
        None, description="Topic of sensor_msgs/Imu with orientation, for NavSatFix; if not given, the only one."
    )
    orientation_covariance: Literal["fixed_axes", "roll_pitch_yaw"] = Field(
        "fixed_axes",
        description="What a bag's covariance of the orientation is of: small turns about east, north, up (REP-103), or "
        "roll, pitch, yaw, as the NovAtel driver fills it in.",
    )
    maximum_fix_gap_s: PositiveFloat = Field(
        1.0, description="Longest time between two NavSatFix over which the position is interpolated (s)."
    )


class ResononSection(GeodeticSection):
    """Keys of the format `resonon`."""

    format: Literal["resonon"] = Field(description="`resonon`: location files (.lcf) of a Resonon airborne system.")
    time_scale: TimeScale = Field(
        "gps", description="Clock of the files: seconds since 1980-01-06 with leap seconds counted, or Unix time."
    )


SECTIONS: Final[dict[str, type[NavigationFormatSection]]] = {
    "table": TableSection,
    "novatel": NovatelSection,
    "sbet": SbetSection,
    "rosbag": RosbagSection,
    "resonon": ResononSection,
}


def plugin_format(name: str) -> NavigationFormat:
    """The format of this name that another package brings; raises InputError naming the nearest known one."""
    brought = {point.name: point for point in entry_points(group=GROUP)}
    if name not in brought:
        known = sorted({*SECTIONS, *brought})
        near = difflib.get_close_matches(name, known, n=1)
        remedy = f"did you mean {near[0]}?" if near else "correct it, or install the package that brings the format"
        raise InputError("source.navigation.format", repr(name), f"one of {', '.join(known)}", remedy)
    found = brought[name].load()
    if not isinstance(found, NavigationFormat) or found.name != name:
        place, expected = f"entry point {name} of {GROUP}", f"a NavigationFormat named {name}"
        raise InputError(place, repr(found)[:60], expected, "correct the package that brings it")
    return found


def with_contents(paths: Iterable[Path]) -> set[Path]:
    """The paths, and instead of each folder the files below it."""
    return {file for path in paths for file in (path.rglob("*") if path.is_dir() else [path]) if not file.is_dir()}


def _kind(value: Any) -> str:
    """Which model reads a value of `source.navigation`."""
    if not isinstance(value, Mapping | NavigationFormatSection):
        return "path"
    name = value.get("format") if isinstance(value, Mapping) else value.format
    return str(name) if name in SECTIONS else "brought"


def _brought_section(value: Any) -> NavigationFormatSection:
    if isinstance(value, NavigationFormatSection):
        return value
    if not isinstance(value.get("format"), str):
        expected = f"one of {', '.join(SECTIONS)}"
        raise InputError("source.navigation.format", repr(value.get("format")), expected, "add or correct it")
    try:
        return validated(plugin_format(value["format"]).section, value, "source.navigation")
    except InputError as error:
        place = error.place.replace("source.navigation: ", "source.navigation.")
        raise InputError(place, error.found, error.expected, error.remedy) from None


_BROUGHT_SCHEMA: Final = {
    "type": "object",
    "properties": {"format": {"type": "string", "not": {"enum": sorted(SECTIONS)}}},
    "required": ["format"],
}

# closed: an unknown key of any format is an error, also of one that another package brings
Navigation = Annotated[
    Annotated[str, Tag("path")]
    | Annotated[TableSection, Tag("table")]
    | Annotated[NovatelSection, Tag("novatel")]
    | Annotated[SbetSection, Tag("sbet")]
    | Annotated[RosbagSection, Tag("rosbag")]
    | Annotated[ResononSection, Tag("resonon")]
    | Annotated[Any, BeforeValidator(_brought_section), WithJsonSchema(_BROUGHT_SCHEMA), Tag("brought")],
    Discriminator(_kind),
]

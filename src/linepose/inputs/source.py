"""Where a platform's observations come from: views whose points were labelled, or scans and a raw log."""

import datetime
import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, Literal

from pydantic import Field, PositiveFloat, PositiveInt, field_validator, model_validator

from linepose.inputs.navigation.registry import Navigation
from linepose.inputs.patterns import Dataset, Files, in_any_case, matching
from linepose.inputs.scans.envi_header import data_files
from linepose.inputs.tie_points.settings import MatchingSection
from linepose.settings import Settings


class LabelledViewsSection(Settings):
    """Labelled points that already carry the body pose: CSV files, one a view of the pattern."""

    kind: Literal["labelled_views"] = Field(description="Points labelled by hand, one CSV file a view.")
    dataset: Dataset = Field(description="Data set, as named in the study's configuration.")
    views: Files = Field("labelled_points/*.csv", description="View files below the data set's folder, sorted by name.")
    first: PositiveInt = Field(1, description="The first view file that is used (counted from 1).")
    step: PositiveInt = Field(1, description="Every how many-th view file is used.")
    covariances: Files = Field("nav_covs.csv", description="File of the navigation covariances: time (us), 12x12.")

    def files(self, folder: Path) -> set[Path]:
        """Every file that is read, of a data set in this folder."""
        return {*matching(folder, self.views), folder / self.covariances}


class ScansSection(Settings):
    """Scan images with a time stamp for each line, and the navigation system's raw log."""

    kind: Literal["scans"] = Field(description="Scan images, one a view of the pattern.")
    dataset: Dataset | None = Field(
        None, description="Data set, as named in the study's configuration; none where the platform is simulated."
    )
    scans: Files = Field(
        "scans/*.hdr",
        description="Scans (ENVI headers, PNG, TIFF, JPEG) in the order of the observations, their time stamps beside.",
    )
    time_stamps: Literal["csv", "resonon", "headwall", "specim", "hyspex", "novatel", "rate"] = Field(
        "csv",
        description="Time stamps of a scan's lines: NAME-times.csv (us since 1970), Resonon's NAME.times and NAME.lcf, "
        "Headwall's frameIndex_N.txt beside raw_N, Specim's NAME.nav, the last column of HySpex's NAME.txt, events in "
        "the log of a NovAtel receiver (NAME.gps), or a start and a `rate`.",
    )
    time_file: str | None = Field(
        None,
        description="File of a scan's time stamps beside it under another name, for csv, headwall, hyspex and novatel: "
        "`{name}` is the scan's name without ending (`{name}_frames.txt`).",
    )
    line_rate_hz: PositiveFloat | None = Field(
        None, description="Lines a second, for `rate`; if not given, fps or framerate of the scan's header."
    )
    start_times: dict[str, datetime.datetime] = Field(
        {},
        description="Time of the first line by the scan's name, for `rate` (`run-01: 2026-05-01T12:00:00.25Z`); if not "
        "given, that of the scan's header.",
    )
    gps_week: int | None = Field(
        None, ge=0, description="The GPS week of the scans, for hyspex; if not given, that of the header's date."
    )
    event: str | None = Field(
        None, description="The receiver's message, for novatel (`MARK2TIME`); if not given, the only one in the log."
    )
    time_scale: Literal["unix", "gps"] | None = Field(
        None,
        description="Clock of the time stamps: Unix time, or since 1980-01-06 with leap seconds counted; if not given, "
        "gps for resonon and unix for the others.",
    )
    time_offset_s: float = Field(
        0.0,
        ge=-1e10,
        le=1e10,
        allow_inf_nan=False,
        description="Seconds that are added to the time stamps of the scans, where their clock differs from that of "
        "the navigation.",
    )
    left_out: tuple[PositiveInt, ...] = Field((), description="Numbers of observations that are not used.")
    points: Literal["labels", "detection", "matching"] = Field(
        "labels",
        description="Points from approximate labels, those of the pattern found without any, or tie points matched "
        "between strips that overlap.",
    )
    matching: MatchingSection = Field(
        MatchingSection(), description="How tie points are matched, for `points: matching`."
    )
    target_range_m: PositiveFloat | None = Field(
        None,
        description="From the camera to the target (m), to a quarter or so: where a chessboard, dots or markers are "
        "sought in rectified scans; if not given, several distances are tried.",
    )
    labels: Files = Field(
        "labels.csv",
        description="Labels: CSV (observation, point, u_px, line), CVAT for images 1.1 (.xml), LabelMe (a pattern "
        "of .json files, one a scan), COCO keypoints, Label Studio or VIA 2 (.json, VIA also .csv).",
    )
    point_id: str | None = Field(
        None,
        description="Where labels hold the point's name: `label`, `group_id` (LabelMe), or the name of an attribute; "
        "if not given, group_id or an attribute id, point or point_id, else the label.",
    )
    refinement: Literal["centroid", "peak", "none"] = Field(
        "centroid",
        description="Centre of a dot: intensity-weighted mean, or the enlarged patch's peak as in the paper; none: the "
        "place as it was labelled, of points that are no dots.",
    )
    navigation: Navigation = Field(
        "navigation.parquet",
        description="Raw navigation log: path of Parquet or CSV with time_us, north_m, ..., yaw_rad, or a format with "
        "its keys.",
    )
    covariances: Files | None = Field(
        None,
        description="File of the navigation covariances: time (us), 12x12. If not given, covariances.csv beside a log "
        "that is named by its path, else those in the log.",
    )

    @field_validator("time_file")
    @classmethod
    def _names_the_scan_alone(cls, time_file: str | None) -> str | None:
        if time_file is not None and re.search(r"[{}]", time_file.replace("{name}", "")):
            raise ValueError("a file's name in which {name} alone stands in braces, such as {name}_frames.txt")
        return time_file

    def time_path(self, scan: Path, usual: str) -> Path:
        """The file of a scan's time stamps: of the name that `time_file` gives, else of the usual one."""
        return in_any_case(scan.parent / (self.time_file or usual).replace("{name}", scan.stem))

    @field_validator("start_times", mode="before")
    @classmethod
    def _have_a_time_of_the_day(cls, starts: Any) -> Any:
        days = [name for name, start in starts.items() if _is_day(start)] if isinstance(starts, Mapping) else []
        if days:
            raise ValueError(f"a date and time, not the day alone, for {days[0]} (2026-05-01T12:00:00.25Z)")
        return starts

    @model_validator(mode="before")
    @classmethod
    def _of_our_own_table(cls, values: Any) -> Any:
        own = isinstance(values, Mapping) and isinstance(values.get("navigation", ""), str)
        return {"covariances": "covariances.csv", **values} if own else values

    def files(self, folder: Path) -> set[Path]:
        """Every file that is read, of a data set in this folder."""
        scans = matching(folder, self.scans)
        beside = set(_beside(scans))
        named = {"resonon": r".*\.(times|lcf)", "headwall": r"frameindex_.*\.txt"}.get(self.time_stamps)
        if named:
            folders = {scan.parent for scan in scans}
            beside |= {one for folder in folders for one in folder.iterdir() if re.fullmatch(named, one.name.lower())}
        beside |= {self.time_path(scan, "{name}-times.csv") for scan in scans}
        beside |= {scan.parent / name for scan in scans for name in data_files(scan)}
        labels = set(matching(folder, self.labels)) or {folder / self.labels} if self.points == "labels" else set()
        navigation = self.navigation
        log = {folder / navigation} if isinstance(navigation, str) else navigation.files(folder)
        covariances = {folder / self.covariances} if self.covariances else set()
        return {*(path for path in beside if path.is_file()), *scans, *labels, *log, *covariances}


def _beside(scans: Sequence[Path]) -> Iterator[Path]:
    """What has a scan's name in any case, alone or before an ending: run.bil of run.bil.hdr, RUN.NAV of run.hdr."""
    stems: dict[Path, set[str]] = {}
    for scan in scans:
        stems.setdefault(scan.parent, set()).add(scan.stem.lower())
    for folder, names in stems.items():
        for path in folder.iterdir():
            name = path.name.lower()
            if name in names or any(name[: sign.start()] in names for sign in re.finditer("[.-]", name)):
                yield path


def _is_day(start: object) -> bool:
    """Whether a value of the YAML is a date without a time, which would be read as midnight."""
    if isinstance(start, str):
        return re.fullmatch(r"\s*\d{4}-\d\d?-\d\d?\s*", start) is not None
    return isinstance(start, datetime.date) and not isinstance(start, datetime.datetime)

"""Navigation format `sbet`: Applanix's smoothed best estimate of trajectory and its RMS file (smrmsg).

A record of the trajectory is 17 little-endian doubles: seconds of the GPS week, latitude, longitude (rad), ellipsoidal
height (m), three velocities, roll, pitch, platform heading, wander angle (rad), three accelerations, three turn rates.
The heading is counted from the wander frame; true heading = platform heading - wander angle. A record of the RMS file
is 10 doubles: seconds of the week, north, east, down (m), three velocities, roll, pitch, heading (arc minutes).
"""

import errno
import logging
from pathlib import Path
from typing import Any, Final, Literal

import numpy as np
from pydantic import Field

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.inputs import axes, gps_time
from linepose.inputs.navigation.format import GeodeticSection, NavigationFormat, with_contents
from linepose.inputs.navigation.poses import Poses
from linepose.inputs.navigation.record import Covariances, NavigationRecord, geodetic_record
from linepose.inputs.patterns import Files, matching

_TRAJECTORY: Final = 17
_RMS: Final = 10
_ARC_MINUTE: Final = np.pi / 180 / 60

log = logging.getLogger(__name__)


class SbetSection(GeodeticSection):
    """Keys of the format `sbet`."""

    format: Literal["sbet"] = Field(description="`sbet`: an SBET trajectory (Applanix, Inertial Explorer) and its RMS.")
    rms: Files | None = Field(None, description="File of the trajectory's RMS (smrmsg), or a pattern, like `file`.")
    gps_week: int | None = Field(
        None, ge=0, description="The GPS week of the first record; if not given, that of the scans' first time stamp."
    )

    def files(self, folder: Path) -> set[Path]:
        """Every file that is read."""
        return super().files(folder) | (with_contents(matching(folder, self.rms)) if self.rms else set())

    def lacking(self, folder: Path) -> Literal["gps_week"] | None:  # noqa: ARG002
        """The week, where it is not given."""
        return "gps_week" if self.gps_week is None else None


def read(section: SbetSection, folder: Path) -> NavigationRecord:
    """The record of the trajectory; raises InputError naming a file without a record, or of another format."""
    poses = [_poses(path, section.gps_week) for path in section.paths(folder)]
    rms = section.model_copy(update={"file": section.rms}).paths(folder) if section.rms else []
    covariances = [_covariances(path, section.gps_week) for path in rms]
    return geodetic_record(poses, covariances, section)


def _is_trajectory(path: Path) -> dict[str, Any] | None:
    """A file that is named .sbet, or .out where it has whole records."""
    is_whole = path.suffix.lower() == ".out" and path.stat().st_size % (8 * _TRAJECTORY) == 0
    return {} if is_whole or path.suffix.lower() == ".sbet" else None


FORMAT: Final = NavigationFormat("sbet", SbetSection, read, recognise=_is_trajectory)


def _poses(path: Path, week: int | None) -> Poses:
    table = _records(path, _TRAJECTORY, "an SBET trajectory")
    geodetic = np.hstack([np.rad2deg(table[:, 1:3]), table[:, 3:4]])
    heading = table[:, 9] - table[:, 10]
    euler = np.stack([table[:, 7], table[:, 8], (heading + np.pi) % (2 * np.pi) - np.pi], axis=-1)
    return Poses(_unix(path, table, week), geodetic, euler, str(path))


def _covariances(path: Path, week: int | None) -> Covariances:
    table = _records(path, _RMS, "an RMS file (smrmsg)")
    sigma = np.hstack([table[:, 1:4], table[:, 7:10] * _ARC_MINUTE])
    return Covariances(_unix(path, table, week), axes.diagonal_covariance(sigma), str(path))


def _unix(path: Path, table: Floats, week: int | None) -> np.ndarray:
    return gps_time.unix_from_week_of_first(week, gps_time.microseconds(table[:, 0], "s", str(path)), str(path))


def _records(path: Path, n_values: int, what: str) -> Floats:
    """The whole records (K, n_values) of a file, mapped; a last one that was cut is passed over, and told.

    What they hold is checked for the wrong format.
    """
    size, record = path.stat().st_size, 8 * n_values
    count, left_out = divmod(size, record)
    table = _mapped(path, (count, n_values), what) if count else np.empty((0, n_values))
    time_s = table[:, 0]
    if count and not np.any(table[0]):
        remedy = "restore the file: it was not written, or is of another format"
        raise InputError(f"{path}, record 1", "zeros alone", f"{what}: seconds of the GPS week", remedy)
    if not count or (left_out and np.any(np.diff(time_s) < 0)):
        found = f"{size} bytes, {count} whole records and {left_out} bytes more"
        remedy = "restore the file: it was cut or is of another format"
        raise InputError(str(path), found, f"{what}: a multiple of {record} bytes", remedy)
    if left_out:
        log.warning("%s: the file is cut: %d bytes after its %d whole records are passed over", path, left_out, count)
    for row in np.flatnonzero(~np.isfinite(time_s) | (time_s < 0) | (time_s > 2 * gps_time.WEEK_US / 1e6))[:1]:
        found = f"{time_s[row]:g} as its time"
        raise InputError(f"{path}, record {row + 1}", found, f"{what}: seconds of the GPS week", "check the format")
    return table


def _mapped(path: Path, shape: tuple[int, int], what: str) -> Floats:
    try:
        table: Floats = np.memmap(path, dtype="<f8", mode="r", shape=shape)
    except OSError as error:
        if error.errno != errno.ENOMEM:
            raise
        found, remedy = f"{path.stat().st_size} bytes", "raise the limit (ulimit -v), or cut the file into parts"
        raise InputError(str(path), found, f"{what} that the process's memory can map", remedy) from None
    return table

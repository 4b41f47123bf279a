"""Navigation format `resonon`: location files (.lcf) of Resonon's airborne systems, one beside each scan.

Columns apart by spaces: time (s), roll, pitch, heading (rad), longitude, latitude (deg), height (m, WGS 84 ellipsoid),
two of no use, 5 where the row may be used and 0 where not, and more that depend on the receiver. Resonon's roll is
positive with the right wing up, the opposite of ours. The files hold no covariances.
"""

import logging
from pathlib import Path
from typing import Any, Final, Literal

import numpy as np
from pydantic import Field

from linepose.inputs.gps_time import TimeScale
from linepose.inputs.location_files import location_rows, location_unix_us
from linepose.inputs.navigation.format import GeodeticSection, NavigationFormat
from linepose.inputs.navigation.poses import Poses
from linepose.inputs.navigation.record import NavigationRecord, geodetic_record

_USE_COLUMN: Final = 9

log = logging.getLogger(__name__)


class ResononSection(GeodeticSection):
    """Keys of the format `resonon`."""

    format: Literal["resonon"] = Field(description="`resonon`: location files (.lcf) of a Resonon airborne system.")
    time_scale: TimeScale = Field(
        "gps", description="Clock of the files: seconds since 1980-01-06 with leap seconds counted, or Unix time."
    )


def read(section: ResononSection, folder: Path) -> NavigationRecord:
    """The record of all location files; raises InputError naming a row that is none."""
    return geodetic_record([_poses(path, section.time_scale) for path in section.paths(folder)], [], section)


def _is_location_file(path: Path) -> dict[str, Any] | None:
    return {} if path.suffix.lower() == ".lcf" else None


FORMAT: Final = NavigationFormat("resonon", ResononSection, read, has_covariances=False, recognise=_is_location_file)


def _poses(path: Path, time_scale: TimeScale) -> Poses:
    rows = location_rows(path)
    numbers = np.arange(1, len(rows) + 1)
    if rows.shape[1] > _USE_COLUMN:
        usable = rows[:, _USE_COLUMN] != 0
        if not usable.all():
            log.warning("%s: %d rows that the recorder marks as of no use are left out", path, np.sum(~usable))
        rows, numbers = rows[usable], numbers[usable]
    euler = rows[:, 1:4] * [-1.0, 1.0, 1.0]
    times = location_unix_us(rows[:, 0], time_scale, path)
    return Poses(times, rows[:, [5, 4, 6]], euler, str(path), records=numbers)

"""What was read of a platform's files, in the units in which devices show it: for a person to compare."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from linepose.check.finding import Finding, ok
from linepose.errors import InputError
from linepose.inputs.axes import turned_angles
from linepose.inputs.local_frame import geodetic_from_local, local_from_geodetic
from linepose.inputs.navigation import NavigationRecord
from linepose.inputs.scans.scan_bands import open_bands
from linepose.survey.point_names import in_words

_LINES: Final = 64  # of a scan, whose intensities are looked at


def of_log(record: NavigationRecord, corrections: Sequence[str] = ()) -> Finding:
    """How many poses a log has, from when to when, and its first: latitude and longitude where they are known.

    Angles that were turned into a frame are told about true north at the place, as devices show them. `corrections` are
    navigation.corrections, which the record has had.
    """
    log, euler_rad = record.log, record.log.euler_rad[:1]
    told = f"{len(log.time_us)} poses from {utc(log.time_us[0])} to {utc(log.time_us[-1])}; the first: "
    if record.frame is None:
        told += "north {:.3f}, east {:.3f}, down {:.3f} m".format(*log.position_m[0])
    else:
        place = geodetic_from_local(record.frame, log.position_m[:1])[0]
        told += "latitude {:.7f}, longitude {:.7f} deg, height {:.3f} m".format(*place)
        if record.is_turned:
            _, turn = local_from_geodetic(record.frame, place[np.newaxis])
            euler_rad = turned_angles(np.swapaxes(turn, -1, -2), euler_rad)
    told += ", roll {:.3f}, pitch {:.3f}, yaw {:.3f} deg".format(*np.degrees(euler_rad[0]).round(3) + 0.0)
    return ok("navigation log", f"{told}, corrected by navigation.corrections" if corrections else told)


def of_scans(scans: Mapping[int, Path], times: Mapping[int, NDArray[np.int64]]) -> Finding:
    """Lines, times and intensities of the first scan (of some of its lines); raises InputError as reading it does."""
    number, path = next(iter(scans.items()))
    bands = open_bands(path)
    n_lines, n_pixels, n_bands = bands.shape
    lines = np.unique(np.linspace(0, n_lines - 1, _LINES).round().astype(np.int64))
    at_line, at_pixel = (one.ravel() for one in np.meshgrid(lines, np.arange(n_pixels), indexing="ij"))
    mean = bands.nearest(at_line, at_pixel, range(n_bands)).mean(axis=0, dtype=float)
    if not np.all(np.isfinite(mean)):
        raise InputError(str(path), "intensities that are no numbers", "finite intensities", "restore the scan")
    told = f"scan {number}, {path.name}: {n_lines} lines from {utc(times[number][0])} to {utc(times[number][-1])}; "
    return ok("scans", told + f"intensities {mean.min():.6g} to {mean.max():.6g}, on average {mean.mean():.6g}")


def of_labels(labels: pd.DataFrame) -> Finding:
    """The names of the points, and the place of the first."""
    scan, point, u_px, line = next(labels[["observation", "point", "u_px", "line"]].itertuples(index=False))
    names = in_words(dict.fromkeys(labels["point"]))
    return ok("labels", f"points {names}; the first, {point}, at pixel {u_px:g}, line {line:g} of scan {scan}")


def utc(time_us: np.int64) -> str:
    """A Unix time (us) as text."""
    return f"{np.datetime64(int(time_us), 'us')} UTC"

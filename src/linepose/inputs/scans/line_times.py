"""Time stamps of a scan's lines: our CSV file, what recorders write, or a start and a rate."""

from collections.abc import Callable
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from linepose.errors import InputError
from linepose.inputs import gps_time
from linepose.inputs.number_files import check_microseconds
from linepose.inputs.observed_points import select_scans
from linepose.inputs.patterns import matching
from linepose.inputs.scans.csv_times import read_times
from linepose.inputs.scans.event_times import burst, event_times
from linepose.inputs.scans.headwall_times import frame_index, headwall_times
from linepose.inputs.scans.hyspex_times import hyspex_times
from linepose.inputs.scans.rate_times import rate_times
from linepose.inputs.scans.resonon_times import resonon_times
from linepose.inputs.scans.scan_files import LineTimes
from linepose.inputs.scans.specim_times import specim_times
from linepose.inputs.scans.time_faults import checked_line_times
from linepose.inputs.source import ScansSection

Stamps = NDArray[np.int64]


def line_times_of(source: ScansSection) -> LineTimes:
    """How the time stamps of this platform's scans are read: a function of a scan's path and its number of lines.

    It returns Unix time (us), and raises InputError where a file is missing or cut, or does not fit the scan.
    """

    def line_times(scan: Path, n_lines: int) -> Stamps:
        times, path, heading = _read(scan, source)
        return checked_line_times(times, n_lines, path, heading)

    return line_times


def first_time_us(source: ScansSection, folder: Path) -> int:
    """Unix time (us) of the first line of the first scan."""
    scan = next(iter(select_scans(folder, source.scans, ()).values()))
    times, path, heading = _read(scan, source)
    if not len(times):
        raise InputError(str(path), "no time stamp", "one for each line of the scan", "restore the file")
    check_microseconds(times[:1], path, first_row=heading + 1)
    return int(times[0])


def _read(scan: Path, source: ScansSection) -> tuple[Stamps, Path, int]:
    """Unix times (us) of a scan's lines with `time_offset_s`, the file that they are of, and its rows of heading."""
    times, path, heading = _READERS[source.time_stamps](scan, source)
    return times + round(source.time_offset_s * 1e6), path, heading


def _unix(times: Stamps, source: ScansSection) -> Stamps:
    """Unix time of stamps that count from 1970 or, as `time_scale: gps` says, from 1980 with leap seconds."""
    return gps_time.unix_from_gps(times) if source.time_scale == "gps" else times


def _csv(scan: Path, source: ScansSection) -> tuple[Stamps, Path, int]:
    path = source.time_path(scan, "{name}-times.csv")
    times, heading = read_times(path)
    return _unix(times, source), path, heading


def _resonon(scan: Path, source: ScansSection) -> tuple[Stamps, Path, int]:
    times, path = resonon_times(scan, source.time_scale or "gps")
    return times, path, 0


def _headwall(scan: Path, source: ScansSection) -> tuple[Stamps, Path, int]:
    path = _beside(scan, source, "") if source.time_file else frame_index(scan)
    times, heading = headwall_times(path)
    return _unix(times, source), path, heading


def _specim(scan: Path, source: ScansSection) -> tuple[Stamps, Path, int]:
    times, path = specim_times(scan)
    return _of_dates(times, source), path, 0


def _rate(scan: Path, source: ScansSection) -> tuple[Stamps, Path, int]:
    times, path = rate_times(scan, source.start_times, source.line_rate_hz)
    return _of_dates(times, source), path, 0


def _of_dates(times: Stamps, source: ScansSection) -> Stamps:
    """Unix time of dates and times as us since 1970, which are of GPS time where `time_scale: gps` says so."""
    return gps_time.unix_from_gps(times - gps_time.GPS_EPOCH_US) if source.time_scale == "gps" else times


def _hyspex(scan: Path, source: ScansSection) -> tuple[Stamps, Path, int]:
    path = _beside(scan, source, "{name}.txt")
    times, heading = hyspex_times(scan, path, source.gps_week)
    return times, path, heading


def _novatel(scan: Path, source: ScansSection) -> tuple[Stamps, Path, int]:
    """The events of a log of this scan alone, or of the burst that is this scan's in a log of all."""
    path = _beside(scan, source, "{name}.gps")
    times = event_times(path, source.event)
    if source.time_file is None or "{name}" in source.time_file:
        return times, path, 0
    scans = matching(scan.parent, Path(source.scans).name)
    return burst(times, scans.index(scan), len(scans), path), path, 0


_READERS: Final[dict[str, Callable[[Path, ScansSection], tuple[Stamps, Path, int]]]] = {
    "csv": _csv,
    "resonon": _resonon,
    "headwall": _headwall,
    "specim": _specim,
    "hyspex": _hyspex,
    "novatel": _novatel,
    "rate": _rate,
}


def _beside(scan: Path, source: ScansSection, usual: str) -> Path:
    path = source.time_path(scan, usual)
    if not path.is_file():
        expected = f"{path.name} beside it, which its time stamps are made of"
        raise InputError(str(scan), "no such file", expected, "put it there, or correct source.time_file")
    return path

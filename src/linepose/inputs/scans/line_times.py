"""Time stamps of a scan's lines: our CSV file, or what the recorders of Resonon, Headwall and Specim write."""

import re
from collections.abc import Callable
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from linepose.errors import InputError
from linepose.inputs import gps_time
from linepose.inputs.gps_time import TimeScale
from linepose.inputs.location_files import location_rows, location_unix_us
from linepose.inputs.observed_points import select_scans
from linepose.inputs.scans.csv_times import read_times
from linepose.inputs.scans.scan_files import LineTimes, times_path
from linepose.inputs.scans.specim_times import specim_times
from linepose.inputs.scans.time_faults import checked_line_times
from linepose.inputs.source import ScansSection

Stamps = NDArray[np.int64]

_INTERLEAVES: Final = {".bil", ".bip", ".bsq"}
_FIELDS: Final = 2  # Headwall's frame number and time stamp


def line_times_of(source: ScansSection) -> LineTimes:
    """How the time stamps of this platform's scans are read: a function of a scan's path and its number of lines.

    It returns Unix time (us), and raises InputError where a file is missing or cut, or does not fit the scan.
    """
    read, scale = _READERS[source.time_stamps], source.time_scale or _SCALES[source.time_stamps]

    def line_times(scan: Path, n_lines: int) -> Stamps:
        times, path, heading = read(scan, scale)
        return checked_line_times(times, n_lines, path, heading)

    return line_times


def first_time_us(source: ScansSection, folder: Path) -> int:
    """Unix time (us) of the first line of the first scan."""
    scan = next(iter(select_scans(folder, source.scans, ()).values()))
    scale = source.time_scale or _SCALES[source.time_stamps]
    times, path, _ = _READERS[source.time_stamps](scan, scale)
    if not len(times):
        raise InputError(str(path), "no time stamp", "one for each line of the scan", "restore the file")
    return int(times[0])


def _csv(scan: Path, scale: TimeScale) -> tuple[Stamps, Path, int]:
    path = times_path(scan)
    times, heading = read_times(path)
    return gps_time.unix_from_gps(times) if scale == "gps" else times, path, heading


def _resonon(scan: Path, scale: TimeScale) -> tuple[Stamps, Path, int]:
    """The first line was taken when the location file begins, whatever the clock of the .times file counts from."""
    names = _names(scan)
    times_file = _first_file([f"{name}{ending}" for name in names for ending in (".times", *_TIMES_ENDINGS)], scan)
    location = _first_file([f"{name}.lcf" for name in names], scan)
    seconds = np.array([_number(word, times_file, row) for row, word in enumerate(_rows(times_file), start=1)])
    start_us = int(location_unix_us(location_rows(location)[:1, 0], scale, location)[0])
    return start_us + gps_time.microseconds(seconds - seconds[:1], "s"), times_file, 0


_TIMES_ENDINGS: Final = tuple(f"{ending}.times" for ending in sorted(_INTERLEAVES))


def _headwall(scan: Path, scale: TimeScale) -> tuple[Stamps, Path, int]:
    """Rows of frame number and microseconds below a heading, in the file of the number after the scan's `raw_`."""
    found = set(re.findall(r"(?<![^\W_])raw_(\d+)", scan.stem, re.IGNORECASE))
    if len(found) != 1:
        told = "a name with several raw_N" if found else "a name without raw_N"
        expected = "raw_N.hdr, whose time stamps stand in frameIndex_N.txt"
        raise InputError(
            str(scan), told, expected, "restore the recorder's name, or put more before it (day_raw_0.hdr)"
        )
    path = _first_file([f"frameIndex_{found.pop()}.txt"], scan)
    rows = _rows(path)
    heading = int(rows[0].lower().startswith("frame"))
    times = np.empty(len(rows) - heading, dtype=np.int64)
    for index, row in enumerate(rows[heading:]):
        words = row.split()
        if len(words) != _FIELDS or not words[1].isdigit():
            place, expected = f"{path}, row {index + heading + 1}", "a frame number and its time stamp (us)"
            raise InputError(place, repr(row[:60]), expected, "mend the row, or remove it with its line")
        times[index] = int(words[1])
    return gps_time.unix_from_gps(times) if scale == "gps" else times, path, heading


def _specim(scan: Path, scale: TimeScale) -> tuple[Stamps, Path, int]:
    times, path = specim_times(scan)
    return gps_time.unix_from_gps(times - gps_time.GPS_EPOCH_US) if scale == "gps" else times, path, 0


_READERS: Final[dict[str, Callable[[Path, TimeScale], tuple[Stamps, Path, int]]]] = {
    "csv": _csv,
    "resonon": _resonon,
    "headwall": _headwall,
    "specim": _specim,
}
_SCALES: Final[dict[str, TimeScale]] = {"csv": "unix", "resonon": "gps", "headwall": "unix", "specim": "unix"}


def _names(scan: Path) -> list[str]:
    """What the recorder may have called this scan's cube: `run` of run.hdr, run.bil.hdr and run-radiance.bil.hdr."""
    name = Path(scan.stem).stem if Path(scan.stem).suffix.lower() in _INTERLEAVES else scan.stem
    return [name, name.rsplit("-", 1)[0]] if "-" in name else [name]


def _first_file(names: list[str], scan: Path) -> Path:
    for name in names:
        if (scan.parent / name).is_file():
            return scan.parent / name
    found = f"no {' or '.join(dict.fromkeys(names))} beside it"
    raise InputError(
        str(scan), found, "what its time stamps are made of", "put the file there, or correct source.time_stamps"
    )


def _rows(path: Path) -> list[str]:
    try:
        rows = path.read_text(encoding="utf-8").rstrip().splitlines()
    except UnicodeDecodeError:
        raise InputError(str(path), "bytes that are no text", "time stamps", "restore the file") from None
    if not rows:
        raise InputError(str(path), "an empty file", "time stamps", "restore it")
    return rows


def _number(word: str, path: Path, row: int) -> float:
    try:
        return float(word)
    except ValueError:
        raise InputError(f"{path}, row {row}", repr(word[:60]), "a time in seconds", "mend the row") from None

"""Time stamps of a scan's lines: our CSV file, what recorders write, or a start and a rate."""

import re
from collections.abc import Callable
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from linepose.errors import InputError
from linepose.inputs import gps_time
from linepose.inputs.location_files import location_rows, location_unix_us
from linepose.inputs.number_files import check_microseconds, plain_float, plain_whole
from linepose.inputs.observed_points import select_scans
from linepose.inputs.patterns import in_any_case
from linepose.inputs.scans.csv_times import read_times
from linepose.inputs.scans.event_times import burst, event_times
from linepose.inputs.scans.hyspex_times import hyspex_times
from linepose.inputs.scans.rate_times import rate_times
from linepose.inputs.scans.scan_files import LineTimes
from linepose.inputs.scans.specim_times import specim_times
from linepose.inputs.scans.time_faults import checked_line_times
from linepose.inputs.source import ScansSection

Stamps = NDArray[np.int64]

_INTERLEAVES: Final = {".bil", ".bip", ".bsq"}


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
    """The first line was taken when the location file begins, whatever the clock of the .times file counts from."""
    names = _names(scan)
    times_file = _first_file([f"{name}{ending}" for name in names for ending in (".times", *_TIMES_ENDINGS)], scan)
    location = _first_file([f"{name}.lcf" for name in names], scan)
    seconds = np.array([_number(word, times_file, row) for row, word in enumerate(_rows(times_file), start=1)])
    start_us = int(location_unix_us(location_rows(location)[:1, 0], source.time_scale or "gps", location)[0])
    gps_time.tell_lost_weeks(start_us, str(location))
    return start_us + gps_time.microseconds(seconds - seconds[:1], "s", str(times_file)), times_file, 0


_TIMES_ENDINGS: Final = tuple(f"{ending}.times" for ending in sorted(_INTERLEAVES))


def _headwall(scan: Path, source: ScansSection) -> tuple[Stamps, Path, int]:
    """Rows of frame number and microseconds below a heading, in the file of the number after the scan's `raw_`."""
    path = _beside(scan, source, "") if source.time_file else _first_file([_frame_index(scan)], scan)
    rows = _rows(path)
    heading = int(rows[0].lower().startswith("frame"))
    times = np.empty(len(rows) - heading, dtype=np.int64)
    for index, row in enumerate(rows[heading:]):
        words = row.split()
        try:
            _, times[index] = _two(words)
        except ValueError:
            place, expected = f"{path}, row {index + heading + 1}", "a frame number and its time stamp (us)"
            raise InputError(place, repr(row[:60]), expected, "mend the row, or remove it with its line") from None
    return _unix(times, source), path, heading


def _two(words: list[str]) -> tuple[str, int]:
    frame, stamp = words
    return frame, plain_whole(stamp)


def _frame_index(scan: Path) -> str:
    found = set(re.findall(r"(?<![^\W_])raw_(\d+)", scan.stem, re.IGNORECASE))
    if len(found) != 1:
        told = "a name with several raw_N" if found else "a name without raw_N"
        expected = "raw_N.hdr, whose time stamps stand in frameIndex_N.txt"
        remedy = "restore the recorder's name, or name the file by source.time_file ({name}_frames.txt)"
        raise InputError(str(scan), told, expected, remedy)
    return f"frameIndex_{found.pop()}.txt"


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
    scans = sorted(scan.parent.glob(Path(source.scans).name))
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


def _names(scan: Path) -> list[str]:
    """What the recorder may have called this scan's cube: `run` of run.hdr, run.bil.hdr and run-radiance.bil.hdr."""
    name = Path(scan.stem).stem if Path(scan.stem).suffix.lower() in _INTERLEAVES else scan.stem
    return [name, name.rsplit("-", 1)[0]] if "-" in name else [name]


def _first_file(names: list[str], scan: Path) -> Path:
    for path in (in_any_case(scan.parent / name) for name in names):
        if path.is_file():
            return path
    found = f"no {' or '.join(dict.fromkeys(names))} beside it"
    raise InputError(
        str(scan), found, "what its time stamps are made of", "put the file there, or correct source.time_stamps"
    )


def _rows(path: Path) -> list[str]:
    try:
        rows = path.read_text(encoding="utf-8-sig").rstrip().splitlines()
    except UnicodeDecodeError:
        raise InputError(str(path), "bytes that are no text", "time stamps", "restore the file") from None
    if not rows:
        raise InputError(str(path), "an empty file", "time stamps", "restore it")
    return rows


def _number(word: str, path: Path, row: int) -> float:
    try:
        return plain_float(word)
    except ValueError:
        raise InputError(f"{path}, row {row}", repr(word[:60]), "a time in seconds", "mend the row") from None

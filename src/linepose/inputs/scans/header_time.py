"""What a scan's header says of time: the day, the time of its first line, and the lines a second."""

import datetime
import re
from pathlib import Path
from typing import Final

from linepose.inputs.scans.envi_header import header_words

_RATES: Final = ("fps", "framerate", "frame rate")
_DATE: Final = r"(\d{4})[-/](\d\d)[-/](\d\d)"
_CLOCK: Final = r"(\d\d):(\d\d):(\d\d(?:\.\d+)?)"


def words_of(scan: Path) -> dict[str, str]:
    """The header's values by their keys; none for a picture."""
    return header_words(scan) if scan.suffix.lower() == ".hdr" else {}


def line_rate_hz(words: dict[str, str]) -> float | None:
    """Lines a second: `fps` of Specim, `framerate` of Resonon."""
    for key in _RATES:
        match = re.match(r"\d+(\.\d+)?", words.get(key, ""))
        if match and float(match[0]) > 0:
            return float(match[0])
    return None


def day_of(words: dict[str, str]) -> datetime.date | None:
    """The day of the recording: `acquisition date = DATE(yyyy-mm-dd): 2024-05-01`, or that of `acquisition time`."""
    match = re.search(rf"{_DATE}\s*$", words.get("acquisition date", ""))
    match = match or re.match(_DATE, words.get("acquisition time", ""))
    try:
        return datetime.date(*(int(part) for part in match.groups())) if match else None
    except ValueError:
        return None


def start_us(words: dict[str, str]) -> int | None:
    """Unix time (us) of the first line: `Start Time = UTC TIME: 10:00:00`, or ENVI's `acquisition time`, as UTC."""
    day = day_of(words)
    match = re.search(_CLOCK, words.get("start time", "")) or re.search(_CLOCK, words.get("acquisition time", ""))
    if day is None or match is None:
        return None
    midnight = int(datetime.datetime.combine(day, datetime.time(), datetime.UTC).timestamp())
    of_day_s = (int(match[1]) * 60 + int(match[2])) * 60 + float(match[3])
    return midnight * 1_000_000 + round(of_day_s * 1e6)

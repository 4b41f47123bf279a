"""What a scan's header says of time: the day, the time of its first line, and the lines a second."""

import datetime
import math
import re
from pathlib import Path
from typing import Final

from linepose.inputs.scans.envi_header import header_words

_RATES: Final = ("fps", "framerate", "frame rate")
_RATE: Final = re.compile(
    r"\{?\s*(\d+(?:[.,]\d*)?(?:e[+-]?\d+)?)\s*(?:hz|fps|(?:lines|frames).*)?\s*\}?", re.IGNORECASE
)
_YEAR_FIRST: Final = re.compile(r"(?P<year>\d{4})[-/](?P<month>\d\d)[-/](?P<day>\d\d)")
_DAY_FIRST: Final = re.compile(r"(?P<day>\d\d)[-/.](?P<month>\d\d)[-/.](?P<year>\d{4})")
_CLOCK: Final = re.compile(r"(\d\d):(\d\d):(\d\d(?:\.\d+)?)")
_STARTS: Final = ("gps start time", "start time")


def words_of(scan: Path) -> dict[str, str]:
    """The header's values by their keys; none for a picture."""
    return header_words(scan) if scan.suffix.lower() == ".hdr" else {}


def line_rate_hz(words: dict[str, str]) -> float | None:
    """Lines a second: `fps` of Specim, `framerate` of Resonon, also with a decimal comma or the unit."""
    for key in _RATES:
        match = _RATE.fullmatch(words.get(key, ""))
        if match and 0 < float(match[1].replace(",", ".")) < math.inf:
            return float(match[1].replace(",", "."))
    return None


def day_of(words: dict[str, str]) -> datetime.date | None:
    """The day of the recording: `acquisition date = DATE(yyyy-mm-dd): 2024-05-01`, or that of `acquisition time`.

    The day comes first where `DATE(dd-mm-yyyy)` says so.
    """
    date = words.get("acquisition date", "")
    layout, _, day = date.rpartition("):")
    form = _DAY_FIRST if "dd-mm" in layout.lower() else _YEAR_FIRST
    match = form.fullmatch(day.strip()) or _YEAR_FIRST.match(words.get("acquisition time", "").strip("{ "))
    try:
        return datetime.date(int(match["year"]), int(match["month"]), int(match["day"])) if match else None
    except ValueError:
        return None


def start_us(words: dict[str, str]) -> int | None:
    """Unix time (us) of the first line: `Start Time = UTC TIME: 10:00:00`, or ENVI's `acquisition time`.

    That of the GPS comes first. A time without an offset from UTC is UTC.
    """
    day = day_of(words)
    match = next((found for key in _STARTS if (found := _CLOCK.search(words.get(key, "")))), None)
    if match is None:
        return _unix_us(words.get("acquisition time", ""))
    if day is None:
        return None
    midnight = int(datetime.datetime.combine(day, datetime.time(), datetime.UTC).timestamp())
    of_day_s = (int(match[1]) * 60 + int(match[2])) * 60 + float(match[3])
    return midnight * 1_000_000 + round(of_day_s * 1e6)


def _unix_us(text: str) -> int | None:
    """Unix time (us) of a date and time in ISO 8601; None of another text."""
    try:
        found = datetime.datetime.fromisoformat(text.strip("{} ").replace("/", "-"))
    except ValueError:
        return None
    if len(text) <= len("2024-05-01") + 2:
        return None  # a day alone
    aware = found if found.tzinfo else found.replace(tzinfo=datetime.UTC)
    return (aware - datetime.datetime(1970, 1, 1, tzinfo=datetime.UTC)) // datetime.timedelta(microseconds=1)

"""What a scan's header says of time: the day, the time of its first line, and the lines a second."""

import datetime
import logging
import math
import re
from pathlib import Path
from typing import Final

from linepose.inputs.scans.envi_header import header_words

_RATES: Final = ("fps", "framerate", "frame rate")
_RATE: Final = re.compile(r"[{\s]*(\d+(?:[.,]\d*)?(?:e[+-]?\d+)?)(?:[^\d.,].*)?", re.IGNORECASE)
_THOUSANDS: Final = re.compile(r"\d{1,3},\d{3}")  # or a rate of three decimals: nobody can tell
_YEAR_FIRST: Final = re.compile(r"(?P<year>\d{4})[-/](?P<month>\d\d)[-/](?P<day>\d\d)[}\s]*$")
_DAY_FIRST: Final = re.compile(r"(?P<day>\d\d)[-/.](?P<month>\d\d)[-/.](?P<year>\d{4})[}\s]*$")
_OF_ACQUISITION: Final = re.compile(r"[{\s]*(?P<year>\d{4})[-/](?P<month>\d\d)[-/](?P<day>\d\d)")
_CLOCK: Final = re.compile(r"(\d\d):(\d\d):(\d\d(?:\.\d+)?)")
_BRIEFLY: Final = 60  # characters of a value in a message
_OF_GPS: Final = "gps start time"
_OF_CLOCK: Final = "start time"
_APART_S: Final = 60.0  # from which a start by the GPS is that of a receiver without time, or of another recording
_DAY_S: Final = 86400.0

log = logging.getLogger(__name__)


def words_of(scan: Path) -> dict[str, str]:
    """The header's values by their keys; none for a picture."""
    return header_words(scan) if scan.suffix.lower() == ".hdr" else {}


def line_rate_hz(words: dict[str, str], scan: Path) -> float | None:
    """Lines a second: `fps` of Specim, `framerate` of Resonon, also with a decimal comma, or with words behind it.

    A value that is not understood is told and passed over.
    """
    for key in _RATES:
        text = words.get(key, "")
        match = _RATE.fullmatch(text)
        if match and not _THOUSANDS.fullmatch(match[1]) and 0 < float(match[1].replace(",", ".")) < math.inf:
            return float(match[1].replace(",", "."))
        if text.strip():
            told = "%s: %s = %s is no rate such as 100.0, and is passed over"
            log.warning(told, scan, key, text.strip()[:_BRIEFLY])
    return None


def day_of(words: dict[str, str]) -> datetime.date | None:
    """The day of the recording: `acquisition date = DATE(yyyy-mm-dd): 2024-05-01`, or that of `acquisition time`.

    The day comes first where `DATE(dd-mm-yyyy)` says so.
    """
    date = words.get("acquisition date", "")
    form = _DAY_FIRST if "dd-mm" in date.lower() else _YEAR_FIRST
    match = form.search(date) or _OF_ACQUISITION.match(words.get("acquisition time", ""))
    try:
        return datetime.date(int(match["year"]), int(match["month"]), int(match["day"])) if match else None
    except ValueError:
        return None


def start_us(words: dict[str, str], scan: Path) -> int | None:
    """Unix time (us) of the first line: `Start Time = UTC TIME: 10:00:00`, or ENVI's `acquisition time`.

    A time without an offset from UTC is UTC.
    """
    of_day_s = _start_s(words, scan)
    if of_day_s is None:
        return _unix_us(words.get("acquisition time", ""))
    day = day_of(words)
    if day is None:
        return None
    midnight = int(datetime.datetime.combine(day, datetime.time(), datetime.UTC).timestamp())
    return midnight * 1_000_000 + round(of_day_s * 1e6)


def _start_s(words: dict[str, str], scan: Path) -> float | None:
    """The start in seconds of the day: that of the GPS where it is near the clock's or alone; told where it is not."""
    by_clock_s, by_gps_s = _of_day_s(words.get(_OF_CLOCK, "")), _of_day_s(words.get(_OF_GPS, ""))
    if by_clock_s is None or by_gps_s is None:
        return by_gps_s if by_clock_s is None else by_clock_s
    later_s = (by_gps_s - by_clock_s + _DAY_S / 2) % _DAY_S - _DAY_S / 2
    if abs(later_s) <= _APART_S:
        return by_clock_s + later_s
    told = "%s: GPS Start Time (%s) is not that of Start Time (%s), which is taken"
    log.warning(told, scan, words[_OF_GPS].strip()[:_BRIEFLY], words[_OF_CLOCK].strip()[:_BRIEFLY])
    return by_clock_s


def _of_day_s(text: str) -> float | None:
    """Seconds of the day of a time in a text; None where there is none."""
    match = _CLOCK.search(text)
    return None if match is None else (int(match[1]) * 60 + int(match[2])) * 60 + float(match[3])


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

"""NMEA 0183 sentences of a file with the time of each, as receivers and recorders write them; read by pynmea2.

A sentence tells the time of the day. The day is that of RMC or ZDA sentences, else one that is given.
"""

import datetime
import logging
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from linepose.errors import InputError

_DAY_US: Final = 86_400_000_000
_DATED: Final = re.compile(rb"\$..(?:RMC,[^,]*,[^,]*(?:,[^,]*){6},\d{6}|ZDA,[^,]*,\d\d,\d\d,\d{4})")
_HEAD_BYTES: Final = 10_000_000

log = logging.getLogger(__name__)


@dataclass(frozen=True)
class Sentence:
    """A sentence of a file: its words, what they mean (None where pynmea2 does not know it), and the time before it.

    `time_us` is Unix time: its own, or where it has none that of the sentence before it; None before the first.
    """

    line: int
    words: tuple[str, ...]
    content: Any
    time_us: int | None


def has_date(path: Path) -> bool:
    """Whether sentences of a file say the day."""
    with path.open("rb") as file:
        return bool(_DATED.search(file.read(_HEAD_BYTES)))


def sentences(path: Path, day: datetime.date | None, key: str) -> Iterator[Sentence]:
    """The sentences of a file; `day` is that of the first where none says it, and `key` the key that gives it.

    Text before a sentence on its line is passed over, and lines that are none or have another check sum are counted.
    Raises InputError where there is none, or the day is not known.
    """
    read = faults = 0
    start_us = _start_us(path, day, key)
    of_day_us: int | None = None
    with path.open(encoding="ascii", errors="replace") as file:
        for number, line in enumerate(file, start=1):
            _, sign, text = line.strip().partition("$")
            if not sign:
                faults += bool(line.strip())
                continue
            try:
                content = _content(text)
            except ValueError:
                faults += 1
                continue
            read += 1
            before_us, of_day_us = of_day_us, _time_of_day_us(content, of_day_us)
            if before_us is not None and of_day_us is not None and of_day_us < before_us - _DAY_US // 2:
                start_us += _DAY_US
            time_us = None if of_day_us is None else start_us + of_day_us
            yield Sentence(number, tuple(text.partition("*")[0].split(",")), content, time_us)
    if not read:
        remedy = "give a log of NMEA sentences, or correct the format"
        raise InputError(str(path), "no NMEA sentence", "lines that begin with $", remedy)
    if faults:
        log.warning("%s: %d lines are no whole NMEA sentence and are passed over", path, faults)


def _content(text: str) -> Any:
    """What pynmea2 makes of a sentence, None for one that it does not know; raises ValueError for a wrong check sum."""
    import pynmea2

    try:
        return pynmea2.parse(f"${text}")
    except pynmea2.ChecksumError:
        raise ValueError("check sum") from None
    except (pynmea2.ParseError, ValueError, TypeError, LookupError, AttributeError, ArithmeticError):
        words = text.partition("*")[0].split(",")
        if re.fullmatch(r"[A-Z]{5,8}", words[0]) and words[0][2:] not in {"GGA", "RMC", "ZDA", "GST", "HDT"}:
            return None
        raise ValueError("no sentence") from None


def _time_of_day_us(content: Any, before_us: int | None) -> int | None:
    time = getattr(content, "timestamp", None)
    if not isinstance(time, datetime.time):
        return before_us
    return ((time.hour * 60 + time.minute) * 60 + time.second) * 1_000_000 + time.microsecond


def _start_us(path: Path, day: datetime.date | None, key: str) -> int:
    """Midnight (Unix, us) of the day on which the first sentence with a time was written."""
    said = _said_day(path) if has_date(path) else day
    if said is None:
        found, expected = "no sentence with a date (RMC, ZDA)", "the day of the first sentence"
        raise InputError(str(path), found, expected, f"set {key}")
    return int(datetime.datetime.combine(said, datetime.time(), datetime.UTC).timestamp()) * 1_000_000


def _said_day(path: Path) -> datetime.date | None:
    """The day of the first sentence with a time, counted back from the first that says its date."""
    midnights, of_day_us = 0, None
    with path.open(encoding="ascii", errors="replace") as file:
        for line in file:
            _, sign, text = line.strip().partition("$")
            try:
                content = _content(text) if sign else None
            except ValueError:
                continue
            before_us, of_day_us = of_day_us, _time_of_day_us(content, of_day_us)
            midnights += before_us is not None and of_day_us is not None and of_day_us < before_us - _DAY_US // 2
            date = getattr(content, "datestamp", None)
            if isinstance(date, datetime.date):
                return date - datetime.timedelta(days=midnights)
    return None

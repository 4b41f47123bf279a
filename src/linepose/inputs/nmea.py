"""NMEA 0183 sentences of a file with the time of each, as receivers and recorders write them; read by pynmea2.

A sentence tells the time of the day. The day is that of RMC or ZDA sentences, which may change it, else one that is
given.
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
_OF_A_DAY: Final = re.compile(r"\$..(?:(RMC),[^,]*,(\w?)(?:,[^,]*){6},(\d{6})|(ZDA),[^,]*,(\d\d,\d\d,\d{4}))")
_HEAD_BYTES: Final = 10_000_000
_LINES_BEFORE: Final = 300  # the sentence that says the day of those
_LATE_US: Final = 3_600_000_000  # by which a sentence of the day before may stand behind midnight

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
    days = _Days(_dated(path), day)
    if not days.known:
        found, expected = "no sentence with a date (RMC, ZDA)", "the day of the first sentence"
        raise InputError(str(path), found, expected, f"set {key}")
    time_us: int | None = None
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
            of_day_us = _time_of_day_us(content)
            if of_day_us is not None:
                time_us = days.time_us(number, of_day_us)
            yield Sentence(number, tuple(text.partition("*")[0].split(",")), content, time_us)
    if not read:
        remedy = "give a log of NMEA sentences, or correct the format"
        raise InputError(str(path), "no NMEA sentence", "lines that begin with $", remedy)
    if faults:
        log.warning("%s: %d lines are no whole NMEA sentence and are passed over", path, faults)


def _content(text: str) -> Any:
    """What pynmea2 makes of a sentence, None for one that it does not know; raises ValueError for a wrong check sum."""
    import pynmea2

    if re.match(r"PASHR,[A-Z]{3}", text):  # ATT, POS, ...: Ashtech's own sentences, of other words than RT300's
        return None
    try:
        return pynmea2.parse(f"${text}")
    except pynmea2.ChecksumError:
        raise ValueError("check sum") from None
    except (pynmea2.ParseError, ValueError, TypeError, LookupError, AttributeError, ArithmeticError):
        words = text.partition("*")[0].split(",")
        if re.fullmatch(r"[A-Z]{5,8}", words[0]) and words[0][2:] not in {"GGA", "RMC", "ZDA", "GST", "HDT"}:
            return None
        raise ValueError("no sentence") from None


def _said(content: Any, name: str) -> Any:
    """What a sentence says under this name of pynmea2; None where its words are empty or of no such thing."""
    try:
        return getattr(content, name, None)
    except (TypeError, ValueError, OverflowError):
        return None


def _time_of_day_us(content: Any) -> int | None:
    time = _said(content, "timestamp")
    if not isinstance(time, datetime.time):
        return None
    return ((time.hour * 60 + time.minute) * 60 + time.second) * 1_000_000 + time.microsecond


def _unix_us(day: datetime.date, of_day_us: int = 0) -> int:
    midnight = datetime.datetime.combine(day, datetime.time(), datetime.UTC)
    return int(midnight.timestamp()) * 1_000_000 + of_day_us


def _dated(path: Path) -> list[tuple[int, int]]:
    """Lines and Unix times (us) of the first sentence that says its day, and of those that say another than before.

    Those of a receiver without a fix (RMC, V) count where there are no others.
    """
    dated: dict[bool, list[tuple[int, int]]] = {True: [], False: []}
    last: dict[str, str] = {}
    with path.open(encoding="ascii", errors="replace") as file:
        for number, line in enumerate(file, start=1):
            match = _OF_A_DAY.search(line)
            if match is None:
                continue
            kind, day = f"{match[1]}{match[2]}{match[4]}", match[3] or match[5]
            if last.get(kind) == day:
                continue
            try:
                content = _content(line.strip().partition("$")[2])
            except ValueError:
                continue
            date, of_day_us = _said(content, "datestamp"), _time_of_day_us(content)
            if isinstance(date, datetime.date) and of_day_us is not None:
                found, last[kind] = dated[match[2] != "V"], day
                time_us = _unix_us(date, of_day_us)
                if not found or found[-1][1] // _DAY_US != time_us // _DAY_US:
                    found.append((number, time_us))
    return dated[True] or dated[False]


class _Days:
    """The days of a file's sentences in the order of its lines.

    Each follows from the sentence before it, or from one that says another day a few lines on, whichever is nearer.
    """

    def __init__(self, dated: list[tuple[int, int]], first: datetime.date | None) -> None:
        self.dated, self.next = dated, 0
        self.first_us = None if first is None else _unix_us(first)
        self.last_us: int | None = None
        self.known = bool(dated) or first is not None

    def time_us(self, line: int, of_day_us: int) -> int:
        """Unix time (us) of a sentence on this line, with this time of the day."""
        while self.next < len(self.dated) and self.dated[self.next][0] < line:
            self.next += 1
        near = []
        if self.next < len(self.dated) and (self.last_us is None or self.dated[self.next][0] - line < _LINES_BEFORE):
            near.append(_around(of_day_us, self.dated[self.next][1]))
        if self.last_us is not None:
            near.append(_after(of_day_us, self.last_us))
        if not near:
            near.append(((self.first_us or 0) + of_day_us, 0))
        self.last_us = min(near, key=lambda one: one[1])[0]
        return self.last_us


def _around(of_day_us: int, known_us: int) -> tuple[int, int]:
    """The Unix time (us) with this time of the day that is nearest to a known one, and how far it is from that."""
    apart = (of_day_us - known_us + _DAY_US // 2) % _DAY_US - _DAY_US // 2
    return known_us + apart, abs(apart)


def _after(of_day_us: int, before_us: int) -> tuple[int, int]:
    """As `_around`, of the sentence after one: of the same day, unless the clock fell by half a day or is just late."""
    apart = of_day_us - before_us % _DAY_US
    apart += _DAY_US if apart < -_DAY_US // 2 else -_DAY_US if apart > _DAY_US - _LATE_US else 0
    return before_us + apart, abs(apart)

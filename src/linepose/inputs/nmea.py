"""NMEA 0183 sentences of a file with the time of each, as receivers and recorders write them; read by pynmea2.

A sentence tells the time of the day. The day is that of RMC or ZDA sentences, which may change it, else one that is
given, else that of RMC sentences of a receiver without a fix.
"""

import datetime
import logging
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from linepose.errors import InputError
from linepose.inputs.nmea_content import SENTENCES, content_of, time_of_day_us
from linepose.inputs.nmea_dates import dated_runs, unix_us
from linepose.inputs.text_files import lines_of

_DAY_US: Final = 86_400_000_000
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


def sentences(path: Path, day: datetime.date | None, key: str) -> Iterator[Sentence]:
    """The sentences of a file; `day` is that of the first where none says it, and `key` the key that gives it.

    Text before a sentence on its line is passed over, and lines that are none or have another check sum are counted.
    Raises InputError where there is none, the day is not known, or a line has no end.
    """
    read = faults = 0
    days = _Days(_dated(path, day, key), day)
    if not days.known:
        found, expected = "no sentence with a date (RMC, ZDA)", "the day of the first sentence"
        raise InputError(str(path), found, expected, f"set {key}")
    time_us: int | None = None
    for number, line in enumerate(lines_of(path, SENTENCES), start=1):
        _, sign, text = line.strip().partition("$")
        if not sign:
            faults += bool(line.strip())
            continue
        try:
            content = content_of(text)
        except ValueError:
            faults += 1
            continue
        read += 1
        of_day_us = time_of_day_us(content)
        if of_day_us is not None:
            time_us = days.time_us(number, of_day_us)
        yield Sentence(number, tuple(text.partition("*")[0].split(",")), content, time_us)
    if not read:
        remedy = "give a log of NMEA sentences, or correct the format"
        raise InputError(str(path), "no NMEA sentence", "lines that begin with $", remedy)
    if faults:
        log.warning("%s: %d lines are no whole NMEA sentence and are passed over", path, faults)


def _dated(path: Path, day: datetime.date | None, key: str) -> list[tuple[int, int]]:
    """Lines and Unix times (us) of sentences that say their day, where it may change; told where `day` is another.

    Those of a receiver without a fix count where neither others nor `day` say it.
    """
    runs = dated_runs(path, day, key, has_fix=True)
    if runs:
        if day is not None and runs[0].first_day != day:
            log.warning("%s: begins on %s, as RMC or ZDA say, not on %s (%s)", path, runs[0].first_day, day, key)
        return [(run.line, run.time_us) for run in runs]
    runs = dated_runs(path, day, key, has_fix=False)
    if day is None:
        return [(run.line, run.time_us) for run in runs]
    if runs and runs[0].first_day != day:
        told = "%s: RMC sentences of a receiver without a fix say %s; what counts is %s (%s)"
        log.warning(told, path, runs[0].first_day, day, key)
    return []


class _Days:
    """The days of a file's sentences in the order of its lines.

    Each follows from the sentence before it, or from one that says another day a few lines on, whichever is nearer.
    """

    def __init__(self, dated: list[tuple[int, int]], first: datetime.date | None) -> None:
        self.dated, self.next = dated, 0
        self.first_us = None if first is None else unix_us(first)
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

"""The dates that sentences of an NMEA log say (RMC, ZDA), and which of them cannot be right.

Where the time of the day goes on from sentence to sentence, so does the day. What says another day there than most do
is of a receiver that has lost its weeks, or is broken; where the time of the day jumps, as between two logs in one
file, the day may be any.
"""

import datetime
import logging
import re
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path
from typing import Final

from linepose.inputs.nmea_content import SENTENCES, content_of, date_of, time_of_day_us
from linepose.inputs.text_files import lines_of

_TIMED: Final = re.compile(r"\$(?:..(?:GGA|RMC|ZDA)|PASHR),(\d\d)(\d\d)(\d\d)")
_DATED: Final = re.compile(r"\$..(?:RMC,\d{6}[^,]*,(\w?)(?:,[^,]*){6},(\d{6})|ZDA,\d{6}[^,]*,(\d\d),(\d\d),\d\d(\d\d))")
_HEAD_CHARACTERS: Final = 10_000_000
_DAY_S: Final = 86_400
_EPOCH: Final = datetime.date(1970, 1, 1).toordinal()
_PAUSE_S: Final = 5  # up to which the time of the day goes on
_LATE_S: Final = 1  # by which a sentence may stand behind those after it

log = logging.getLogger(__name__)


@dataclass
class Run:
    """Sentences one after the other that say the same day (ddmmyy).

    `line` and `time_us`: line and Unix time of the first; `has_fix`: of a receiver with a fix; `stretch`: number of the
    stretch in which the time of the day goes on; `midnights`: how many lie between the begin of that and the run;
    `start`: the day on which it begins, by this date, as an ordinal; `count`: how many sentences.
    """

    line: int
    time_us: int
    day: str
    has_fix: bool
    stretch: int
    midnights: int
    start: int
    count: int = 1

    @property
    def date(self) -> datetime.date:
        """The day that the sentences say."""
        return datetime.date.fromordinal(self.start + self.midnights)

    @property
    def first_day(self) -> datetime.date:
        """The day on which the stretch begins, by this date."""
        return datetime.date.fromordinal(self.start)


def unix_us(day: datetime.date, of_day_us: int = 0) -> int:
    """Unix time (us) of a time since midnight (us)."""
    return (day.toordinal() - _EPOCH) * _DAY_S * 1_000_000 + of_day_us


def has_date(path: Path) -> bool:
    """Whether sentences of a file say the day, of a receiver with a fix."""
    return any(run.has_fix for run in _runs(path, _HEAD_CHARACTERS))


def dated_runs(path: Path, day: datetime.date | None, key: str, has_fix: bool) -> list[Run]:
    """The runs of a file whose dates can be right, of receivers with or without a fix.

    In each stretch the dates of most sentences count, before that those of `day`, where `key` gives it. How many
    others there are is told.
    """
    runs = [run for run in _runs(path) if run.has_fix == has_fix]
    of_stretches = {number: _start(list(part), day) for number, part in groupby(runs, key=lambda run: run.stretch)}
    others = [run for run in runs if run.start != of_stretches[run.stretch]]
    if others:
        told = "%s: the dates of %d sentences (RMC, ZDA) do not follow from those of the others and are passed over, "
        told += "the first on line %d (%s); where they are right, set %s to their day"
        first = others[0]
        log.warning(told, path, sum(run.count for run in others), first.line, first.date, key)
    return [run for run in runs if run.start == of_stretches[run.stretch]]


def _start(runs: Sequence[Run], day: datetime.date | None) -> int:
    """The day on which a stretch begins by most of its dates, of as many the later."""
    counts: Counter[int] = Counter()
    for run in runs:
        counts[run.start] += run.count
    given = None if day is None else day.toordinal()
    return max(counts, key=lambda start: (given is not None and abs(start - given) <= 1, counts[start], start))


def _runs(path: Path, most_characters: int | None = None) -> Iterator[Run]:
    """The runs of a file as they begin, with and without a fix apart; they are whole at the end of the file."""
    open_runs: dict[bool, Run] = {}
    stretch = midnights = read = 0
    last_s: int | None = None
    for number, line in enumerate(lines_of(path, SENTENCES), start=1):
        read += len(line)
        if most_characters is not None and read > most_characters:
            break
        timed = _TIMED.search(line)
        if timed is None:
            continue
        of_day_s = (int(timed[1]) * 60 + int(timed[2])) * 60 + int(timed[3])
        if last_s is not None:
            step_s = (of_day_s - last_s + _DAY_S // 2) % _DAY_S - _DAY_S // 2
            goes_on = -_LATE_S <= step_s <= _PAUSE_S
            midnights = midnights + (last_s + step_s - of_day_s) // _DAY_S if goes_on else 0
            stretch += not goes_on
        last_s = of_day_s
        dated = _DATED.search(line)
        if dated is None:
            continue
        has_fix, day = dated[1] != "V", dated[2] or dated[3] + dated[4] + dated[5]
        run = open_runs.get(has_fix)
        if run is not None and (run.day, run.stretch, run.midnights) == (day, stretch, midnights):
            run.count += 1
            continue
        said = _time_of(line)
        if said is None:
            continue
        start = said[0].toordinal() - midnights
        open_runs[has_fix] = Run(number, unix_us(*said), day, has_fix, stretch, midnights, start)
        yield open_runs[has_fix]


def _time_of(line: str) -> tuple[datetime.date, int] | None:
    """Day and time since midnight (us) of a whole sentence that says both."""
    try:
        content = content_of(line.strip().partition("$")[2])
    except ValueError:
        return None
    date, of_day_us = date_of(content), time_of_day_us(content)
    return None if date is None or of_day_us is None else (date, of_day_us)

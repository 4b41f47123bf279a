"""Times of lines that a NovAtel receiver logged as events: MARKTIME, MARKnTIME or MARKnPVA, one a line.

A log beside each scan holds the events of its lines. One log of all scans holds a burst of events a scan, in the order
of the scans' names; a pause of more than ten times the usual step parts two bursts.
"""

import logging
import re
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from linepose.errors import InputError
from linepose.inputs import gps_time
from linepose.inputs.novatel_file import messages

_EVENT: Final = re.compile(r"MARK\d?(TIME|PVA)S?")
_PAUSE: Final = 10.0  # of the median step

log = logging.getLogger(__name__)


def event_times(path: Path, name: str | None) -> NDArray[np.int64]:
    """Unix times (us) of the events in a log, in their order; `name` is the message's, None for the only one.

    Raises InputError where there are none, or of several kinds.
    """
    rows: dict[str, list[tuple[int, float, bool]]] = {}
    for message in messages(path):
        kind = str(getattr(message, "name", ""))
        if _EVENT.fullmatch(kind):
            status = getattr(message, "status", None)
            is_valid = str(getattr(status, "name", status)) != "INVALID"
            rows.setdefault(kind, []).append((*_time_of(message), is_valid))
    if name is None and len(rows) > 1:
        counts = ", ".join(f"{len(alike)} {kind}" for kind, alike in rows.items())
        raise InputError(str(path), counts, "one kind of event", f"set source.event to one of {', '.join(rows)}")
    said = (name or next(iter(rows), "")).upper()
    chosen = rows.get(said) or rows.get(said.removesuffix("A"))  # MARKTIMEA, as in the log
    if not chosen:
        held = f"events {', '.join(rows)}" if rows else "no event"
        expected = name or "MARKTIME, MARKnTIME or MARKnPVA messages"
        raise InputError(str(path), held, expected, "log them, or correct source.event and source.time_file")
    week, seconds, valid = np.array(chosen).T
    stamps = gps_time.unix_from_week(week, seconds, str(path))
    times = np.unique(stamps)
    if len(times) < len(chosen):
        log.warning("%s: %d events at the time of another are passed over", path, len(chosen) - len(times))
    invalid = len(times) - len(np.unique(stamps[valid == 1]))  # at a time at which no other was valid
    if invalid:
        log.warning("%s: %d events while the receiver's clock was not valid; their times may be wrong", path, invalid)
    return times


def burst(times: NDArray[np.int64], number: int, n_bursts: int, path: Path) -> NDArray[np.int64]:
    """The events of the scan of this number (from 0) of so many; raises InputError where bursts are not as many."""
    step = np.diff(times)
    starts = np.flatnonzero(step > _PAUSE * np.median(step)) + 1 if len(step) else np.empty(0, dtype=np.int64)
    parts = np.split(times, starts)
    if len(parts) != n_bursts:
        found = f"{len(parts)} bursts of events"
        expected = f"{n_bursts}, one a scan, with pauses between them"
        remedy = "give each scan a log of its own by source.time_file ({name}.gps), or complete the scans"
        raise InputError(str(path), found, expected, remedy)
    return parts[number]


def _time_of(message: Any) -> tuple[int, float]:
    week = getattr(message, "week", None)
    if week is None:
        return int(message.gps_week), float(message.gps_seconds)
    return int(week), float(message.seconds)

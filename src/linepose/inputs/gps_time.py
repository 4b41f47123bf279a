"""GPS time and UTC: the one place that knows of GPS weeks and leap seconds.

Everything inside is microseconds of Unix time (UTC since 1970, leap seconds not counted). GPS time counts them, from
1980-01-06. The list of leap seconds is the time zone database's (package tzdata), which says until when it is certain.
"""

import logging
from dataclasses import dataclass
from datetime import UTC, datetime
from functools import cache
from importlib.resources import files
from typing import Final, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from linepose.errors import InputError

TimeUnit = Literal["s", "ms", "us", "ns"]
TimeScale = Literal["gps", "unix"]

GPS_EPOCH_US: Final = 315_964_800_000_000  # 1980-01-06 as Unix time
WEEK_US: Final = 604_800_000_000
LOST_WEEKS: Final = "1024 GPS weeks, which a receiver lost"  # as the `cause` of a warning
_LOST_WEEKS: Final = 1024  # of a receiver whose week number has begun from 0 again
_MOST_WEEKS: Final = 10_000
_FARTHEST_US: Final = 3.2e17  # ten thousand years: weeks and epochs added to it stay within 64 bits
_LIKELY_US: Final = (7e14, 4.1e15)  # 1992 to 2100, since 1970; 2002 on, since 1980
_UNIT_US: Final[dict[TimeUnit, float]] = {"s": 1e6, "ms": 1e3, "us": 1.0, "ns": 1e-3}

log = logging.getLogger(__name__)


@dataclass(frozen=True)
class LeapSeconds:
    """When leap seconds took effect, start_us (L,) in Unix time, their sum since the GPS epoch (L,), and validity."""

    start_us: NDArray[np.int64]
    total_s: NDArray[np.int64]
    expires_us: int


@cache
def leap_seconds() -> LeapSeconds:
    """The leap seconds since the GPS epoch, and the date from which another one is possible."""
    start, step, expires = [], [], 0
    for line in (files("tzdata") / "zoneinfo" / "leapseconds").read_text(encoding="utf-8").splitlines():
        words = line.split()
        if words[:1] == ["Leap"]:  # Leap 2016 Dec 31 23:59:60 + S: from the midnight after
            day = datetime.strptime(" ".join(words[1:4]), "%Y %b %d").replace(tzinfo=UTC)
            start.append((int(day.timestamp()) + 86_400) * 1_000_000)
            step.append(1 if words[5] == "+" else -1)
        elif words[:1] == ["#expires"]:
            expires = int(words[1]) * 1_000_000
    start_us, step_s = np.array(start, dtype=np.int64), np.array(step, dtype=np.int64)
    since = start_us > GPS_EPOCH_US
    return LeapSeconds(start_us[since], np.cumsum(step_s[since]), expires)


def microseconds(
    values: ArrayLike, unit: TimeUnit, place: str = "times", unit_key: str | None = None
) -> NDArray[np.int64]:
    """Numbers in this unit as whole microseconds, rounded to the nearest.

    `unit_key` is the key that says the unit, None where the reader has none. Raises InputError naming the place and the
    record of what is no time between the years -10000 and 10000.
    """
    numbers = np.asarray(values)
    if numbers.dtype.kind not in "iuf":
        numbers = numbers.astype(float)
    beyond = ~(np.abs(numbers.astype(float)) * _UNIT_US[unit] <= _FARTHEST_US)
    for row in np.flatnonzero(beyond)[:1]:
        found, expected = f"the time {numbers.ravel()[row]:g} {unit}", "a time within ten thousand years of 1970"
        likely = _likely_unit(float(numbers.ravel()[row]))
        mended = f"set the time's unit ({unit_key}: {likely})" if unit_key else f"write the times in {unit}"
        remedy = f"it looks like {likely}: {mended}" if likely else "mend or remove the record"
        raise InputError(f"{place}, record {row + 1}", found, expected, remedy)
    if numbers.dtype.kind in "iu":  # whole numbers stay exact: nanoseconds since 1970 exceed what a double holds
        whole = numbers.astype(np.int64)
        return (whole + 500) // 1000 if unit == "ns" else whole * int(_UNIT_US[unit])
    seconds = np.floor(numbers * _UNIT_US[unit] / 1e6)  # apart, so that no digit of the fraction is lost to rounding
    fraction = numbers * (_UNIT_US[unit] / 1e6) - seconds
    return seconds.astype(np.int64) * 1_000_000 + np.rint(fraction * 1e6).astype(np.int64)


def _likely_unit(value: float) -> TimeUnit | None:
    """The unit in which a number is a time of our days; None where it is none in any."""
    low_us, high_us = _LIKELY_US
    return next((unit for unit, unit_us in _UNIT_US.items() if low_us < value * unit_us < high_us), None)


def unix_from_gps(gps_us: ArrayLike) -> NDArray[np.int64]:
    """Unix time (us) of GPS time, microseconds since 1980-01-06 with leap seconds counted; same shape.

    Warns where a time lies beyond the date to which the leap seconds are known.
    """
    gps = np.asarray(gps_us, dtype=np.int64)
    leaps = leap_seconds()
    start_gps_us = leaps.start_us - GPS_EPOCH_US + leaps.total_s * 1_000_000
    unix = gps + GPS_EPOCH_US - _total_s(start_gps_us, gps) * 1_000_000
    if np.size(unix) and int(np.max(unix)) >= leaps.expires_us:
        log.warning(
            "time %s: leap seconds are known to %s; %d are assumed after it; update the package tzdata",
            _day(int(np.max(unix))),
            _day(leaps.expires_us),
            leaps.total_s[-1],
        )
    return np.asarray(unix, dtype=np.int64)


def gps_from_unix(unix_us: ArrayLike) -> NDArray[np.int64]:
    """GPS time (us since 1980-01-06) of Unix time (us); same shape."""
    unix = np.asarray(unix_us, dtype=np.int64)
    return np.asarray(unix - GPS_EPOCH_US + _total_s(leap_seconds().start_us, unix) * 1_000_000, dtype=np.int64)


def unix_from_week(week: ArrayLike, seconds: ArrayLike, place: str = "times") -> NDArray[np.int64]:
    """Unix time (us) of GPS weeks (counted on from 1980, never from 0 again) and seconds of week; same shape.

    Raises InputError naming the place and the record of a week that is none, as `microseconds` does of seconds.
    """
    weeks = np.asarray(week, dtype=float)
    for row in np.flatnonzero(~((weeks >= 0) & (weeks < _MOST_WEEKS)))[:1]:
        found, expected = f"GPS week {weeks.ravel()[row]:g}", f"0 to {_MOST_WEEKS}"
        raise InputError(f"{place}, record {row + 1}", found, expected, "mend or remove the record")
    whole = np.rint(weeks).astype(np.int64) * WEEK_US
    return unix_from_gps(whole + microseconds(np.asarray(seconds, dtype=float), "s", place))


def unix_from_week_of_first(
    week: int | None, of_week_us: NDArray[np.int64], place: str, remedy: str = "restore the file, or remove the record"
) -> NDArray[np.int64]:
    """Unix time (us) of times since the start of the week (K,), of which the first lies in `week`.

    Times that begin from 0 again are of the next week. Raises InputError where the week is not known, and with this
    `remedy` where a time lies in no week.
    """
    if week is None:
        raise InputError(
            place,
            "seconds of the GPS week without the week",
            "the week of the first record",
            "set source.navigation.gps_week",
        )
    for row in np.flatnonzero((of_week_us < 0) | (of_week_us > 2 * WEEK_US))[:1]:
        found, expected = f"{of_week_us[row] / 1e6:.3f} s of the GPS week", f"0 to {WEEK_US // 1_000_000}"
        raise InputError(f"{place}, record {row + 1}", found, expected, remedy)
    rollovers = np.cumsum(np.diff(of_week_us, prepend=of_week_us[:1]) < -WEEK_US // 2)
    return unix_from_gps((week + rollovers) * WEEK_US + of_week_us)


def week_at(unix_us: int) -> int:
    """The GPS week in which a Unix time (us) lies."""
    return int(gps_from_unix(unix_us)) // WEEK_US


def tell_lost_weeks(unix_us: int, place: str) -> None:
    """Warn of a time so old that 1024 weeks later is not in the future: the receiver may have lost them, or 2048."""
    lost = [n for n in (_LOST_WEEKS, 2 * _LOST_WEEKS) if unix_us + n * WEEK_US < leap_seconds().expires_us]
    if lost:
        days = " or ".join(f"{n} GPS weeks ({_day(unix_us + n * WEEK_US)})" for n in lost)
        told = "%s: times of %s: the receiver may have lost %s; if it has, add them to all its times (1024 weeks: %d s)"
        seconds = _LOST_WEEKS * WEEK_US // 1_000_000
        log.warning(told, place, _day(unix_us), days, seconds, extra={"cause": LOST_WEEKS})


def _total_s(start_us: NDArray[np.int64], time_us: NDArray[np.int64]) -> NDArray[np.int64]:
    total = np.concatenate([[0], leap_seconds().total_s])
    return np.asarray(total[np.searchsorted(start_us, time_us, side="right")])


def _day(unix_us: int) -> str:
    return str(np.datetime64(unix_us, "us").astype("datetime64[D]"))

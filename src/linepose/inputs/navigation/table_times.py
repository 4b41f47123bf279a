"""Times of a table's rows, in any clock and unit that devices write, as Unix time."""

import datetime
from typing import Final, Literal

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from linepose.errors import InputError
from linepose.inputs import gps_time

Stamps = NDArray[np.int64]
TableScale = Literal["unix", "gps", "gps_week", "iso", "gps_iso", "day", "gps_day"]

OF_TEXT: Final = {"iso", "gps_iso"}
OF_DAY: Final = {"day", "gps_day"}
_DAY_US: Final = 86_400_000_000


def unix_from_text(text: pd.Series, time_scale: str, time_format: str | None, place: str) -> Stamps:
    """Unix time (us) of dates and times as text (K,): of a format, or of ISO 8601, also with / in the date."""
    plain = text.str.strip()
    if not time_format:  # pandas does not know the decimal comma of ISO 8601
        plain = plain.str.replace("/", "-").str.replace(",", ".", regex=False)
    times = pd.to_datetime(plain, utc=True, format=time_format or "ISO8601", errors="coerce")
    for row in np.flatnonzero(times.isna().to_numpy())[:1]:
        expected = time_format or "a date and time such as 2026-05-01T12:00:00.25Z"
        remedy = "correct source.navigation.time_scale, or give the text's layout as time_format (%d.%m.%Y %H:%M:%S.%f)"
        raise InputError(place, repr(str(text.iloc[row])), expected, remedy)
    since_1970 = times.astype("datetime64[us, UTC]").astype("int64").to_numpy()
    if time_scale == "gps_iso":
        return gps_time.unix_from_gps(since_1970 - gps_time.GPS_EPOCH_US)
    return np.asarray(since_1970)


def unix_from_day(of_day_us: Stamps, day: datetime.date | None, time_scale: str, place: str) -> Stamps:
    """Unix time (us) of times since midnight (K,), of which the first is of `day`; those after midnight are told on.

    Raises InputError where the day is not known, or a time lies beyond a day.
    """
    if day is None:
        raise InputError(
            place, "seconds of the day without the day", "the day of the first record", "set source.navigation.date"
        )
    for row in np.flatnonzero((of_day_us < 0) | (of_day_us > 2 * _DAY_US))[:1]:
        found, expected = f"{of_day_us[row] / 1e6:.3f} s of the day", "0 to 86400"
        raise InputError(f"{place}, record {row + 1}", found, expected, "correct the time's unit or scale")
    midnights = np.cumsum(np.diff(of_day_us, prepend=of_day_us[:1]) < -_DAY_US // 2)
    start_us = int(datetime.datetime.combine(day, datetime.time(), datetime.UTC).timestamp()) * 1_000_000
    times = start_us + midnights * _DAY_US + of_day_us
    return gps_time.unix_from_gps(times - gps_time.GPS_EPOCH_US) if time_scale == "gps_day" else np.asarray(times)

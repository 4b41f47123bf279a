"""What pynmea2 makes of one NMEA 0183 sentence."""

import datetime
import re
from typing import Any, Final

SENTENCES: Final = "NMEA sentences"


def content_of(text: str) -> Any:
    """What pynmea2 makes of a sentence without its $, None for one that it does not know.

    Raises ValueError for text that is no sentence, or whose check sum is wrong.
    """
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


def date_of(content: Any) -> datetime.date | None:
    """The day that a sentence says."""
    date = _said(content, "datestamp")
    return date if isinstance(date, datetime.date) else None


def time_of_day_us(content: Any) -> int | None:
    """The time since midnight (us) that a sentence says."""
    time = _said(content, "timestamp")
    if not isinstance(time, datetime.time):
        return None
    return ((time.hour * 60 + time.minute) * 60 + time.second) * 1_000_000 + time.microsecond


def _said(content: Any, name: str) -> Any:
    """What a sentence says under this name of pynmea2; None where its words are empty or of no such thing."""
    try:
        return getattr(content, name, None)
    except (TypeError, ValueError, OverflowError):
        return None

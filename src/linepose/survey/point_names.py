"""Names of points: whole numbers where all of a survey's are, text otherwise; no name is an index into anything."""

import re
from collections.abc import Iterable
from typing import Final

import numpy as np
from numpy.typing import NDArray

Name = int | str
Names = NDArray[np.int64] | NDArray[np.str_]

WHAT: Final = "a whole number from 0, or a name"
_NUMBER: Final = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")
_NOTHING: Final = {"", "nan", "none", "null", "<na>"}
_LONGEST: Final = 80  # characters of a name
_LARGEST: Final = 2**63


def point_name(value: object) -> int | str | None:
    """A point's name: a whole number from 0 (7, 7.0, "07"), or text; None for what is neither.

    A number that is negative or broken is no name, nor is text that is empty, long or not printable.
    """
    if isinstance(value, int | np.integer):
        return int(value) if 0 <= value < _LARGEST else None
    text = str(value).strip()
    if _NUMBER.fullmatch(text):
        return _whole(text)
    named = text.lower() not in _NOTHING and len(text) <= _LONGEST and text.isprintable()
    return text if named and not isinstance(value, float | np.floating) else None


def _whole(text: str) -> int | None:
    if text.isdecimal():
        return int(text) if len(text.lstrip("0")) < len(str(_LARGEST)) else None
    number = float(text)
    return int(number) if number.is_integer() and 0 <= number < _LARGEST else None


def nameless(values: Iterable[object]) -> NDArray[np.int64]:
    """Rows of the values that are no names of points."""
    return np.array([row for row, value in enumerate(values) if point_name(value) is None], dtype=np.int64)


def point_names(values: Iterable[object]) -> Names:
    """Names (K,) of values that `nameless` has nothing against: whole numbers if all of them are, else all text."""
    array = np.asarray(values)
    if array.dtype.kind in "iu":
        return array.astype(np.int64)
    names = [point_name(value) for value in array.tolist()]
    if all(isinstance(name, int) for name in names):
        return np.array(names, dtype=np.int64)
    return np.array([str(name) for name in names], dtype=np.str_)


def in_words(names: Iterable[object], most: int = 8) -> str:
    """Names in a sentence: "3, 5, gate", or the first of many and how many more."""
    listed = [str(name) for name in names]
    if len(listed) <= most:
        return ", ".join(listed)
    return f"{', '.join(listed[:most])} and {len(listed) - most} more"

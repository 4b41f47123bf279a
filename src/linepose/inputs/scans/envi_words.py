"""Values of ENVI headers that people and programs write in words: the order of values and bytes, the type."""

import re
from typing import Final

from linepose.inputs.scans.header_layout import Interleave

_ORDERS: Final[dict[Interleave, str]] = {
    "bil": r"\bbil\b|(\bby |^)lines?$",
    "bip": r"\bbip\b|(\bby |^)pixels?$",
    "bsq": r"\bbsq\b|\bsequential\b",
}
_BYTE_ORDERS: Final = (
    r"\b(little|intel|lsb|lsf|least)|\ble\b",
    r"\b(big|network|motorola|msb|msf|most)|\bbe\b",
)
_DIGIT: Final = re.compile(r"[{\s]*\+?0*([01])(\.0*)?(?![\w.])")
_CODE: Final = re.compile(r"(\d{1,3})(\.0*)?(\s*[-:=(,]\s*[^\d\s].*)?")
_WIDTH: Final = re.compile(r"\s*-?\s*(byte|bit)", re.IGNORECASE)
_BYTE: Final = 1  # the one code that is also the type's width
_TYPES: Final = {
    "byte": 1,
    "uint8": 1,
    "int16": 2,
    "int32": 3,
    "float32": 4,
    "float64": 5,
    "uint16": 12,
    "uint32": 13,
    "int64": 14,
    "uint64": 15,
}


def interleave_of(text: str) -> Interleave | None:
    """The order of values that a text says ("Bil", "BIL (by line)", "Band Sequential"); None where none or several."""
    found = [order for order, words in _ORDERS.items() if re.search(words, text.strip().lower())]
    return found[0] if len(found) == 1 else None


def byte_order_of(text: str) -> int | None:
    """0 of the least significant byte first, 1 of the most ("1", "Host (Intel)", "ieee-be"); None of other texts.

    A digit that a text begins with decides.
    """
    digit = _DIGIT.match(text)
    if digit:
        return int(digit[1])
    found = [order for order, words in enumerate(_BYTE_ORDERS) if re.search(words, text.lower())]
    return found[0] if len(found) == 1 else None


def data_type_of(text: str) -> int | None:
    """ENVI's code of a type ("12", "12 - unsigned integer", "uint16"); None of other texts and of a width in bytes."""
    match = _CODE.fullmatch(text.strip())
    if match is None:
        return _TYPES.get(text.strip().lower())
    code = int(match[1])
    return None if code != _BYTE and _WIDTH.match(match[3] or "") else code

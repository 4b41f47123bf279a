"""Values of ENVI headers that people and programs write in words: the order of values and bytes, the type."""

import re
from typing import Final

from linepose.inputs.scans.header_layout import Interleave

_ORDERS: Final[dict[Interleave, str]] = {
    "bil": r"\bbil\b|(\bby |^)lines?$",
    "bip": r"\bbip\b|(\bby |^)pixels?$",
    "bsq": r"\bbsq\b|\bsequential\b",
}
_BYTE_ORDERS: Final = (r"\b(little|intel|lsb|lsf|least)", r"\b(big|network|ieee|motorola|msb|msf|most)")
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
    """0 of the least significant byte first, 1 of the most ("1", "Host (Intel)", "big endian"); None of other texts."""
    if text.strip("{} ") in {"0", "1"}:
        return int(text.strip("{} "))
    found = [order for order, words in enumerate(_BYTE_ORDERS) if re.search(words, text.lower())]
    return found[0] if len(found) == 1 else None


def data_type_of(text: str) -> int | None:
    """ENVI's code of a type ("12", "12 - unsigned integer", "uint16"); None of another text."""
    match = re.fullmatch(r"(\d{1,3})(\.0*)?(\s*[-:=(,][^\d]*)?", text.strip())
    return int(match[1]) if match else _TYPES.get(text.strip().lower())

"""Headers of ArcGIS's BIL, BIP and BSQ images: a key and a value a line, apart by blanks, in any order and case."""

import logging
import re
from collections.abc import Iterable
from pathlib import Path
from typing import Final, NoReturn

from linepose.errors import InputError
from linepose.inputs.scans.header_layout import LARGEST, EnviHeader, Interleave

_TYPES: Final = {  # ENVI's code by PIXELTYPE and NBITS
    ("UNSIGNEDINT", 8): 1,
    ("UNSIGNEDINT", 16): 12,
    ("SIGNEDINT", 16): 2,
    ("UNSIGNEDINT", 32): 13,
    ("SIGNEDINT", 32): 3,
    ("FLOAT", 32): 4,
    ("FLOAT", 64): 5,
}
_LAYOUTS: Final[dict[str, Interleave]] = {"BIL": "bil", "BIP": "bip", "BSQ": "bsq"}
_BYTE_ORDERS: Final = {"I": 0, "LSBFIRST": 0, "M": 1, "MSBFIRST": 1}
_ROW: Final = re.compile(r"\s*(\w+)\s+(\S+)")
_LARGEST_SKIP_BYTES: Final = 2**40

log = logging.getLogger(__name__)


def is_arcgis(text: str) -> bool:
    """Whether the text of a header says rows and columns as ArcGIS does."""
    return all(re.search(rf"^[ \t]*{key}[ \t]+\d", text, re.IGNORECASE | re.MULTILINE) for key in ("NROWS", "NCOLS"))


def arcgis_header(text: str, path: Path) -> EnviHeader:
    """The layout that such a header describes; raises InputError naming the line and what is wrong with it."""
    words = _Words(text, path)
    columns, bands = words.whole("NCOLS", None, 1, LARGEST["samples"]), words.whole("NBANDS", 1, 1, LARGEST["bands"])
    bits, kind = words.whole("NBITS", 8, 1, 64), words.one_of("PIXELTYPE", "UNSIGNEDINT", {kind for kind, _ in _TYPES})
    if (kind, bits) not in _TYPES:
        words.refuse("NBITS", f"{kind} of {bits} bits", "8, 16 or 32 bits, or FLOAT of 32 or 64", "convert the scan")
    if bits > 8 and "BYTEORDER" not in words.values:
        log.warning("%s: no BYTEORDER: read as I, little-endian", path)
    band_row = columns * bits // 8
    for key, packed in (("BANDROWBYTES", band_row), ("TOTALROWBYTES", band_row * bands), ("BANDGAPBYTES", 0)):
        if words.whole(key, packed, 0, _LARGEST_SKIP_BYTES) != packed:
            words.refuse(key, words.values[key][0], f"{packed}, as of lines without gaps", "save the scan without gaps")
    return EnviHeader(
        lines=words.whole("NROWS", None, 1, LARGEST["lines"]),
        samples=columns,
        bands=bands,
        data_type=_TYPES[kind, bits],
        interleave=_LAYOUTS[words.one_of("LAYOUT", "BIL", _LAYOUTS)],
        byte_order=_BYTE_ORDERS[words.one_of("BYTEORDER", "I", _BYTE_ORDERS)],
        offset=words.whole("SKIPBYTES", 0, 0, _LARGEST_SKIP_BYTES),
    )


class _Words:
    """Values of a header by their keys in upper case, each with its line (from 1)."""

    def __init__(self, text: str, path: Path) -> None:
        self.path, self.values = path, dict[str, tuple[str, int]]()
        for line, row in enumerate(text.splitlines(), start=1):
            match = _ROW.match(row)
            if match:
                self.values.setdefault(match[1].upper(), (match[2].upper(), line))

    def whole(self, key: str, default: int | None, least: int, most: int) -> int:
        """A whole number within these bounds; the default where there is none."""
        if key not in self.values and default is not None:
            return default
        word = self.values.get(key, ("nothing", 1))[0]
        if not re.fullmatch(r"\d{1,18}", word) or not least <= int(word) <= most:
            self.refuse(key, repr(word[:60]), f"a whole number from {least} to {most}", "restore the header")
        return int(word)

    def one_of(self, key: str, default: str, allowed: Iterable[str]) -> str:
        """A word of those that are allowed; the default where there is none."""
        word = self.values.get(key, (default, 0))[0]
        if word not in allowed:
            self.refuse(key, repr(word[:60]), f"one of {', '.join(sorted(allowed))}", "restore the header")
        return word

    def refuse(self, key: str, found: str, expected: str, remedy: str) -> NoReturn:
        """Raise the InputError of a value."""
        raise InputError(f"{self.path}, line {self.values.get(key, ('', 1))[1]}, {key}", found, expected, remedy)

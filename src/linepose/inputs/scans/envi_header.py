"""ENVI headers as instruments and programs write them: `key = value` in any order, case and spacing.

Keys that ENVI itself does without (`byte order`, `header offset`, `file type`) may be missing. Text that is not UTF-8,
byte order marks, comments (`;`), blank lines and lists over many lines are read; a fault is told with its line.
"""

import codecs
import logging
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from linepose.errors import InputError
from linepose.inputs.scans.arcgis_header import arcgis_header, is_arcgis
from linepose.inputs.scans.envi_words import byte_order_of, data_type_of, interleave_of
from linepose.inputs.scans.header_layout import LARGEST, EnviHeader, Interleave

_LARGEST_HEADER_BYTES: Final = 50_000_000
_LARGEST_OFFSET_BYTES: Final = 2**40
_REAL_TYPES: Final = {1, 2, 3, 4, 5, 12, 13, 14, 15}  # ENVI's codes of numbers that are not complex
_ONE_BYTE: Final = 1  # ENVI's code of numbers whose byte order does not matter
_INTERLEAVES: Final = ("bil", "bip", "bsq")
_NO_IMAGE: Final = ("library", "virtual", "mosaic", "meta", "tiff", "jpeg", "png", "nitf", "hdf")  # in a `file type`
_MARKS: Final = {codecs.BOM_UTF16_LE: "utf-16", codecs.BOM_UTF16_BE: "utf-16", codecs.BOM_UTF8: "utf-8-sig"}
_BRIEFLY: Final = 60

log = logging.getLogger(__name__)


@dataclass(frozen=True)
class _Entry:
    """Text of a value, and the line (counted from 1) on which its key stands."""

    text: str
    line: int


def read_envi_header(path: Path) -> EnviHeader:
    """The layout that a header file describes; raises InputError naming the line and what is wrong with it.

    A header without the word ENVI that says rows and columns as ArcGIS does is read as ArcGIS's.
    """
    text = _text(path)
    if not _is_envi(text) and is_arcgis(text):
        return arcgis_header(text, path)
    entries = _entries(text, path)
    frames = [name for name in ("major frame offsets", "minor frame offsets") if name in entries]
    for name in frames:
        if re.search(r"[1-9]", entries[name].text):
            raise _fault(entries, name, path, "0, 0", "save the scan without frame offsets")
    _check_file_type(entries, path)
    if entries.get("file compression", _Entry("0", 0)).text not in {"0", ""}:
        raise _fault(entries, "file compression", path, "0", "save the scan without compression")
    sizes = {key: _whole(entries, key, path, int(key != "lines"), most) for key, most in LARGEST.items()}
    data_type = data_type_of(_needed(entries, "data type", path))
    if data_type not in _REAL_TYPES:
        expected = f"one of ENVI's types {', '.join(map(str, sorted(_REAL_TYPES)))}"
        raise _fault(entries, "data type", path, expected, "convert the scan, for example to uint16 (12)")
    interleave = _interleave(entries, sizes["bands"], path)
    byte_order = _byte_order(entries, path)
    offset = _whole(entries, "header offset", path, 0, _LARGEST_OFFSET_BYTES) if "header offset" in entries else 0
    missing = [key for key in ("byte order", "header offset") if key not in entries]
    if data_type == _ONE_BYTE and "byte order" in missing:
        missing.remove("byte order")
    if missing:
        log.warning("%s: no %s: read as 0, as ENVI does", path, " and no ".join(missing))
    data_file = _name_alone(entries["data file"].text) if "data file" in entries else None
    return EnviHeader(
        **sizes,
        data_type=data_type,
        interleave=interleave,
        byte_order=byte_order,
        offset=offset,
        data_file=data_file,
    )


def header_words(path: Path) -> dict[str, str]:
    """Every value of a header as text, by its key in lower case."""
    text = _text(path)
    if not _is_envi(text) and is_arcgis(text):
        return {}
    return {key: entry.text for key, entry in _entries(text, path).items()}


def data_files(path: Path) -> list[str]:
    """The name of the data file that a header says, in a list; none where it says none or is no header."""
    if path.suffix.lower() != ".hdr":
        return []
    try:
        name = header_words(path).get("data file")
    except (InputError, OSError):
        return []
    return [] if name is None else [_name_alone(name)]


def _name_alone(data_file: str) -> str:
    """The name of a file without the folders of the machine on which it was recorded."""
    return data_file.strip("{}\"' ").replace("\\", "/").rpartition("/")[2]


def _is_envi(text: str) -> bool:
    return bool(re.match(r"\s*ENVI\b", text, re.IGNORECASE))


def _text(path: Path) -> str:
    with path.open("rb") as file:
        content = file.read(_LARGEST_HEADER_BYTES + 1)
    if len(content) > _LARGEST_HEADER_BYTES:
        found, expected = f"more than {_LARGEST_HEADER_BYTES} bytes", "an ENVI header"
        raise InputError(str(path), found, expected, "restore the header, or correct source.scans")
    encoding = next((name for mark, name in _MARKS.items() if content.startswith(mark)), "utf-8")
    try:
        return content.decode(encoding)
    except UnicodeDecodeError:
        return content.decode("latin-1")


def _entries(text: str, path: Path) -> dict[str, _Entry]:
    """Values by their keys in lower case; raises InputError where the text is no header, or gives a key two values."""
    lines = [line.strip() for line in re.split(r"\r\n|\r|\n", text)]
    first = next((row for row, line in enumerate(lines) if line), 0)
    if not re.match(r"ENVI\b", lines[first], re.IGNORECASE):
        raise InputError(
            f"{path}, line {first + 1}",
            "no ENVI header",
            "the word ENVI",
            "restore the header, or correct source.scans",
        )
    entries: dict[str, _Entry] = {}
    row = first + 1
    while row < len(lines):
        line, start = lines[row], row + 1
        row += 1
        if line.startswith(";") or "=" not in line:
            continue
        key, value = (part.strip() for part in line.split("=", 1))
        key = " ".join(key.lower().replace("_", " ").split())
        if value.startswith("{"):
            parts = [value]
            while "}" not in parts[-1] and row < len(lines):
                if not lines[row].startswith(";"):
                    parts.append(lines[row])
                row += 1
            if "}" not in parts[-1]:
                raise InputError(f"{path}, line {start}, {key}", "a list without an end", "}", "restore the header")
            value = "\n".join(parts)
        else:
            value = value.split(";", 1)[0].strip().strip("\"'")
        if not value and key in _UNFILLED:
            continue
        entry = entries.setdefault(key, _Entry(value, start))
        if key in _USED and entry.text.lower() != value.lower():
            place, found = f"{path}, line {start}, {key}", repr(value[:_BRIEFLY])
            expected = f"one value; line {entry.line} says {entry.text[:_BRIEFLY]!r}"
            raise InputError(place, found, expected, "remove the line that is wrong")
    return entries


_UNFILLED: Final = {"byte order", "header offset", "file type", "data file"}  # as good as missing without a value
_USED: Final = {*LARGEST, "data type", "interleave", "byte order", "header offset", "file type", "data file"}


def _check_file_type(entries: dict[str, _Entry], path: Path) -> None:
    """Words that programs make up (ENVI, PCI, ...) mean the plain image; what surely is none is refused."""
    if "file type" in entries and any(word in entries["file type"].text.lower() for word in _NO_IMAGE):
        raise _fault(entries, "file type", path, "ENVI Standard", "convert the scan")


def _interleave(entries: dict[str, _Entry], n_bands: int, path: Path) -> Interleave:
    """The order of the values; of one band, all orders are the same."""
    if "interleave" not in entries and n_bands == 1:
        return "bil"
    if "interleave" not in entries:
        raise InputError(
            f"{path}: interleave", "no such key", f"one of {', '.join(_INTERLEAVES)}", "restore the header"
        )
    found = interleave_of(entries["interleave"].text)
    if found is None:
        raise _fault(entries, "interleave", path, f"one of {', '.join(_INTERLEAVES)}", "restore the header")
    return found


def _byte_order(entries: dict[str, _Entry], path: Path) -> int:
    """0, the least significant byte first, where the header does not say it."""
    if "byte order" not in entries:
        return 0
    found = byte_order_of(entries["byte order"].text)
    if found is None:
        raise _fault(entries, "byte order", path, "0 (little-endian) or 1 (big-endian)", "restore the header")
    return found


def _needed(entries: dict[str, _Entry], key: str, path: Path, expected: str = "a whole number") -> str:
    """The text of a key that is needed."""
    if key not in entries:
        raise InputError(f"{path}: {key}", "no such key", expected, "restore the header")
    return entries[key].text


def _whole(entries: dict[str, _Entry], key: str, path: Path, least: int, most: int) -> int:
    """A whole number of a key that is needed, within these bounds."""
    match = re.fullmatch(r"([+-]?\d{1,30})(\.0*)?", _needed(entries, key, path))
    if match is None:
        raise _fault(entries, key, path, "a whole number", "restore the header")
    number = int(match[1])
    if not least <= number <= most:
        raise _fault(entries, key, path, f"{least} to {most}", "restore the header")
    return number


def _fault(entries: dict[str, _Entry], key: str, path: Path, expected: str, remedy: str) -> InputError:
    entry = entries[key]
    found = entry.text if re.fullmatch(r"[+-]?\d+", entry.text) else repr(entry.text)
    return InputError(f"{path}, line {entry.line}, {key}", found[:_BRIEFLY], expected, remedy)

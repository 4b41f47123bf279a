"""Messages of a NovAtel receiver's log, ASCII and binary mixed as they come, by the vendor's own decoder."""

import re
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, BinaryIO, Final

from linepose.errors import InputError
from linepose.inputs.text_files import LONGEST_LINE

_MESSAGE: Final = re.compile(rb"([#%]\w+A(?:_\d)?,[^\r\n]*\*[0-9a-fA-F]{8})(\r*\n|\r+(?!\n)|\Z)")  # and its line end
_MOST_TOGETHER: Final = 100_000
_NMEA: Final = re.compile(rb"\$[A-Z]{2,}[ -#%-)+-~]*(\*[0-9A-Fa-f]{2})?\s*")  # of another port's log in the same file


@dataclass(frozen=True)
class UnknownBytes:
    """So many bytes of a log that belong to no message."""

    count: int


def messages(path: Path) -> Iterator[Any]:
    """Every message of a log in its order, and `UnknownBytes` where there is none.

    Raises InputError naming the place of a megabyte without one, as of zeros.
    """
    from novatel_edie import UnknownBytes as Unknown
    from novatel_edie.oem import FileParser

    strange = b""  # in pieces, as the decoder gives up on them
    with _with_line_ends(path) as framed:
        parser = FileParser(str(framed))
        for message in parser:
            if isinstance(message, Unknown):
                strange += bytes(message.data)
            if strange and (not isinstance(message, Unknown) or len(strange) > _MOST_TOGETHER):
                yield UnknownBytes(_strange(strange))
                strange = b""
            if not isinstance(message, Unknown):
                yield message
        left = int(str(parser.flush()))  # what the file ends with and is no whole message
        yield UnknownBytes(_strange(strange) + left)


def _strange(data: bytes) -> int:
    """How many of these bytes are no NMEA sentences, nor blanks beside those."""
    return len(_NMEA.sub(b"", data).strip())


@contextmanager
def _with_line_ends(path: Path) -> Iterator[Path]:
    """The log itself, or where ASCII messages do not end in CR LF, as editors and copies leave them, a copy with it.

    The parser finds messages by CR LF, which the check sum does not cover. Binary messages are kept byte by byte.
    """
    with path.open("rb") as file:
        whole = all(found[2] == b"\r\n" for line in _lines(file, path) for found in _MESSAGE.finditer(line))
    if whole:
        yield path
        return
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder) / path.name
        with path.open("rb") as file, copy.open("wb") as framed:
            framed.writelines(_MESSAGE.sub(rb"\1\r\n", line) for line in _lines(file, path))
        yield copy


def _lines(file: BinaryIO, path: Path) -> Iterator[bytes]:
    """The bytes of a log, cut behind line ends; raises InputError naming the place of a megabyte without any."""
    rest, before = b"", 0
    while piece := file.readline(LONGEST_LINE):
        rest += piece
        end = max(rest.rfind(b"\n"), rest.rfind(b"\r")) + 1
        if not end and len(rest) >= LONGEST_LINE:
            found, remedy = f"{LONGEST_LINE} bytes without a message", "give the log itself, or cut it there"
            raise InputError(f"{path}, byte {before + 1}", found, "an ASCII or binary log of NovAtel", remedy)
        if end:
            yield rest[:end]
        rest, before = rest[end:], before + end
    if rest:
        yield rest

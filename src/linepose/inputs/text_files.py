"""Text files that a platform's file names: small ones that a person writes, and whether a large one is text."""

import codecs
import os
import re
from collections.abc import Iterator
from itertools import count
from pathlib import Path
from typing import Final

from linepose.errors import InputError

_MOST_BYTES: Final = 10_000_000
_FIRST_BYTES: Final = 4096
LONGEST_LINE: Final = 1_000_000  # of a log with a gap of zeros too, which a recorder leaves that loses its power


def small_text(path: Path, what: str, key: str) -> str:
    """The text of a file in UTF-8, with or without a mark of it.

    `what` is expected there, and named by `key`. Raises InputError for what is no regular file, a file above 10 MB, and
    bytes that are no such text.
    """
    if not path.exists():
        raise InputError(str(path), "no such file", what, f"correct {key}")
    if not path.is_file():
        raise InputError(str(path), "a folder" if path.is_dir() else "a device or pipe", what, f"correct {key}")
    n_bytes = path.stat().st_size
    if n_bytes > _MOST_BYTES:
        raise InputError(str(path), f"{n_bytes} bytes", f"{what}, at most {_MOST_BYTES} bytes", f"correct {key}")
    try:
        text = path.read_text(encoding="utf-8-sig")
    except OSError as error:
        raise _unreadable(path, what, error) from None
    except UnicodeDecodeError:
        text = "\0"
    if "\0" in text:
        raise InputError(str(path), "bytes that are no text in UTF-8", what, "save it as UTF-8")
    return text


def check_text(
    path: Path, what: str, remedy: str = "give the file itself, saved as UTF-8 text", in_lines: bool = True
) -> None:
    """Raise InputError where a file is no text, before all of a large one is read.

    That is one that cannot be read, begins with bytes that are no text, or with a line of a megabyte where it should be
    `in_lines`.
    """
    try:
        with path.open("rb") as file:
            head = file.read(_FIRST_BYTES)
            if in_lines and not re.search(rb"[\r\n]", head):
                head += file.readline(LONGEST_LINE)
    except OSError as error:
        raise _unreadable(path, what, error) from None
    is_utf_16 = head.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE))
    if b"\0" in head[:_FIRST_BYTES] and not is_utf_16:
        raise InputError(str(path), "bytes that are not text", what, remedy)
    if in_lines and len(head) > LONGEST_LINE:
        raise _too_long(f"{path}, line 1", what, remedy)


def lines_of(path: Path, what: str, encoding: str = "ascii", errors: str = "replace") -> Iterator[str]:
    """The lines of a text as they are read; raises InputError naming one that has no end within a megabyte."""
    with path.open(encoding=encoding, errors=errors) as file:
        for number in count(1):
            line = file.readline(LONGEST_LINE + 1)
            if len(line) > LONGEST_LINE:
                raise _too_long(f"{path}, line {number}", what, "give the log itself, or cut it there")
            if not line:
                return
            yield line


def _too_long(place: str, what: str, remedy: str) -> InputError:
    return InputError(place, f"no line end within {LONGEST_LINE} bytes", f"lines of {what}", remedy)


def _unreadable(path: Path, what: str, error: OSError) -> InputError:
    if isinstance(error, PermissionError):
        return InputError(str(path), "a file that may not be read", what, "get the right to read it")
    return InputError(str(path), os.strerror(error.errno or 0).lower(), what, "restore it, or give another file")

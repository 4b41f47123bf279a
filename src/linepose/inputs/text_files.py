"""Text files that a platform's file names: small ones that a person writes, and whether a large one is text."""

import codecs
from pathlib import Path
from typing import Final

from linepose.errors import InputError

_MOST_BYTES: Final = 10_000_000
_FIRST_BYTES: Final = 4096


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
    except PermissionError:
        raise InputError(str(path), "a file that may not be read", what, "get the right to read it") from None
    except UnicodeDecodeError:
        text = "\0"
    if "\0" in text:
        raise InputError(str(path), "bytes that are no text in UTF-8", what, "save it as UTF-8")
    return text


def check_text(path: Path, what: str, remedy: str = "give the file itself, saved as UTF-8 text") -> None:
    """Raise InputError where a file begins with bytes that are no text, before all of a large one is read."""
    with path.open("rb") as file:
        head = file.read(_FIRST_BYTES)
        if b"\0" in head and not head.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
            raise InputError(str(path), "bytes that are not text", what, remedy)

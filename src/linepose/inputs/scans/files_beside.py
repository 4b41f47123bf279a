"""Text files of time stamps that recorders put beside a scan."""

from collections.abc import Sequence
from pathlib import Path

from linepose.errors import InputError
from linepose.inputs.patterns import check_readable, in_any_case


def first_file(names: Sequence[str], scan: Path) -> Path:
    """The first of these files that stands beside a scan, in any case; raises InputError where none does."""
    for path in (in_any_case(scan.parent / name) for name in names):
        if path.is_file():
            check_readable(path)
            return path
    found = f"no {' or '.join(dict.fromkeys(names))} beside it"
    raise InputError(
        str(scan), found, "what its time stamps are made of", "put the file there, or correct source.time_stamps"
    )


def rows_of(path: Path) -> list[str]:
    """The rows of a text file; raises InputError where it has none, or is no text."""
    try:
        rows = path.read_text(encoding="utf-8-sig").rstrip().splitlines()
    except UnicodeDecodeError:
        raise InputError(str(path), "bytes that are no text", "time stamps", "restore the file") from None
    if not rows:
        raise InputError(str(path), "an empty file", "time stamps", "restore it")
    return rows

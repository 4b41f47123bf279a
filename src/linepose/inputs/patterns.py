"""Names and patterns of files below a data set's folder, as a platform file gives them."""

import os
import re
from collections.abc import Sequence
from fnmatch import fnmatchcase
from pathlib import Path, PurePosixPath
from typing import Annotated, Final

from pydantic import AfterValidator

from linepose.errors import InputError

_SIGNS: Final = re.compile(r"[*?\[]")
_FOLDER: Final = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_.-]*(?<!\.)", re.ASCII)
_MOST_CHARACTERS: Final = 1_000


def _is_below(pattern: str) -> str:
    path = PurePosixPath(pattern)
    if not path.parts or path.is_absolute() or not pattern.isprintable() or len(pattern) > _MOST_CHARACTERS:
        raise ValueError("a file, or a pattern of files, below the data set's folder")
    if any(sign in pattern for sign in "{}"):
        raise ValueError("a name without braces, in which the workflow would look for its own words")
    if ".." in path.parts:
        raise ValueError("a file below the data set's folder, not one above it")
    if "**" in pattern and any("**" in part and part != "**" for part in path.parts):
        raise ValueError("** as the whole name of a folder")
    return pattern


def _is_folder(name: str) -> str:
    if not _FOLDER.fullmatch(name):
        raise ValueError("the name of a folder: letters, digits, -, _ and dots within")
    return name


Files = Annotated[str, AfterValidator(_is_below)]
Dataset = Annotated[str, AfterValidator(_is_folder)]


def matching(folder: Path, pattern: str) -> list[Path]:
    """The files of a folder that a name or a pattern is of, sorted by name; a file of just this name comes first.

    Raises InputError where one has a name that the workflow cannot have, may not be read, or is a device or pipe, which
    has no end.
    """
    exact = folder / pattern
    is_name = bool(_SIGNS.search(pattern)) and exact.exists()
    found = [exact] if is_name else sorted(folder.glob(pattern))
    for path in found:
        if path.exists() and not path.is_file() and not path.is_dir():
            raise InputError(str(path), "a device or pipe", "a file", "put the file itself there")
        check_readable(path)
    if is_name:
        return found
    for path in found:
        if any(sign in path.relative_to(folder).as_posix() for sign in "{}"):
            expected = "a name without braces, in which the workflow would look for its own words"
            raise InputError(str(path), "braces in a file's name", expected, "rename the file")
    return found


def check_readable(path: Path) -> None:
    """Raise InputError for a file that is there and may not be read."""
    if path.exists() and not os.access(path, os.R_OK):
        raise InputError(str(path), "a file that may not be read", "one that may", "get the right to read it")


def is_of(name: str, pattern: str) -> bool:
    """Whether `matching` would find a file of this name, below the folder, by a name or pattern."""
    parts, wanted = PurePosixPath(name).parts, PurePosixPath(pattern).parts
    return parts == wanted or _fit(parts, wanted)


def _fit(parts: Sequence[str], wanted: Sequence[str]) -> bool:
    if not wanted:
        return not parts
    if wanted[0] == "**":
        return any(_fit(parts[k:], wanted[1:]) for k in range(len(parts)))
    return bool(parts) and fnmatchcase(parts[0], wanted[0]) and _fit(parts[1:], wanted[1:])


def in_any_case(path: Path) -> Path:
    """The file itself, or where there is none the only one beside it whose name differs in upper and lower case."""
    if path.exists() or not path.parent.is_dir():
        return path
    alike = [one for one in path.parent.iterdir() if one.name.lower() == path.name.lower()]
    return alike[0] if len(alike) == 1 else path

"""Platforms by pattern: `fleet-*` under `platforms` names every platform file that it fits."""

from collections.abc import Sequence
from fnmatch import fnmatchcase
from pathlib import Path

from linepose.config.names import check_name
from linepose.errors import InputError


def is_pattern(name: str) -> bool:
    """Whether a name has a sign that stands for others: * for any, ? for one, [] for one of those within."""
    return any(sign in name for sign in "*?[")


def fits(name: str, pattern: str) -> bool:
    """Whether a platform's name is the one given, or fits the pattern."""
    return fnmatchcase(name, pattern) if is_pattern(pattern) else name == pattern


def named_platforms(given: Sequence[str], folder: Path, place: str = "config/config.yaml: platforms") -> list[str]:
    """The platforms that names and patterns name, each once; those of a pattern by name, in the place of the pattern.

    Raises InputError for a name that is none, or is given twice, and for a pattern that fits no file of the folder. A
    pattern passes over what is named already.
    """
    written = [check_name(name, place) for name in given if not is_pattern(name)]
    if twice := next((name for name in written if written.count(name) > 1), None):
        raise InputError(place, f"{twice} twice", "each platform once", "remove one of them")
    names: dict[str, None] = {}
    files = sorted(path.stem for path in folder.glob("*.yaml"))
    for name in given:
        found = [file for file in files if fits(file, name)] if is_pattern(name) else [name]
        if not found:
            raise InputError(
                place,
                f"{name!r}, which fits no file of {folder}",
                f"a pattern of {', '.join(files) or 'files that are there'}",
                "correct it, or make a platform with `linepose new NAME`",
            )
        names |= dict.fromkeys(found)
    return list(names)

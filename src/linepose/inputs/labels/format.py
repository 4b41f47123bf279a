"""A format of labels that a person's tool writes, and what its readers have in common."""

import json
import logging
from collections.abc import Callable
from dataclasses import dataclass
from itertools import takewhile
from pathlib import Path
from typing import Any, Final

from linepose.errors import InputError
from linepose.inputs.labels.clicked import Clicked
from linepose.inputs.text_files import check_text

_LONGEST_HEAD: Final = 10_000  # characters

log = logging.getLogger(__name__)


@dataclass(frozen=True)
class LabelFormat:
    """The tool's name, the ending of its files, whether a file's content is of it, and how a file is read.

    `recognises` and `read` get the content of JSON, the lines of CSV up to its heading, None of any other file.
    """

    tool: str
    suffix: str
    recognises: Callable[[Any], bool]
    read: Callable[[Path, Any], list[Clicked]]


def read_json(path: Path) -> Any:
    """The content of a JSON file; raises InputError where it is none."""
    check_text(path, "labels in JSON", in_lines=False)
    try:
        return json.loads(path.read_text(encoding="utf-8-sig"))
    except (ValueError, RecursionError, OSError) as error:
        found = " ".join(str(error).split())[:200]
        raise InputError(str(path), found, "labels in JSON", "restore the file") from None


def read_head(path: Path) -> tuple[str, ...]:
    """The lines of a CSV up to the first that is neither empty nor a comment; raises InputError where it is no text."""
    check_text(path, "labels in CSV")
    with path.open(encoding="utf-8-sig", errors="replace") as file:
        lines = file.read(_LONGEST_HEAD).split("\n")
    above = sum(1 for _ in takewhile(lambda line: not line.strip() or line.lstrip().startswith("#"), lines))
    return tuple(line.strip() for line in lines[: above + 1])


def entries(value: Any) -> list[dict[str, Any]]:
    """The mappings in a list, or in a mapping's values; none of anything else."""
    values = value.values() if isinstance(value, dict) else value if isinstance(value, list) else ()
    return [one for one in values if isinstance(one, dict)]


def tell_passed_over(path: Path, counts: dict[str, int]) -> None:
    """Say how many of what a reader has passed over, where it has."""
    told = ", ".join(f"{count} {what}" for what, count in counts.items() if count)
    if told:
        log.warning("%s: passed over: %s", path, told)

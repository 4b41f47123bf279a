"""Names of platforms and data sets: what a file, a rule of the workflow and a command line can all have."""

import re
from typing import Final

from linepose.errors import InputError

_NAME: Final = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_.-]*(?<!\.)", re.ASCII)
_RESERVED: Final = frozenset(  # folders of results that are no platform's
    {"compiled", "coverage", "datasets", "logs", "paper", "regression", "report", "report.html", "tables"}
)


def check_name(name: object, place: str = "platform's name") -> str:
    """The name of a platform; raises InputError for one that no file or rule can have."""
    if not isinstance(name, str) or not _NAME.fullmatch(name):
        raise InputError(place, repr(name), "letters, digits, - and _", "choose such a name")
    if name.lower() in _RESERVED:
        raise InputError(
            place, f"{name!r}, a folder of results that is no platform's", "a name of its own", "choose another"
        )
    return name


def is_name(text: str) -> bool:
    """Whether a text is a name of letters, digits, -, _ and dots within."""
    return bool(_NAME.fullmatch(text))

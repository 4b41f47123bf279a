"""Errors that a user can act on: one line that says where, what was found, what was expected, what to do."""

import errno
import os
from typing import Final

_OF_THE_DISK: Final = {
    errno.ENOSPC: "make room on it",
    errno.EDQUOT: "make room within the quota",
    errno.EFBIG: "raise the limit of a file's size (ulimit -f), or work on a disk that takes larger files",
    errno.EROFS: "work on one that can be written",
}
_OF_RIGHTS: Final = {errno.EACCES, errno.EPERM}
_MOST_CHARACTERS: Final = 600  # of each part of a message: what a file holds may be a million


class LineposeError(Exception):
    """Base of every error that linepose raises for its user; `str(error)` is one line.

    Examples
    --------
    >>> import linepose
    >>> issubclass(linepose.InputError, linepose.LineposeError)
    True
    """


class InputError(LineposeError):
    """An input that cannot be used.

    Parameters
    ----------
    place : str
        The file and, where there is one, the row, key or column.
    found, expected : str
        What stands there, and what should.
    remedy : str
        What to do, as an imperative.

    Examples
    --------
    >>> import linepose
    >>> try:
    ...     linepose.Search(half_width_m=-1.0)
    ... except linepose.InputError as error:
    ...     print(error)
    Search: half_width_m: found -1.0, expected greater than 0; correct the value
    """

    def __init__(self, place: str, found: str, expected: str, remedy: str) -> None:
        self.place, self.found = printable(place), printable(found)
        self.expected, self.remedy = printable(expected), printable(remedy)
        super().__init__(f"{self.place}: found {self.found}, expected {self.expected}; {self.remedy}")

    def __reduce__(self) -> tuple[type["InputError"], tuple[str, str, str, str]]:
        return (type(self), (self.place, self.found, self.expected, self.remedy))


class EstimationError(LineposeError):
    """A computation that has no usable result: the message names the quantity and the remedy.

    Examples
    --------
    >>> import linepose
    >>> issubclass(linepose.EstimationError, linepose.LineposeError)
    True
    """


def one_line(error: BaseException) -> str | None:
    """What a person is told of an error in one line; None of one that is a fault of the program."""
    if isinstance(error, LineposeError):
        return str(error)
    if isinstance(error, MemoryError) or (isinstance(error, OSError) and error.errno == errno.ENOMEM):
        return "found too little memory, expected more; end other programs, or cut the recording into parts"
    if isinstance(error, OSError) and error.errno in {*_OF_THE_DISK, *_OF_RIGHTS}:
        place = f"{error.filename}: " if error.filename else ""
        expected, remedy = "the right to read or write there", "get it, or name another place"
        if error.errno in _OF_THE_DISK:
            expected, remedy = "a disk to write to", _OF_THE_DISK[error.errno]
        return f"{place}found {os.strerror(error.errno).lower()}, expected {expected}; {remedy}"
    return None


def printable(text: str) -> str:
    """A text as a terminal may show it: on one line, control signs escaped, its middle left out where it is long."""
    if len(text) > _MOST_CHARACTERS:
        text = f"{text[: _MOST_CHARACTERS // 2]} ... {text[-_MOST_CHARACTERS // 2 :]}"
    return "".join(one if one.isprintable() else one.encode("unicode_escape").decode("ascii") for one in text)


def quoted(value: object) -> str:
    """A value as messages show it: its `repr`, of a NumPy scalar that of the Python number."""
    plain = getattr(value, "item", None)
    return repr(plain() if callable(plain) and getattr(value, "shape", None) == () else value)

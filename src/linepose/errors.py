"""Errors that a user can act on: one line that says where, what was found, what was expected, what to do."""


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
        self.place = place
        self.found = found
        self.expected = expected
        self.remedy = remedy
        super().__init__(f"{place}: found {found}, expected {expected}; {remedy}")

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


def quoted(value: object) -> str:
    """A value as messages show it: its `repr`, of a NumPy scalar that of the Python number."""
    plain = getattr(value, "item", None)
    return repr(plain() if callable(plain) and getattr(value, "shape", None) == () else value)

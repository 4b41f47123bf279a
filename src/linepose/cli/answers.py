"""Questions to the person at the terminal, and what their answers may be."""

import math
from collections.abc import Callable
from typing import Any

import typer

_SOURCES = ("labelled_views", "scans")


def given(value: Any, option: str, question: str, kind: Callable[[str], Any], default: Any = None) -> Any:
    """The option's value, or the answer to a question; a usage error that names the option where nobody answers."""
    while value is None:
        try:
            answer = str(typer.prompt(question, default=default))
        except typer.Abort:
            typer.echo(err=True)
            asked = question.partition(" (")[0].partition(":")[0].lower()
            raise typer.BadParameter(f"no answer for {asked}: give it as {option}") from None
        try:
            value = kind(answer)
        except ValueError as error:
            typer.echo(f"{answer!r}: {error}; try again")
    return value


def positive(text: str) -> float:
    """A number above 0; raises ValueError for any other text."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not value > 0 or math.isinf(value):
        raise ValueError("expected a number above 0")
    return value


def whole(text: str) -> int:
    """A whole number from 2."""
    value = positive(text)
    if value != int(value) or value < 2:
        raise ValueError("expected a whole number from 2")
    return int(value)


def triple(text: str) -> tuple[float, float, float]:
    """Three numbers between spaces or commas."""
    try:
        first, second, third = (float(part) for part in text.strip("[]()").replace(",", " ").split())
    except ValueError:
        raise ValueError("expected three numbers") from None
    return first, second, third


def source_kind(text: str) -> str:
    """A kind of source."""
    if text not in _SOURCES:
        raise ValueError(f"expected one of {', '.join(_SOURCES)}")
    return text

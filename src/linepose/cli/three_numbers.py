"""A command whose options take three numbers each, and say so where fewer or more are given."""

from collections.abc import Iterator, Sequence
from typing import Any, Final

from typer.core import TyperCommand

from linepose.errors import InputError

_MEANINGS: Final = {
    "--position-m": ("forward right down (m)", "0.2 0 -0.8"),
    "--euler-deg": ("roll pitch yaw (deg)", "-56 0 -90"),
}


class ThreeNumbers(TyperCommand):
    """Raises InputError for an option of three numbers that has another count of them."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Count the numbers behind each option before they are read: a missing one would swallow the next option."""
        for place, argument in enumerate(args):
            if argument in _MEANINGS:
                given, (meaning, example) = list(_numbers(args[place + 1 :])), _MEANINGS[argument]
                if len(given) != 3:
                    found = " ".join(given) or "no number"
                    raise InputError(argument, found, f"three numbers: {meaning}", f"as in {argument} {example}")
        return super().parse_args(ctx, args)


def _numbers(arguments: Sequence[str]) -> Iterator[str]:
    """The arguments up to the first that is no number."""
    for argument in arguments:
        try:
            float(argument)
        except ValueError:
            return
        yield argument

"""A user's fault in one line on the error stream, never a traceback."""

from typing import Any

import typer
from typer.core import TyperGroup

from linepose.errors import LineposeError, one_line


class OneLineFaults(TyperGroup):
    """Commands whose LineposeErrors end the program with one line and exit code 1."""

    def invoke(self, ctx: Any) -> Any:
        """Run the command; a fault is printed as it is, on one line."""
        try:
            return super().invoke(ctx)
        except (LineposeError, OSError, MemoryError) as error:
            told = one_line(error)
            if told is None:
                raise
            typer.echo(f"linepose: {told}", err=True)
            raise typer.Exit(1) from None

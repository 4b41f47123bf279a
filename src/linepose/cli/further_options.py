"""A command that hands what stands after `--` to another program."""

from typing import Any, Final

from typer.core import TyperCommand

FURTHER: Final = "linepose.further"
"""Key of the context's `meta` with the options that stand after `--`."""


class WithFurtherOptions(TyperCommand):
    """Keeps what stands after `--` apart from the command's own arguments."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Read the arguments up to `--`."""
        own, further = (args[: args.index("--")], args[args.index("--") + 1 :]) if "--" in args else (args, [])
        ctx.meta[FURTHER] = further
        return super().parse_args(ctx, own)

    def collect_usage_pieces(self, ctx: Any) -> list[str]:
        """The usage line's pieces, with the further options last."""
        return [*super().collect_usage_pieces(ctx), "[-- OPTIONS]"]

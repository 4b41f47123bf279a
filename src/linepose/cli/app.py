"""All commands under one name, and how their faults are told."""

from typing import Annotated

import typer

import linepose
from linepose.cli import check, compare, export, label, new, recheck, run, show, target
from linepose.cli import map as map_command
from linepose.cli.faults import OneLineFaults
from linepose.cli.further_options import WithFurtherOptions
from linepose.cli.three_numbers import ThreeNumbers

app = typer.Typer(
    name="linepose",
    cls=OneLineFaults,
    help="Where exactly is the line-scan camera on the vehicle, and how sure is that?\n\n"
    "The way of a platform: **target** prints a board, **new** writes its file, "
    "**label** marks the pattern's points where scans "
    "are not labelled yet, **check** tells what is wrong before a run, **run** calibrates, "
    "**show** tells the pose, **export** writes it for the robot, **map** puts scans on the map, "
    "**recheck** tells from new views whether it still holds, **compare** how two calibrations differ.",
    no_args_is_help=True,
    rich_markup_mode="markdown",
    add_completion=False,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)


def _tell_version(asked: bool) -> None:
    if asked:
        typer.echo(f"linepose {linepose.__version__}")
        raise typer.Exit


@app.callback()
def options(
    version: Annotated[
        bool, typer.Option("--version", callback=_tell_version, is_eager=True, help="Tell the version.")
    ] = False,
) -> None:
    """Options that stand before a command; the program's help stands above."""


app.command(name="new", cls=ThreeNumbers)(new.new)
app.command(name="target")(target.target)
app.command(name="label")(label.label)
app.command(name="check")(check.check)
app.command(name="run", cls=WithFurtherOptions)(run.run)
app.command(name="show")(show.show)
app.command(name="export")(export.export)
app.command(name="map")(map_command.map_scans)
app.command(name="recheck")(recheck.recheck)
app.command(name="compare")(compare.compare)

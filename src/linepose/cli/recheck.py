"""`linepose recheck NAME --data FOLDER`: whether a calibration still holds, by a few new views."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from linepose.cli.options import HERE, Name, ProjectFolder

if TYPE_CHECKING:
    from linepose.pipeline.recheck import Recheck

MOVED, BLIND = 3, 4  # exit codes; 1 is a fault, 2 a wrong option


def recheck(
    name: Name,
    data: Annotated[
        Path, typer.Option("--data", "-d", help="Folder of the new views, laid out as the platform's own.")
    ],
    false_alarms: Annotated[
        float, typer.Option(min=0.0001, max=0.5, help="How often a camera that has not moved may be told to have.")
    ] = 0.05,
    as_json: Annotated[bool, typer.Option("--json", help="Print all numbers as JSON instead.")] = False,
    project: ProjectFolder = HERE,
) -> None:
    """Tell whether a finished platform's calibration still holds, by a few new views.

    Exit code 0 where it holds, 3 where the camera has moved, 4 where the views see no move at all, 1 where they cannot
    be used.
    """
    import json

    from linepose.cli.freshness import tell_outdated
    from linepose.pipeline.project_folder import find_project, load_platform_project
    from linepose.pipeline.recheck import recheck_platform

    found = recheck_platform(name, data, project, false_alarms=false_alarms)
    root = find_project(project)
    tell_outdated(load_platform_project(name, root), root, name)
    if as_json:
        typer.echo(json.dumps(found.as_dict(), indent=2, allow_nan=False))
    else:
        for line in lines_of(found):
            typer.echo(line)
    if not found.holds:
        raise typer.Exit(MOVED if found.sees else BLIND)


def lines_of(found: "Recheck") -> list[str]:
    """A recheck for people: the verdict, the move of each number, the tests, and warnings."""
    from linepose.estimation.pose_change import GROUPS, POWER, WHOLE, in_words

    whole = found.change.test(WHOLE)
    verdict = "holds" if found.holds else "the camera has moved"
    if not found.sees:
        verdict = "nothing can be told: these views see no move at all"
    lines = [
        f"{found.name}: {verdict} (p = {whole.p_value:.3g}, alarm below {found.false_alarms:g}; {found.n_views} new "
        f"views beside the calibration's {found.n_calibrated})",
        f"{'':20s}{'moved by':>14s}{'sigma':>14s}{'least seen':>14s}",
    ]
    for move, row in found.table().iterrows():
        quantity, unit = in_words(str(move))
        digits = 3 if unit == "m" else 2
        cells = (f"{value + 0.0:.{digits}f} {unit}" if abs(value) < 1e3 else "not seen" for value in row)
        lines.append(f"{quantity:20s}" + "".join(f"{cell:>14s}" for cell in cells))
    for group in GROUPS:
        one = found.change.test(group)
        lines.append(
            f"{group:10s} {one.distance:.2f} sigmas in {one.degrees_of_freedom} directions, p = {one.p_value:.3g}"
        )
    lines.append(f"least seen: what is found with {POWER:.0%} where it is the only move")
    return [*lines, *(f"care: {warning}" for warning in found.warnings)]

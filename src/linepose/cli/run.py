"""`linepose run NAME`: the workflow for one platform or several, Snakemake as a subprocess."""

import json
import time
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final

import typer

from linepose.cli.options import HERE, ProjectFolder

if TYPE_CHECKING:
    from linepose.config.project import Project

_LEAST_FREE_MB: Final = 20  # for Snakemake's own files and a small result; larger ones tell for themselves


def run(
    context: typer.Context,
    names: Annotated[
        list[str] | None,
        typer.Argument(metavar="[NAME]...", help="Platforms, by name or pattern, as 'fleet-*'.", show_default=False),
    ] = None,
    all_platforms: Annotated[bool, typer.Option("--all", help="All platforms that config.yaml names.")] = False,
    project: ProjectFolder = HERE,
    cores: Annotated[
        int | None, typer.Option("--cores", "-c", min=1, help="Processor cores.", show_default="all")
    ] = None,
    profile: Annotated[
        str, typer.Option("--profile", metavar="NAME", help="A profile of Snakemake, as `slurm` for a cluster.")
    ] = "",
    dry_run: Annotated[bool, typer.Option("--dry-run", "-n", help="Only tell what would be made.")] = False,
) -> None:
    """Calibrate a platform: outliers, pose, uncertainty, the experiments its file asks for, figures and the report.

    Makes only what is missing, or what other settings, inputs or code made; after an interruption, the same command
    goes on. Further options for snakemake stand after `--`.
    Results go to results/NAME, the page to read first is results/NAME/report.html, and of several platforms
    results/report.html.
    """
    from linepose.cli.further_options import FURTHER
    from linepose.cli.snakemake_process import run_snakemake
    from linepose.cli.workflow_files import find_profile, find_workflow, says_cores
    from linepose.experiments.registry import compared_platforms
    from linepose.pipeline.cluster.node import check_room
    from linepose.pipeline.project_folder import chosen_platforms, find_project, load_platforms_project
    from linepose.pipeline.run_lock import check_no_run

    root = find_project(project)
    if not dry_run:
        check_no_run(root)
        check_room(root, str(root), _LEAST_FREE_MB)
    chosen = chosen_platforms(names or [], all_platforms, root)
    loaded = load_platforms_project(chosen, root, compared_platforms)
    loaded.check_files()
    snakefile = find_workflow(root)
    found = find_profile(profile, root, snakefile) if profile else None
    arguments = [] if found is None else ["--profile", str(found)]
    if cores or found is None or not says_cores(found):
        arguments += ["--cores", str(cores or "all")]
    arguments += ["--quiet", "host", *(["rules"] if dry_run else []), "--config", f"platforms={json.dumps(chosen)}"]
    arguments += _forced(loaded, root, snakefile, arguments, dry_run)
    arguments += context.meta.get(FURTHER, [])
    if dry_run:
        raise typer.Exit(run_snakemake(snakefile, root, [*arguments, "--dry-run"]))
    _run(snakefile, root, chosen, arguments)
    results = root / "results"
    if all_platforms or len(chosen) > 1:
        typer.echo(f"done: {len(chosen)} platforms; the report, worst first, is {results / 'report.html'}")
    else:
        typer.echo(f"done: linepose show {chosen[0]}; the report is {results / chosen[0] / 'report.html'}")


def _forced(loaded: "Project", root: Path, snakefile: Path, arguments: Sequence[str], dry_run: bool) -> list[str]:
    """The option that makes outdated results again, which are told in a line; nothing where there are none."""
    from linepose.cli.freshness import all_outdated
    from linepose.cli.snakemake_process import files_of_workflow
    from linepose.pipeline.outdated import told

    wanted = [name for name in loaded.study.platforms if name in loaded.platforms]
    outdated = [one for name in wanted for one in all_outdated(loaded, root, name, snakefile.parent / "scripts")]
    if not outdated:
        return []
    typer.echo(f"{'would be made again' if dry_run else 'made again'}: {told(outdated)}", err=True)
    outputs = (place for one in outdated for place in (one.path, one.path.rpartition("/")[0]))  # or its folder
    forced = sorted(files_of_workflow(snakefile, root, arguments).intersection(outputs))
    return ["--forcerun", *forced] if forced else []


def _run(snakefile: Path, root: Path, chosen: Sequence[str], arguments: Sequence[str]) -> None:
    """Run the workflow and tell a line a stage, or a platform where there are several; ends where it fails."""
    from rich.console import Console

    from linepose.cli.platform_lines import PlatformLines
    from linepose.cli.snakemake_process import BY_KEYBOARD, follow_snakemake
    from linepose.cli.stage_lines import StageLines
    from linepose.errors import one_line

    several = len(chosen) > 1
    logs = root / "results" / "logs"
    log = logs / "run.log" if several else logs / chosen[0] / "run.log"
    console, lines = Console(stderr=True), PlatformLines(root, len(chosen)) if several else StageLines()
    begun_s = time.time()

    def tell(line: str | None) -> None:
        if line is not None:
            console.print(line, markup=False, highlight=False, soft_wrap=True)

    if console.is_terminal:
        with console.status("planning") as status:

            def show(bar: str = "") -> None:
                status.update(f"{', '.join(lines.running) or 'planning'} {bar.replace('[', '(').replace(']', ')')}")

            def hear(message: str) -> None:
                tell(lines.hear(message))
                show()

            followed = follow_snakemake(snakefile, root, arguments, log, hear, show)
    else:
        followed = follow_snakemake(snakefile, root, arguments, log, lambda message: tell(lines.hear(message)))
    if followed.log_fault is not None:
        tell(
            f"linepose: the run's messages could not all be kept: {one_line(followed.log_fault) or followed.log_fault}"
        )
    if followed.code == BY_KEYBOARD:
        tell("linepose: run stopped by the keyboard; the same command goes on")
        raise typer.Exit(followed.code)
    if isinstance(lines, PlatformLines):
        for line in lines.unheard(chosen, begun_s):
            tell(line)
    if followed.code:
        for line in [] if lines.told_why else lines.unexplained:
            tell(line)
        if lines.log or not lines.told_why:
            place = root / lines.log if lines.log else None if followed.log_fault else log
            what = f"of {len(chosen)} platforms" if several else chosen[0]
            tell(f"linepose: run {what} stopped: the fault stands above{f', and in {place}' if place else ''}")
        raise typer.Exit(1)

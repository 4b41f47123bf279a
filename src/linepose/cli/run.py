"""`linepose run NAME`: the workflow for one platform, Snakemake as a subprocess."""

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import typer

from linepose.cli.options import HERE, Name, ProjectFolder


def run(
    name: Name,
    project: ProjectFolder = HERE,
    cores: Annotated[
        int | None, typer.Option("--cores", "-c", min=1, help="Processor cores.", show_default="all")
    ] = None,
    profile: Annotated[
        str, typer.Option("--profile", metavar="NAME", help="A profile of Snakemake, as `slurm` for a cluster.")
    ] = "",
    dry_run: Annotated[bool, typer.Option("--dry-run", "-n", help="Only tell what would be made.")] = False,
    further: Annotated[
        list[str] | None,
        typer.Argument(metavar="[-- OPTIONS]", help="Further options for snakemake, after --.", show_default=False),
    ] = None,
) -> None:
    """Calibrate a platform: outliers, pose, uncertainty, the experiments its file asks for, figures and the report.

    Makes only what is missing, or what other settings, inputs or code made; after an interruption, the same command
    goes on.
    Results go to results/NAME, the page to read first is results/NAME/report.html.
    """
    from linepose.cli.freshness import all_outdated
    from linepose.cli.snakemake_process import files_of_workflow, run_snakemake
    from linepose.cli.workflow_files import find_profile, find_workflow, says_cores
    from linepose.experiments.registry import compared_platforms
    from linepose.pipeline.outdated import told
    from linepose.pipeline.project_folder import find_project, load_platform_project
    from linepose.pipeline.run_lock import check_no_run

    root = find_project(project)
    if not dry_run:
        check_no_run(root)
    loaded = load_platform_project(name, root, compared_platforms)
    loaded.check_files()
    snakefile = find_workflow(root)
    chosen = find_profile(profile, root, snakefile) if profile else None
    arguments = [] if chosen is None else ["--profile", str(chosen)]
    if cores or chosen is None or not says_cores(chosen):
        arguments += ["--cores", str(cores or "all")]
    arguments += ["--quiet", "host", *(["rules"] if dry_run else []), "--config", f'platforms=["{name}"]']
    outdated = all_outdated(loaded, root, name, snakefile.parent / "scripts")
    if outdated:
        typer.echo(f"{'would be made again' if dry_run else 'made again'}: {told(outdated)}", err=True)
        wanted = files_of_workflow(snakefile, root, arguments)
        outputs = (place for one in outdated for place in (one.path, one.path.rpartition("/")[0]))  # or its folder
        if forced := sorted(wanted.intersection(outputs)):
            arguments += ["--forcerun", *forced]
    if dry_run:
        raise typer.Exit(run_snakemake(snakefile, root, [*arguments, "--dry-run", *(further or [])]))
    _run(snakefile, root, name, [*arguments, *(further or [])])
    typer.echo(f"done: linepose show {name}; the report is {root / 'results' / name / 'report.html'}")


def _run(snakefile: Path, root: Path, name: str, arguments: Sequence[str]) -> None:
    """Run the workflow and tell one line a stage; ends the command where it fails."""
    from rich.console import Console

    from linepose.cli.snakemake_process import follow_snakemake
    from linepose.cli.stage_lines import StageLines

    console, log, lines = Console(stderr=True), root / "results" / "logs" / name / "run.log", StageLines()

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

            code = follow_snakemake(snakefile, root, arguments, log, hear, show)
    else:
        code = follow_snakemake(snakefile, root, arguments, log, lambda message: tell(lines.hear(message)))
    if code:
        for line in [] if lines.told_why else lines.unexplained:
            tell(line)
        if lines.log or not lines.told_why:
            place = root / lines.log if lines.log else log
            tell(f"linepose: run {name} stopped: the fault stands above, and in {place}")
        raise typer.Exit(1)

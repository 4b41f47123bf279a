"""`linepose run NAME`: the workflow for one platform, Snakemake as a subprocess."""

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
    from linepose.experiments.registry import compared_platforms
    from linepose.pipeline.outdated import told
    from linepose.pipeline.project_folder import find_project, load_platform_project
    from linepose.pipeline.run_lock import check_no_run

    root = find_project(project)
    loaded = load_platform_project(name, root, compared_platforms)
    snakefile = find_workflow(root)
    if not dry_run:
        check_no_run(root)
    arguments = ["--cores", str(cores or "all"), "--quiet", "host", "rules", "--config", f'platforms=["{name}"]']
    outdated = all_outdated(loaded, root, name, snakefile.parent / "scripts")
    if outdated:
        typer.echo(f"{'would be made again' if dry_run else 'made again'}: {told(outdated)}", err=True)
        wanted = files_of_workflow(snakefile, root, arguments)
        outputs = (place for one in outdated for place in (one.path, one.path.rpartition("/")[0]))  # or its folder
        if forced := sorted(wanted.intersection(outputs)):
            arguments += ["--forcerun", *forced]
    arguments += ["--dry-run"] if dry_run else []
    if run_snakemake(snakefile, root, [*arguments, *(further or [])]):
        typer.echo(
            f"linepose: run {name} stopped: the fault stands above, and in {root / 'results' / 'logs'}", err=True
        )
        raise typer.Exit(1)
    if not dry_run:
        typer.echo(f"done: linepose show {name}; the report is {root / 'results' / name / 'report.html'}")


def find_workflow(root: Path) -> Path:
    """The Snakefile of a project, or of the clone that this package runs from; raises InputError if none."""
    from linepose.errors import InputError

    clone = Path(__file__).parents[3]
    for folder in (root, clone):
        if (folder / "Snakefile").is_file() and (folder / "workflow" / "rules").is_dir():
            return folder / "Snakefile"
    raise InputError(
        str(root),
        "no Snakefile",
        "a clone of linepose, which brings the workflow",
        "clone the repository and put this project's config/ and data/ there; without the workflow, "
        "linepose.calibrate_platform(NAME) in Python gives pose and sigmas (docs/api.md)",
    )

"""`linepose run NAME`: the workflow for one platform, Snakemake as a subprocess."""

import subprocess
import sys
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

    Makes only what is missing or older than what it is made from; after an interruption, the same command goes on.
    Results go to results/NAME, the page to read first is results/report.html.
    """
    from linepose.pipeline.project_folder import find_project, load_platform_project

    root = find_project(project)
    load_platform_project(name, root)  # a fault of the configuration is told before anything runs
    snakefile = find_workflow(root)
    command = [sys.executable, "-m", "snakemake", "--snakefile", str(snakefile), "--directory", str(root)]
    command += ["--cores", str(cores or "all"), "--quiet", "host", "rules"]
    command += ["--config", f'platforms=["{name}"]', *(["--dry-run"] if dry_run else [])]
    finished = subprocess.run([*command, *(further or [])], check=False)
    if finished.returncode:
        typer.echo(
            f"linepose: run {name} stopped: the fault stands above, and in {root / 'results' / 'logs'}", err=True
        )
        raise typer.Exit(1)
    if not dry_run:
        typer.echo(f"done: linepose show {name}; the report is {root / 'results' / 'report.html'}")


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

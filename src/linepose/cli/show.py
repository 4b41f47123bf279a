"""`linepose show NAME`: the result in the terminal."""

import typer

from linepose.cli.options import HERE, Name, ProjectFolder


def show(name: Name, project: ProjectFolder = HERE) -> None:
    """Tell a platform's pose: position, rotation vector, Euler angles, sigmas, and whether to trust it and why."""
    from rich.console import Console

    from linepose.cli.freshness import tell_outdated
    from linepose.cli.result import plain_lines, tables
    from linepose.errors import InputError
    from linepose.pipeline.calibration import Calibration
    from linepose.pipeline.project_folder import find_project, load_platform_project
    from linepose.pipeline.summary import summarise

    root = find_project(project)
    loaded = load_platform_project(name, root)
    folder = root / "results" / name
    if not (folder / "pose.parquet").is_file():
        raise InputError(str(folder), "no result", "that of a run", f"linepose run {name}")
    calibration = Calibration.from_results(folder, loaded.platforms[name], loaded.study.outliers.threshold_px)
    summary, removed = summarise(calibration), calibration.outliers
    tell_outdated(loaded, root, name)
    console = Console()
    if console.is_terminal:
        for part in tables(summary, removed):
            console.print(part)
    else:
        for line in plain_lines(summary, removed):
            typer.echo(line)
    made = {"figures": folder / "figures", "report": folder / "report.html"}
    typer.echo(
        ", ".join([f"tables {folder}/*.parquet", *(f"{what} {path}" for what, path in made.items() if path.exists())])
    )
    if missing := [what for what, path in made.items() if not path.exists()]:
        typer.echo(f"not made yet: {' and '.join(missing)}; the run goes on with: linepose run {name}")
    typer.echo(f"take it away: linepose export {name} --format urdf")

"""`linepose export NAME --format FORMAT`: the result as robots and maps read it."""

from pathlib import Path
from typing import Annotated

import typer

from linepose.cli.options import HERE, Name, ProjectFolder


def _tell_formats(asked: bool) -> None:
    if asked:
        from linepose.pipeline.exports.registry import EXPORTS

        for one in (EXPORTS.member(name) for name in EXPORTS.names()):
            typer.echo(f"{one.name:12s}{one.title}")
        raise typer.Exit


def export(
    name: Name,
    format: Annotated[str, typer.Option("--format", "-f", help="One of those that --list tells.")] = "",
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", help="File, or folder to write into.", show_default="results/NAME/exports"),
    ] = None,
    parent_frame: Annotated[str, typer.Option(help="Name of the body's frame.")] = "base_link",
    child_frame: Annotated[str, typer.Option(help="Name of the camera's frame.")] = "line_camera_optical",
    body_axes: Annotated[
        str, typer.Option(help="flu or frd: forward, left, up or forward, right, down.", show_default="of the format")
    ] = "",
    scan: Annotated[
        str, typer.Option(help="Name of the scan, of formats that hold scans.", show_default="the only one, or all")
    ] = "",
    stage: Annotated[str, typer.Option(help="inliers, all, or hand_measured.")] = "inliers",
    _: Annotated[
        bool, typer.Option("--list", callback=_tell_formats, is_eager=True, help="Tell the formats and end.")
    ] = False,
    project: ProjectFolder = HERE,
) -> None:
    """Write a finished platform's pose, or the points it maps, for a robot or a map."""
    from linepose.cli.freshness import tell_outdated
    from linepose.errors import InputError
    from linepose.pipeline.calibration import Calibration
    from linepose.pipeline.exports.options import export_options
    from linepose.pipeline.exports.registry import EXPORTS
    from linepose.pipeline.exports.write import export_calibration
    from linepose.pipeline.project_folder import find_project, load_platform_project

    if not format:
        raise InputError(
            "--format", "nothing", f"one of {', '.join(EXPORTS.names())}", f"linepose export {name} --format urdf"
        )
    root = find_project(project)
    loaded, folder = load_platform_project(name, root), root / "results" / name
    if not (folder / "pose.parquet").is_file():
        raise InputError(str(folder), "no result", "that of a run", f"linepose run {name}")
    target = output or folder / "exports"
    if output is None:
        target.mkdir(exist_ok=True)
    options = export_options(parent_frame, child_frame, body_axes, scan)
    calibration = Calibration.from_results(
        folder, loaded.platforms[name], loaded.study.outliers.threshold_px, stage, root / loaded.folder(name)
    )
    written = export_calibration(calibration, format, target, options)
    tell_outdated(loaded, root, name)
    typer.echo(written)

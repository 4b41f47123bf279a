"""`linepose map NAME`: each pixel's place on the map, and how sure it is."""

import os
from pathlib import Path
from typing import Annotated

import typer

from linepose.cli.options import HERE, Name, ProjectFolder


def map_scans(
    name: Name,
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="Folder to write into.", show_default="results/NAME/map")
    ] = None,
    stage: Annotated[str, typer.Option(help="inliers, all, or hand_measured.")] = "inliers",
    cores: Annotated[
        int | None, typer.Option("--cores", "-c", min=1, help="Processor cores.", show_default="all")
    ] = None,
    project: ProjectFolder = HERE,
) -> None:
    """Put a finished platform's scans on the map: easting, northing, height of each pixel, with their sigmas.

    Scans that are there already are passed over, so that after an interruption the same command goes on.
    """
    from linepose.cli.freshness import tell_outdated
    from linepose.config.map import MapSection
    from linepose.errors import InputError
    from linepose.output.map.platform_map import platform_map, write_maps
    from linepose.output.map.words import scan_sentence
    from linepose.pipeline.calibration import Calibration
    from linepose.pipeline.project_folder import find_project, load_platform_project

    root = find_project(project)
    loaded, folder = load_platform_project(name, root), root / "results" / name
    if not (folder / "pose.parquet").is_file():
        raise InputError(str(folder), "no result", "that of a run", f"linepose run {name}")
    data, platform = root / loaded.folder(name), loaded.platforms[name]
    calibration = Calibration.from_results(folder, platform, loaded.study.outliers.threshold_px, stage, data)
    maps = platform_map(calibration, platform.map or MapSection(), data)
    target = output or folder / "map"
    for number, made in enumerate(write_maps(maps, target, cores or os.cpu_count() or 1), start=1):
        typer.echo(f"{number} of {len(maps.paths)}: {scan_sentence(made)}")
    tell_outdated(loaded, root, name)
    typer.echo(target)

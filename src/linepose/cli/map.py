"""`linepose map NAME`: each pixel's place on the map, and how sure it is."""

import os
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from linepose.cli.options import HERE, Name, ProjectFolder

if TYPE_CHECKING:
    from linepose.config.map import MapSection
    from linepose.config.platform import Platform


def map_scans(
    name: Name,
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="Folder to write into.", show_default="results/NAME/map")
    ] = None,
    stage: Annotated[str, typer.Option(help="inliers, all, or hand_measured.")] = "inliers",
    bands: Annotated[
        str | None,
        typer.Option(help="Bands of a GeoTIFF, as 30,60,90 or all.", show_default="map.geotiff of the platform's file"),
    ] = None,
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
    from linepose.output.map.words import budget_sentences, scan_sentence
    from linepose.pipeline.calibration import Calibration
    from linepose.pipeline.project_folder import find_project, load_platform_project

    root = find_project(project)
    loaded, folder = load_platform_project(name, root), root / "results" / name
    if not (folder / "pose.parquet").is_file():
        raise InputError(str(folder), "no result", "that of a run", f"linepose run {name}")
    data, platform = root / loaded.folder(name), loaded.platforms[name]
    calibration = Calibration.from_results(folder, platform, loaded.study.outliers.threshold_px, stage, data)
    section = _with_bands(platform.map or MapSection(), bands, platform, data)
    maps = platform_map(calibration, section, data)
    target = output or folder / "map"
    n_before = 0
    for number, made in enumerate(write_maps(maps, target, cores or os.cpu_count() or 1), start=1):
        n_before += not made.is_new
        typer.echo(f"{number} of {len(maps.paths)}: {scan_sentence(made)}")
        for line in budget_sentences(made):
            typer.echo(line)
    tell_outdated(loaded, root, name)
    if n_before:
        typer.echo(f"{n_before} of {len(maps.paths)} were finished before, of the same numbers, and left as they are")
    typer.echo(target)


def _with_bands(section: "MapSection", bands: str | None, platform: "Platform", data: Path) -> "MapSection":
    """The section with these bands written as GeoTIFF; raises InputError for words that name none."""
    from pydantic import ValidationError

    from linepose.config.map import GeotiffSection
    from linepose.errors import InputError

    if bands is None:
        return section
    known = {} if section.geotiff is None else section.geotiff.model_dump()
    wanted = "all" if bands == "all" else bands.split(",")
    try:
        geotiff = GeotiffSection.model_validate({**known, "bands": wanted}, strict=False)
    except ValidationError:
        n_bands = _n_bands(platform, data)
        expected = f"numbers from 1 to {n_bands}, each once, or all"
        some = sorted({1, (n_bands + 1) // 2, n_bands})
        raise InputError("--bands", repr(bands), expected, f"write --bands {','.join(map(str, some))}") from None
    return section.model_copy(update={"geotiff": geotiff})


def _n_bands(platform: "Platform", data: Path) -> int:
    """Bands of the platform's first scan."""
    from linepose.errors import InputError
    from linepose.inputs.observed_points import select_scans
    from linepose.inputs.scans.scan_bands import open_bands
    from linepose.inputs.source import ScansSection

    source = platform.source
    if not isinstance(source, ScansSection):
        raise InputError("--bands", "a platform of labelled views", "scans", "leave it out")
    return int(open_bands(next(iter(select_scans(data, source.scans, source.left_out).values()))).shape[2])

"""`linepose label NAME`: click points in the scans."""

from typing import Annotated

import typer

from linepose.cli.options import HERE, Name, ProjectFolder


def label(
    name: Name,
    rectified_m: Annotated[
        float | None,
        typer.Option(
            "--rectified-m",
            metavar="DISTANCE",
            min=0.0,
            help="Show scans as maps of level ground, this far along the optical axis (m): straight however they were "
            "driven. Labels stay those of the scans.",
            show_default="(as recorded)",
        ),
    ] = None,
    project: ProjectFolder = HERE,
) -> None:
    """Open a window to click points over each scan; what was clicked is kept when it is closed."""
    from linepose.errors import InputError
    from linepose.inputs.source import ScansSection
    from linepose.pipeline.api import recorded_folder
    from linepose.pipeline.project_folder import find_project, load_platform_project

    root = find_project(project)
    loaded = load_platform_project(name, root)
    source = loaded.platforms[name].source
    if not isinstance(source, ScansSection):
        remedy = "label scans: set source.kind: scans"
        raise InputError(f"{name}: source.kind", source.kind, "scans, which have images", remedy)
    from linepose.cli.labelling import label_platform
    from linepose.cli.labelling.scan_view import as_recorded, rectified
    from linepose.pipeline.load import hand_view

    folder, platform = recorded_folder(loaded, name, root), loaded.platforms[name]
    read = as_recorded if rectified_m is None else rectified(hand_view(platform, folder), source, rectified_m)
    label_platform(folder, source, target=platform.target, read=read)
    typer.echo(f"next: linepose check {name}")

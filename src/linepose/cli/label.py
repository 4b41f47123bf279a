"""`linepose label NAME`: click points in the scans."""

import typer

from linepose.cli.options import HERE, Name, ProjectFolder


def label(name: Name, project: ProjectFolder = HERE) -> None:
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

    label_platform(recorded_folder(loaded, name, root), source, target=loaded.platforms[name].target)
    typer.echo(f"next: linepose check {name}")

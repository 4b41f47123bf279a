"""`linepose label NAME`: click the pattern's points in the scans."""

from linepose.cli.options import HERE, Name, ProjectFolder


def label(name: Name, project: ProjectFolder = HERE) -> None:
    """Open a window to click the pattern's points over each scan; what was clicked is kept when it is closed."""
    from linepose.api import recorded_folder
    from linepose.labelling import label_platform
    from linepose.project_folder import find_project, load_platform_project

    root = find_project(project)
    loaded = load_platform_project(name, root)
    label_platform(loaded.platforms[name], recorded_folder(loaded, name, root))

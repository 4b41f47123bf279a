"""Whether a platform's results are those of the present settings, inputs and code, told in one line where not."""

from pathlib import Path
from typing import TYPE_CHECKING

import typer

if TYPE_CHECKING:
    from linepose.config.platform import Platform
    from linepose.config.project import Project
    from linepose.pipeline.outdated import Outdated


def tell_outdated(project: "Project", root: Path, name: str) -> None:
    """Tell on the error stream, in one line, that a platform's pose is outdated and why; nothing if it is not.

    Results of experiments are not looked at.
    """
    from linepose.cli.workflow_files import find_workflow
    from linepose.errors import InputError
    from linepose.pipeline.outdated import Present, outdated_results, told

    try:
        scripts = find_workflow(root).parent / "scripts"
    except InputError:
        scripts = None
    present = Present(project, root, name, scripts, left_out=_unmapped(project.platforms[name]))
    if outdated := outdated_results(present):
        typer.echo(f"linepose: {told(outdated)}; to make it again: linepose run {name}", err=True)


def all_outdated(project: "Project", root: Path, name: str, scripts: Path) -> "list[Outdated]":
    """The outdated results of a platform, also of the experiments that its file asks for."""
    from linepose.experiments.registry import EXPERIMENTS, SECTIONS
    from linepose.pipeline.outdated import Present, outdated_results

    platform = project.platforms[name]
    sections = {key: section.values(platform) for key, section in SECTIONS.items()}
    left_out = frozenset(output for one in EXPERIMENTS if not one.is_wanted(platform) for output in one.outputs)
    return outdated_results(Present(project, root, name, scripts, sections, left_out | _unmapped(platform)))


def _unmapped(platform: "Platform") -> frozenset[str]:
    """The results of maps, where a platform's file does not ask for them, or no longer."""
    from linepose.config.map import MAP_RESULTS

    return frozenset() if platform.map else frozenset(MAP_RESULTS)

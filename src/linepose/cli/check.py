"""`linepose check NAME`: everything that can be known before a run, all findings at once."""

import logging
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Final

import typer

from linepose.cli.options import HERE, Name, ProjectFolder

_PATIENCE_S: Final = 3.0


def check(name: Name, project: ProjectFolder = HERE) -> None:
    """Tell what is wrong with a platform before a run: all findings at once, in seconds.

    Looks at the platform's file, units, times, labels, covariances and the hand measurement, and predicts how well each
    number of the pose will be known and which motion would help most. Exit code 1 where something must be mended.
    """
    from rich.console import Console

    from linepose.check.finding import Level
    from linepose.check.platform import check_platform
    from linepose.cli.findings import findings_table, plain_findings, plain_sigmas, sigmas_table, summary
    from linepose.pipeline.project_folder import find_project

    root = find_project(project)
    console = Console()
    with _without_warnings(), _patience():
        report = check_platform(name, root)
    if console.is_terminal:
        console.print(findings_table(report))
        if report.predicted:
            console.print(sigmas_table(report))
        console.print(summary(report), soft_wrap=True)
    else:
        for line in [*plain_findings(report), *plain_sigmas(report), summary(report)]:
            typer.echo(line)
    if report.level == Level.ERROR:
        raise typer.Exit(1)


@contextmanager
def _patience() -> Iterator[None]:
    """In a terminal, say on the error stream that work goes on, and after some seconds why it may take longer."""
    from rich.console import Console

    told = "checking (after an installation or an update, kernels are compiled first: about half a minute)"
    with Console(stderr=True).status("checking") as status:
        longer = threading.Timer(_PATIENCE_S, status.update, [told])
        longer.start()
        try:
            yield
        finally:
            longer.cancel()


@contextmanager
def _without_warnings() -> Iterator[None]:
    """What the readers warn of are findings here, and told as such."""
    logger = logging.getLogger("linepose")
    level = logger.level
    logger.setLevel(logging.ERROR)
    try:
        yield
    finally:
        logger.setLevel(level)

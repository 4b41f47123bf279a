"""A platform's result for the eye: tables in a terminal, lines elsewhere."""

from collections.abc import Sequence
from typing import Final

from rich.box import SIMPLE
from rich.console import RenderableType
from rich.table import Table
from rich.text import Text

from linepose.pipeline.checks import Level
from linepose.pipeline.pose_tables import PoseNumber
from linepose.pipeline.summary import PlatformSummary

_STYLES: Final = {Level.GOOD: "bold green", Level.CARE: "bold yellow", Level.BAD: "bold red"}
_WORDS: Final = {Level.GOOD: "ok", Level.CARE: "care", Level.BAD: "bad"}
_HEADINGS: Final = ("", "estimate", "sigma", "by hand", "minus by hand", "in its sigmas")


def tables(summary: PlatformSummary, removed: Sequence[int]) -> list[RenderableType]:
    """Verdict, pose and reasons as tables."""
    pose = Table(title="camera in the body frame, camera to body", title_justify="left", box=SIMPLE)
    for heading in _HEADINGS:
        pose.add_column(heading, justify="right" if heading else "left")
    for number in _numbers(summary):
        pose.add_row(*_cells(number))
    reasons = Table(title="why", title_justify="left", box=SIMPLE)
    for heading in ("", "check", "found, and what to do"):
        reasons.add_column(heading, no_wrap=heading != "found, and what to do")
    for check in summary.verdict.checks:
        told = Text(check.found)
        if check.advice:
            told.append(f"\n→ {check.advice}", style="bold")
        reasons.add_row(Text(_WORDS[check.level], style=_STYLES[check.level]), check.name, told)
    head = Text(f"{_title(summary)}\n{summary.verdict.sentence}", style=_STYLES[summary.verdict.level])
    return [head, pose, Text(_about(summary, removed)), reasons]


def plain_lines(summary: PlatformSummary, removed: Sequence[int]) -> list[str]:
    """The same as lines that a program or a log can take."""
    lines = [_title(summary), summary.verdict.sentence]
    lines.append(f"{_HEADINGS[0]:16s}" + "".join(f"{heading:>15s}" for heading in _HEADINGS[1:]))
    for number in _numbers(summary):
        name, *cells = _cells(number)
        lines.append(f"{name:16s}" + "".join(f"{cell:>15s}" for cell in cells))
    lines.append(_about(summary, removed))
    for check in summary.verdict.checks:
        lines.append(f"{_WORDS[check.level]:6s}{check.name}: {check.found}")
        if check.advice:
            lines.append(f"      -> {check.advice}")
    return lines


def _title(summary: PlatformSummary) -> str:
    """The platform's name, and its description where that says more."""
    told = summary.description
    return told if told == summary.name else f"{summary.name}: {told}"


def _numbers(summary: PlatformSummary) -> list[PoseNumber]:
    return [*summary.rotation_vector, *summary.euler]


def _cells(number: PoseNumber) -> tuple[str, ...]:
    unit = {"°": "deg"}.get(number.unit, number.unit)
    digits = 2 if unit == "deg" else 4
    told = (number.estimate, number.sigma, number.hand, number.difference)
    return (
        number.name,
        *(f"{round(value, digits) + 0.0:.{digits}f} {unit}" for value in told),
        f"{number.difference_sigmas:+.1f}",
    )


def _about(summary: PlatformSummary, removed: Sequence[int]) -> str:
    quaternion = ", ".join(f"{value:.6f}" for value in summary.quaternion)
    without = f" (removed: {', '.join(map(str, removed))})" if removed else ""
    return (
        f"quaternion w, x, y, z: {quaternion}; {summary.observations_in_words}{without}, "
        f"{summary.misfit_in_words}, noise model {summary.noise_model}"
    )

"""A check's report for the eye: a table in a terminal, lines elsewhere."""

from typing import Final

import numpy as np
from rich.box import SIMPLE
from rich.table import Table
from rich.text import Text

from linepose.check.finding import CheckReport, Level, PredictedSigma

_WORDS: Final = {Level.OK: "ok", Level.WARNING: "warning", Level.ERROR: "error"}
_STYLES: Final = {Level.OK: "green", Level.WARNING: "yellow", Level.ERROR: "bold red"}


def findings_table(report: CheckReport) -> Table:
    """One row a finding; what to do stands below what was found."""
    table = Table(title=f"linepose check {report.platform}", title_justify="left", box=SIMPLE)
    for heading in ("", "about", "found, and what to do"):
        table.add_column(heading, overflow="fold", no_wrap=heading != "found, and what to do")
    for finding in report.findings:
        told = Text(finding.found)
        if finding.advice:
            told.append(f"\n→ {finding.advice}", style="bold")
        table.add_row(Text(_WORDS[finding.level], style=_STYLES[finding.level]), finding.subject, told)
    return table


def sigmas_table(report: CheckReport) -> Table:
    """How well each number of the pose will be known."""
    table = Table(title="predicted sigmas", title_justify="left", box=SIMPLE)
    table.add_column("")
    for heading in ("by hand", "predicted"):
        table.add_column(heading, justify="right")
    for one in report.predicted:
        style = "yellow" if one.predicted > 0.5 * one.hand else ""
        table.add_row(one.name, *_sizes(one), style=style)
    return table


def plain_findings(report: CheckReport) -> list[str]:
    """The findings as lines that a program or a log can take."""
    lines = []
    for finding in report.findings:
        lines.append(f"{_WORDS[finding.level]:8s}{finding.subject}: {finding.found}")
        if finding.advice:
            lines.append(f"        -> {finding.advice}")
    return lines


def plain_sigmas(report: CheckReport) -> list[str]:
    """The predicted sigmas as lines."""
    if not report.predicted:
        return []
    lines = [f"{'predicted sigmas':24s}{'by hand':>10s}{'predicted':>12s}"]
    for one in report.predicted:
        hand, predicted = _sizes(one)
        lines.append(f"{one.name:24s}{hand:>10s}{predicted:>12s}")
    return lines


def summary(report: CheckReport) -> str:
    """How many errors and warnings there are, and the next step."""
    n_errors, n_warnings = len(report.of(Level.ERROR)), len(report.of(Level.WARNING))
    counted = f"{_counted(n_errors, 'error')}, {_counted(n_warnings, 'warning')}"
    if n_errors:
        return f"{counted}: mend the errors, then `linepose check {report.platform}` again"
    return f"{counted}: `linepose run {report.platform}` can start"


def _counted(count: int, what: str) -> str:
    return f"{count or 'no'} {what}{'' if count == 1 else 's'}"


def _sizes(one: PredictedSigma) -> tuple[str, str]:
    def told(value: float) -> str:
        return f"{1e3 * value:.0f} mm" if one.unit == "m" else f"{np.degrees(value):.2f} deg"

    return told(one.hand), told(one.predicted)

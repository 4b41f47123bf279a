"""A finding of the check: what it is about, how bad, what was found, what to do."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from enum import IntEnum

from linepose.arrays import Floats
from linepose.errors import InputError


class Level(IntEnum):
    """How a finding weighs; the larger the worse. An error stops the run, or makes its result wrong."""

    OK = 0
    WARNING = 1
    ERROR = 2


@dataclass(frozen=True)
class Finding:
    """One thing that was looked at; `advice` is an imperative, empty where there is nothing to do.

    `causes` are what would explain an error of the clocks, by name; empty where nothing known does.
    """

    level: Level
    subject: str
    found: str
    advice: str = ""
    causes: tuple[str, ...] = ()


@dataclass(frozen=True)
class PredictedSigma:
    """How well a number of the pose will be known: sigmas (m or rad) by hand, and of the adjustment."""

    name: str
    unit: str
    hand: float
    predicted: float


@dataclass(frozen=True)
class CheckReport:
    """All findings on a platform, in the order in which they were looked for, and the predicted sigmas if known."""

    platform: str
    findings: tuple[Finding, ...]
    predicted: tuple[PredictedSigma, ...] = ()

    @property
    def level(self) -> Level:
        """The worst of the findings."""
        return max((finding.level for finding in self.findings), default=Level.OK)

    def of(self, level: Level) -> tuple[Finding, ...]:
        """The findings of one level."""
        return tuple(finding for finding in self.findings if finding.level == level)


def ok(subject: str, found: str) -> Finding:
    """A finding that all is well."""
    return Finding(Level.OK, subject, found)


def warning(subject: str, found: str, advice: str) -> Finding:
    """A finding that the run can go on with, but a person should look at."""
    return Finding(Level.WARNING, subject, found, advice)


def error(subject: str, found: str, advice: str) -> Finding:
    """A finding that stops the run or makes its result wrong."""
    return Finding(Level.ERROR, subject, found, advice)


def of_fault(subject: str, fault: InputError) -> Finding:
    """The finding that a reader's fault is."""
    return error(subject, f"{fault.place}: {fault.found}, expected {fault.expected}", fault.remedy)


def of_faults(subject: str, faults: Sequence[InputError]) -> list[Finding]:
    """Findings of many files' faults: those with the same remedy told once, with the first of them and their count."""
    groups: dict[str, list[InputError]] = {}
    for fault in faults:
        groups.setdefault(fault.remedy, []).append(fault)
    findings = []
    for remedy, alike in groups.items():
        more = f" (and {len(alike) - 1} more like it)" if len(alike) > 1 else ""
        first = alike[0]
        findings.append(error(subject, f"{first.place}: {first.found}, expected {first.expected}{more}", remedy))
    return findings


def numbers(values: Iterable[int], most: int = 8) -> str:
    """Whole numbers in a sentence: "3, 5, 8", or the first of many and how many more."""
    listed = [str(int(value)) for value in values]
    if len(listed) <= most:
        return ", ".join(listed)
    return f"{', '.join(listed[:most])} and {len(listed) - most} more"


def span(values: Floats) -> str:
    """The range of values, "1.2 to 3.4"."""
    return f"{float(values.min()):.3g} to {float(values.max()):.3g}"

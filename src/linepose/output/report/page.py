"""The reports as HTML files that need no network: Jinja2 templates filled from the results."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import pandas as pd
from jinja2 import ChoiceLoader, Environment, PackageLoader, StrictUndefined

from linepose.output.report.pictures import Picture, embedded
from linepose.output.report.sections import SectionOnPage
from linepose.pipeline.checks import Level
from linepose.pipeline.pose_tables import PoseNumber
from linepose.pipeline.summary import PlatformSummary
from linepose.pipeline.verdict import Verdict

_WORDS: Final = {Level.GOOD: "good", Level.CARE: "care", Level.BAD: "bad"}
_SIGNS: Final = {Level.GOOD: "✓ passed", Level.CARE: "! look", Level.BAD: "✗ failed"}


@dataclass(frozen=True)
class FigureOnPage:
    """One figure: its place on the page, texts, and its picture, or the sentence that stands in its place."""

    anchor: str
    title: str
    caption: str
    alt: str
    picture: Picture | None
    left_out: str


@dataclass(frozen=True)
class PlatformOnPage:
    """One platform: its summary, the sections before its pose and after it, its figures and its settings."""

    summary: PlatformSummary
    leading: Sequence[SectionOnPage]
    sections: Sequence[SectionOnPage]
    figures: Sequence[FigureOnPage]
    settings: str


def figures_on_page(name: str, folder: Path, index: pd.DataFrame) -> list[FigureOnPage]:
    """Every figure of a platform's index, drawn ones with their pictures."""
    return [
        FigureOnPage(
            anchor=f"{name}-{row['figure']}",
            title=row["title"],
            caption=row["caption"],
            alt=row["alt"],
            picture=None if row["left_out"] else embedded(folder / f"{row['figure']}.png"),
            left_out=row["left_out"],
        )
        for _, row in index.iterrows()
    ]


def render_platform_page(platform: PlatformOnPage, settings: str, package_versions: Mapping[str, str]) -> str:
    """The page of one platform; `settings` is what config.yaml says."""
    template = page_environment().get_template("platform.html.j2")
    return template.render(one=platform, settings=settings, versions=package_versions)


def worst_first(summaries: Iterable[PlatformSummary]) -> list[PlatformSummary]:
    """Platforms by what needs a look: by verdict, then by how many checks gave it, then by name."""

    def order(summary: PlatformSummary) -> tuple[int, int, str]:
        level = summary.verdict.level
        return -level, -sum(check.level == level for check in summary.verdict.reasons), summary.name

    return sorted(summaries, key=order)


def render_study_page(
    summaries: Sequence[PlatformSummary],
    settings: str,
    package_versions: Mapping[str, str],
    further_pages: Mapping[str, str] | None = None,
) -> str:
    """The page over all platforms, which links to theirs at NAME/report.html.

    `further_pages` has the title and the address of other pages that it links to.
    """
    template = page_environment().get_template("study.html.j2")
    return template.render(
        summaries=summaries, settings=settings, versions=package_versions, further_pages=further_pages or {}
    )


def page_environment(*packages: str) -> Environment:
    """Jinja2 as the report's templates need it; templates of further packages are found beside the report's."""
    environment = Environment(
        loader=ChoiceLoader([PackageLoader(package) for package in ("linepose.output.report", *packages)]),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters |= {
        "word": _WORDS.__getitem__,
        "sign": _SIGNS.__getitem__,
        "number": _number,
        "brief": _brief,
        "why": _why,
        "capital": lambda text: text[:1].upper() + text[1:],
    }
    return environment


def _why(verdict: Verdict) -> str:
    """The worst reason of a verdict, and how many more there are."""
    if not verdict.reasons:
        return "every check passed"
    first, *more = verdict.reasons
    return f"{first.brief or first.name}{f', and {len(more)} more' if more else ''}"


def _number(value: float, of: PoseNumber) -> str:
    """A number to the digits that its unit deserves: tenths of millimetres, hundredths of degrees."""
    return _rounded(value, 2 if of.unit == "°" else 4)


def _brief(value: float, of: PoseNumber) -> str:
    """A number to the digits that a glance needs: millimetres, tenths of degrees."""
    return _rounded(value, 1 if of.unit == "°" else 3)


def _rounded(value: float, digits: int) -> str:
    return f"{round(value, digits) + 0.0:.{digits}f}"  # never -0.00

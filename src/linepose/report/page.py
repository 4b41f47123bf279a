"""The report as one HTML file that needs no network: a page of Jinja2 templates filled from the results."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path, PurePath
from platform import python_version
from typing import Any, Final

import pandas as pd
import yaml
from jinja2 import Environment, PackageLoader, StrictUndefined

from linepose.report.pictures import Picture, embedded
from linepose.report.pose_tables import PoseNumber
from linepose.report.summary import PlatformSummary
from linepose.report.verdict import Level

PACKAGES: Final = (
    "linepose",
    "corner",
    "emcee",
    "matplotlib",
    "numba",
    "numpy",
    "pandas",
    "pyarrow",
    "scipy",
    "snakemake",
)
_WORDS: Final = {Level.GOOD: "good", Level.CARE: "care", Level.BAD: "bad"}
_SIGNS: Final = {Level.GOOD: "✓ passed", Level.CARE: "! look", Level.BAD: "✗ failed"}


@dataclass(frozen=True)
class FigureOnPage:
    """One figure: its place on the page, texts, and its picture, or the sentence that stands in its place."""

    anchor: str
    title: str
    paper_figure: str
    caption: str
    alt: str
    picture: Picture | None
    left_out: str


@dataclass(frozen=True)
class PlatformOnPage:
    """One platform's section."""

    summary: PlatformSummary
    figures: list[FigureOnPage]
    settings: str


@dataclass(frozen=True)
class TableOnPage:
    """A table of results: title, a sentence, column heads, and rows of cells as text."""

    anchor: str
    title: str
    sentence: str
    heads: list[str]
    rows: list[list[str]]


def figures_on_page(name: str, folder: Path, index: pd.DataFrame) -> list[FigureOnPage]:
    """Every figure of a platform's index, drawn ones with their pictures."""
    return [
        FigureOnPage(
            anchor=f"{name}-{row['figure']}",
            title=row["title"],
            paper_figure=row["paper_figure"],
            caption=row["caption"],
            alt=row["alt"],
            picture=None if row["left_out"] else embedded(folder / f"{row['figure']}.png"),
            left_out=row["left_out"],
        )
        for _, row in index.iterrows()
    ]


def regression_on_page(regression: pd.DataFrame) -> list[TableOnPage]:
    """The published numbers beside the obtained ones, one table for each platform and table of the paper."""
    parts = regression["quantity"].str.split(", ", n=2, expand=True).fillna("")
    tables = []
    for number, ((platform, source), rows) in enumerate(
        regression.assign(platform=parts[0], source=parts[1], what=parts[2]).groupby(["platform", "source"], sort=False)
    ):
        cells = [
            [
                row["what"] or source,
                f"{row['published']:.6g}",
                f"{row['obtained']:.6g}",
                f"{row['tolerance']:.2g}",
                _outcome(row),
            ]
            for _, row in rows.iterrows()
        ]
        passed = int(rows["passed"].sum())
        tables.append(
            TableOnPage(
                f"published-{number}",
                f"{platform}: {source}",
                f"{passed} of {len(rows)} reproduced within the tolerance.",
                ["Quantity", "Published", "Obtained", "Tolerance", "Outcome"],
                cells,
            )
        )
    return tables


def _outcome(row: "pd.Series[Any]") -> str:
    if row["passed"]:
        return "✓ passed"
    return f"known deviation: {row['note']}" if row["known_deviation"] else "✗ differs"


def table_on_page(name: str, table: pd.DataFrame) -> TableOnPage:
    """A result table as it is, numbers to five digits."""
    rows = [[_cell(value) for value in row] for row in table.itertuples(index=False)]
    heads = [str(column).replace("_", " ") for column in table.columns]
    return TableOnPage(f"table-{name}", name.replace("_", " ").capitalize(), "", heads, rows)


def _cell(value: Any) -> str:
    if isinstance(value, float):
        return "" if pd.isna(value) else f"{value:.5g}"
    return str(value)


def versions() -> dict[str, str]:
    """Versions of Python and of the packages that results depend on."""
    return {"python": python_version()} | {name: metadata.version(name) for name in PACKAGES}


def settings_text(values: Mapping[str, Any]) -> str:
    """Settings as YAML; of an absolute path only its last part, because a report travels."""
    return yaml.safe_dump(
        _without_folders(dict(values)), sort_keys=False, allow_unicode=True, width=80, default_flow_style=None
    ).strip()


def _without_folders(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {key: _without_folders(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_without_folders(item) for item in value]
    if isinstance(value, PurePath) or (isinstance(value, str) and PurePath(value).is_absolute()):
        return f".../{PurePath(value).name}"
    return value


def render_page(
    platforms: Sequence[PlatformOnPage],
    published: Sequence[TableOnPage],
    tables: Sequence[TableOnPage],
    settings: str,
    package_versions: Mapping[str, str],
) -> str:
    """The whole page."""
    environment = Environment(
        loader=PackageLoader("linepose.report"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters |= {"word": _WORDS.__getitem__, "sign": _SIGNS.__getitem__, "number": _number}
    return environment.get_template("report.html.j2").render(
        platforms=platforms,
        published=published,
        tables=tables,
        settings=settings,
        versions=package_versions,
        good=Level.GOOD,
    )


def _number(value: float, of: PoseNumber) -> str:
    """A number to the digits that its unit deserves: tenths of millimetres, hundredths of degrees."""
    digits = 2 if of.unit == "°" else 4
    return f"{round(value, digits) + 0.0:.{digits}f}"  # never -0.00

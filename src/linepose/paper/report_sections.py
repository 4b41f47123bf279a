"""The published numbers beside the obtained ones, as the page shows them."""

from collections.abc import Mapping
from typing import Any, Final

import pandas as pd

from linepose.output.report.sections import SectionOnPage, TableOnPage, plain_table

_TABLES: Final = {
    "table2": "Table 2: sigmas of the navigation",
    "table3": "Table 3: pose from all observations, from the accepted ones, and measured by hand",
    "table4": "Table 4: pose from observations of high and of low diversity",
    "table5": "Table 5: pose from two subsets",
}
_HEADS: Final = ("Quantity", "Published", "Obtained", "Tolerance", "Outcome")
_SINGLE = "single checks"  # numbers that belong to no table of the paper


def published_sections(regression: pd.DataFrame, tables: Mapping[str, pd.DataFrame]) -> list[SectionOnPage]:
    """What differs; then each platform's numbers, a table for each source; then the paper's tables with their sigmas.

    `regression` as in `regression.REGRESSION`, `tables` the published tables by name.
    """
    parts = regression["quantity"].str.split(", ", n=2, expand=True).reindex(columns=range(3))
    single = parts[2].isna()
    rows = regression.assign(
        platform=parts[0], source=parts[1].mask(single, _SINGLE), what=parts[2].where(~single, parts[1])
    )
    sections = [_platform_section(str(name), part) for name, part in rows.groupby("platform", sort=False)]
    differing = rows[~rows["passed"] | rows["expected"].notna()]
    if len(differing):
        table = _table("published-differing", "Numbers that differ", "", differing, "quantity", folded=False)
        text = (
            f"{_told(rows)} A known deviation or an expected interval is declared before the run, with its reason: the "
            "number fails outside it, also where it is better."
        )
        sections.insert(0, SectionOnPage("published-what-differs", "What differs", text, [table]))
    if tables:
        shown = [plain_table(name, _TABLES.get(name, name), table) for name, table in tables.items()]
        sections.append(SectionOnPage("published-tables", "The paper's tables, with sigmas", "", shown))
    return sections


def _platform_section(platform: str, rows: pd.DataFrame) -> SectionOnPage:
    tables = [
        _table(f"published-{platform}-{number}", str(source), f"{_told(part)}{_remarks(part)}", part, "what")
        for number, (source, part) in enumerate(rows.groupby("source", sort=False))
    ]
    return SectionOnPage(f"published-{platform}", platform, _told(rows), tables)


def _told(rows: pd.DataFrame) -> str:
    deviating, passed = rows["expected"].notna(), rows["passed"]
    known, failed = int((deviating & passed).sum()), int((~passed).sum())
    told = f"{int((passed & ~deviating).sum())} of {len(rows)} reproduced within the tolerance"
    told += f", {known} as declared" if known else ""
    return told + (f", {failed} not reproduced." if failed else ".")


def _remarks(rows: pd.DataFrame) -> str:
    """What the notes of the reproduced numbers say, each once, as sentences with a space before each."""
    reproduced = rows["passed"] & rows["expected"].isna()
    notes = dict.fromkeys(note for note in rows.loc[reproduced, "note"] if note)
    return "".join(f" {note[:1].upper()}{note[1:]}." for note in notes)


def _table(
    anchor: str, title: str, sentence: str, rows: pd.DataFrame, what: str, *, folded: bool = True
) -> TableOnPage:
    cells = [
        [
            row[what],
            f"{row['published']:.6g}",
            f"{row['obtained']:.6g}",
            f"{row['tolerance']:.2g}",
            _outcome(row),
        ]
        for _, row in rows.iterrows()
    ]
    return TableOnPage(anchor, title, sentence, _HEADS, cells, folded)


def _outcome(row: "pd.Series[Any]") -> str:
    if pd.isna(row["expected"]):
        return "✓ passed" if row["passed"] else "✗ differs"
    instead = f"{row['expected']:.6g} ± {row['expected_tolerance']:.2g}: {row['note']}"
    return f"as declared, {instead}" if row["passed"] else f"✗ differs, {instead}"

"""What the page is put together from beside figures: sections of sentences and tables, all text by now."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

import pandas as pd

_LONGEST_NUMBER: Final = 20


@dataclass(frozen=True)
class TableOnPage:
    """A table of results: title, a sentence, column heads, and rows of cells; folded until its title is asked for."""

    anchor: str
    title: str
    sentence: str
    heads: Sequence[str]
    rows: Sequence[Sequence[str]]
    folded: bool = True

    @property
    def text_columns(self) -> set[int]:
        """Columns that hold names or sentences rather than numbers."""
        return {0} | {k for row in self.rows for k, text in enumerate(row) if len(text) > _LONGEST_NUMBER}


@dataclass(frozen=True)
class SectionOnPage:
    """A section with a heading: what it says, a blank line between paragraphs, and its tables."""

    anchor: str
    title: str
    text: str
    tables: Sequence[TableOnPage]

    @property
    def paragraphs(self) -> list[str]:
        """What it says, paragraph by paragraph."""
        return [paragraph for paragraph in self.text.split("\n\n") if paragraph]


def plain_table(name: str, title: str, table: pd.DataFrame) -> TableOnPage:
    """A result table as it is, numbers to five digits."""
    rows = [[cell(value) for value in row] for row in table.itertuples(index=False)]
    return TableOnPage(f"table-{name}", title, "", [str(column).replace("_", " ") for column in table.columns], rows)


def cell(value: Any) -> str:
    """A value as text: numbers to five digits, nothing for what is not known."""
    if isinstance(value, float):
        return "" if pd.isna(value) else f"{value:.5g}"
    return str(value)

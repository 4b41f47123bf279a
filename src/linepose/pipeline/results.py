"""The results of one platform: a folder of tables or tables in memory, each read once and checked."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import pandas as pd
import pyarrow as pa

from linepose.errors import InputError
from linepose.pipeline.table_checks import usable_rows
from linepose.tables import read_table


@dataclass(frozen=True, eq=False)
class Results:
    """Tables of a platform by the name of their file without its ending, such as `pose` or `mcmc/inliers`.

    `folder` is results/NAME, None where all tables are in `in_memory`.
    """

    name: str
    folder: Path | None = None
    in_memory: Mapping[str, pd.DataFrame] = field(default_factory=dict, repr=False)
    _read: dict[str, pd.DataFrame] = field(default_factory=dict, repr=False)

    def has(self, name: str) -> bool:
        """Whether this result was made."""
        return name in self.in_memory or (self.folder is not None and self.path(name).is_file())

    def path(self, name: str) -> Path:
        """Where a result stands."""
        return (self.folder or Path(self.name)) / f"{name}.parquet"

    def table(self, name: str, schema: pa.Schema) -> pd.DataFrame:
        """A result; `schema` is that of the function which makes it, and columns beyond it are kept.

        Raises InputError where it is missing, lacks columns or rows, or has a gap in a column that may have none.
        """
        if name not in self._read:
            if not self.has(name):
                remedy = f"run `linepose run {self.name}` first"
                raise InputError(str(self.path(name)), "no such result", "a finished calibration", remedy)
            table = self.in_memory[name] if name in self.in_memory else read_table(self.path(name), schema)
            whole = [column.name for column in schema if not column.nullable]
            self._read[name] = usable_rows(table, whole, f"{self.name}/{name}.parquet")
        return self._read[name]

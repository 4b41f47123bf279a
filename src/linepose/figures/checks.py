"""What a figure asks of its tables before it draws: it would rather say what is missing than show an empty axis."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from linepose.errors import InputError
from linepose.rotations import Floats


def usable_rows(table: pd.DataFrame, columns: Sequence[str], name: str) -> pd.DataFrame:
    """The table itself; raises InputError where it has no rows, lacks a column, or a number in these is not finite."""
    missing = [column for column in columns if column not in table.columns]
    if missing:
        raise InputError(
            name, f"no column {', '.join(missing)}", f"columns {', '.join(columns)}", "run its stage again"
        )
    if table.empty:
        raise InputError(name, "no rows", "at least one", "run its stage again")
    for column in columns:
        if table[column].dtype.kind == "f" and not np.all(np.isfinite(table[column])):
            count = int((~np.isfinite(table[column])).sum())
            raise InputError(
                name, f"{count} of {len(table)} numbers of {column} not finite", "finite numbers", "run its stage again"
            )
    return table


def stage_row(table: pd.DataFrame, stage: str, columns: Sequence[str], name: str) -> pd.Series:
    """The row of one stage, such as `inliers` or `hand_measured`; raises InputError where there is none."""
    rows = usable_rows(table, ["stage"], name)
    rows = rows[rows["stage"] == stage]
    if rows.empty:
        raise InputError(name, f"no stage {stage}", "one row for it", "run its stage again")
    return usable_rows(rows, columns, name).iloc[0]


def some_rows(values: Floats, most: int) -> Floats:
    """At most so many rows of samples (K, ...), drawn evenly over walkers and steps, the same at every call."""
    if len(values) <= most:
        return np.array(values)
    return np.array(values[np.sort(np.random.default_rng(0).choice(len(values), most, replace=False))])

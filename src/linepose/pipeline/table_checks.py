"""What a table of results must have before it is used: rows, columns, and finite numbers."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.geometry.pose import POSE_COLUMNS


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


def stage_rows(table: pd.DataFrame, stage: str, columns: Sequence[str], name: str) -> pd.DataFrame:
    """The rows of one stage, such as `inliers` or `hand_measured`; raises InputError where there are none."""
    rows = usable_rows(table, ["stage"], name)
    return usable_rows(rows[rows["stage"] == stage], columns, f"{name}, stage {stage}")


def accepted_rows(outliers: pd.DataFrame) -> pd.DataFrame:
    """The rows of the accepted stage of the outlier removal; raises InputError where there are none."""
    rows = usable_rows(outliers, ["accepted"], "outliers.parquet")
    return usable_rows(rows[rows["accepted"]], ["observation", "error_px"], "outliers.parquet, accepted stage")


def usable_chain(samples: pd.DataFrame) -> Floats:
    """The poses (S, 6) of a chain, `samples` as in `SAMPLES`; raises InputError for one that stands."""
    chain = usable_rows(samples, POSE_COLUMNS, "samples")[list(POSE_COLUMNS)].to_numpy()
    standing = [name for name, spread in zip(POSE_COLUMNS, np.ptp(chain, axis=0), strict=True) if spread == 0]
    if standing:
        raise InputError(
            "samples",
            f"the same value of {', '.join(standing)} in all {len(chain)} rows",
            "a chain that moves",
            "look at its acceptance in diagnostics.parquet, and run its stage again",
        )
    return chain

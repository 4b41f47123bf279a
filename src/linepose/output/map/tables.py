"""The maps of a platform's scans as results: the error budget, and what was counted of each scan's pixels."""

from collections.abc import Sequence
from typing import Final

import pandas as pd
import pyarrow as pa

from linepose.output.map.budget import BUDGET
from linepose.output.map.places import STATES
from linepose.output.map.platform_map import ScanMap
from linepose.tables import optional_floats, texts, whole_numbers

MAPPED: Final = pa.schema(
    [*texts("scan"), *optional_floats("cell_m"), *whole_numbers("n_pixels", *STATES, "n_cells", "n_filled")]
)
MAP_TABLES: Final = {"map_budget": BUDGET, "map_scans": MAPPED}


def map_tables(made: Sequence[ScanMap]) -> dict[str, pd.DataFrame]:
    """Tables of maps by the name of the workflow's result, a scan after the other; columns as in `MAP_TABLES`.

    `n_pixels` of a scan with, of them, those without a place by reason, and those that meet the ground twice; `n_cells`
    of `cell_m` that have a pixel, `n_filled` that are filled from beside.
    """
    rows = [
        {
            "scan": one.name,
            "cell_m": one.rasters.cell_m if one.rasters and one.rasters.n_rows else None,
            "n_pixels": one.n_pixels,
            **{state: one.counts[state] for state in STATES},
            "n_cells": one.rasters.n_cells if one.rasters else 0,
            "n_filled": one.rasters.n_filled if one.rasters else 0,
        }
        for one in made
    ]
    budgets = pd.concat([one.budget for one in made], ignore_index=True)
    numbers = [field.name for field in BUDGET if pa.types.is_floating(field.type)]
    return {
        "map_budget": budgets.astype(dict.fromkeys(numbers, float)),
        "map_scans": pd.DataFrame(rows).astype({"cell_m": float}),
    }

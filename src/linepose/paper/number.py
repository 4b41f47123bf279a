"""A published number beside the obtained one, before it is judged."""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import pandas as pd

Published = Mapping[str, Any]  # config/paper/published.yaml
Results = Mapping[str, pd.DataFrame]  # a platform's results by name: results/NAME/{name}.parquet


class Number(NamedTuple):
    """One number: what it is, published and obtained; and the sigma that the paper prints for it, 0 where none."""

    quantity: str
    published: float
    obtained: float
    sigma: float = 0.0


def numbers(
    quantity: str, columns: Sequence[str], published: Sequence[float], obtained: "pd.Series[float]"
) -> list[Number]:
    """A number for each published one, of the column of the same place."""
    return [
        Number(f"{quantity}, {column}", value, float(obtained[column]))
        for column, value in zip(columns, published, strict=True)
    ]

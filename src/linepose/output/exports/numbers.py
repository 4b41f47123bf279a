"""Numbers as text that read back to the same double."""

import numpy as np
from numpy.typing import ArrayLike

from linepose.arrays import exact_decimal


def plain(values: ArrayLike) -> list[float]:
    """An array (K,) as Python floats, never -0, which YAML and JSON write in full."""
    return [float(value) for value in np.asarray(values, dtype=float) + 0.0]


def numbers(values: ArrayLike) -> str:
    """Several numbers (K,), the shortest decimals that are these doubles, a space between."""
    return " ".join(map(exact_decimal, plain(values)))

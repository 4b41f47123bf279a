"""Fewer samples than a figure could show."""

import numpy as np

from linepose.arrays import Floats


def some_rows(values: Floats, most: int) -> Floats:
    """At most so many rows of samples (K, ...), drawn evenly over walkers and steps, the same at every call."""
    if len(values) <= most:
        return np.array(values)
    return np.array(values[np.sort(np.random.default_rng(0).choice(len(values), most, replace=False))])

"""How well refined points agree with the truth: bias and scatter along the scan line and along the track."""

from collections.abc import Mapping
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from linepose.extraction.refine import Refine, refine_points
from linepose.extraction.scans import Intensity
from linepose.rotations import Floats

_AXES: Final = ("u_px", "line")


def accuracy(found: ArrayLike, truth: ArrayLike) -> dict[str, float]:
    """Bias and standard deviation in u (px) and along the track (lines) of positions (K, 2), and how many are missing.

    A point that was not found is NaN; two or more must be found.
    """
    error = np.asarray(found, dtype=float) - np.asarray(truth, dtype=float)
    seen = error[np.isfinite(error).all(axis=1)]
    measures = {"n_points": float(len(error)), "n_missing": float(len(error) - len(seen))}
    for axis, name in enumerate(_AXES):
        measures[f"bias_{name}"] = float(seen[:, axis].mean())
        measures[f"sigma_{name}"] = float(seen[:, axis].std(ddof=1))
    return measures


def compare_methods(methods: Mapping[str, Refine], intensity: Intensity, labels: Floats, truth: Floats) -> pd.DataFrame:
    """Accuracy of each method on one scan (L, P), from labels (K, 2) to the truth (K, 2); one row a method."""
    rows = [
        {"method": name} | accuracy(refine_points(method, intensity, labels), truth) for name, method in methods.items()
    ]
    return pd.DataFrame(rows)

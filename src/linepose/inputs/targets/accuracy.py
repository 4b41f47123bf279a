"""How well refined points agree with the truth: bias and scatter along the scan line and across it."""

from collections.abc import Mapping
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from linepose.arrays import Floats
from linepose.inputs.scans.scan_files import Intensity
from linepose.inputs.targets.refine import Refine, refine_points

_AXES: Final = ("u_px", "v_px")


def accuracy(found: ArrayLike, truth: ArrayLike, v_px_per_line: ArrayLike) -> dict[str, float]:
    """Bias and standard deviation of positions (K, 2) of u and line, and how many are missing.

    Along the scan line they are in u (px). Across it a line is `v_px_per_line` (K,) pixels, by which the point moves
    from one line to the next; in a reverse pass that is negative. A point that was not found is NaN, as are bias
    and deviation of fewer than two.
    """
    error = np.asarray(found, dtype=float) - np.asarray(truth, dtype=float)
    error = error * np.stack([np.ones(len(error)), np.asarray(v_px_per_line, dtype=float)], axis=-1)
    seen = error[np.isfinite(error).all(axis=1)]
    measures: dict[str, float] = {"n_points": len(error), "n_missing": len(error) - len(seen)}
    for axis, name in enumerate(_AXES):
        measures[f"bias_{name}"] = float(seen[:, axis].mean()) if len(seen) > 1 else np.nan
        measures[f"sigma_{name}"] = float(seen[:, axis].std(ddof=1)) if len(seen) > 1 else np.nan
    return measures


def compare_methods(
    methods: Mapping[str, Refine], intensity: Intensity, labels: Floats, truth: Floats, v_px_per_line: Floats
) -> pd.DataFrame:
    """Accuracy of each method on one scan (L, P), from labels (K, 2) to the truth (K, 2); one row a method."""
    rows = [
        {"method": name} | accuracy(refine_points(method, intensity, labels), truth, v_px_per_line)
        for name, method in methods.items()
    ]
    return pd.DataFrame(rows)

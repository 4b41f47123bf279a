"""What the target's known geometry gained: the pose's sigmas with and without it."""

import numpy as np
import pandas as pd

from linepose.adjustment.thresholds import MISFIT_SIGMAS
from linepose.output.report.sections import TableOnPage
from linepose.pipeline.calibration import Calibration
from linepose.pipeline.evidence import pose_numbers


def knows_target(calibration: Calibration) -> bool:
    """Whether a calibration by the adjustment was made with a known target, and one without it beside."""
    return bool(np.isfinite(calibration.diagnostics["sigma_without_target"]).all())


def target_sentence(calibration: Calibration) -> str:
    """Whether the known geometry fits, and what it gains most."""
    table, misfit = _sigmas(calibration), _misfit(calibration)
    found = f"The target's known geometry is {max(misfit, 0.0):.1f} sigmas off what is seen without it"
    if misfit > MISFIT_SIGMAS:
        return f"{found}, and was not used."
    best = table.loc[(table["with"] / table["without"]).idxmin()]
    return f"{found}; with it the sigma of {best['name']} is {best['with'] / best['without']:.2f} times that without."


def target_table(anchor: str, calibration: Calibration) -> TableOnPage:
    """The pose's sigmas with and without the known geometry, a row a number."""
    rows = []
    for _, row in _sigmas(calibration).iterrows():
        without, with_it = row["without"], row["with"]
        name = f"{row['name']} ({row['unit']})"
        rows.append([name, f"{without:.4f}", f"{with_it:.4f}", f"{with_it / without:.2f}"])
    heads = ["Number", "Sigma without", "Sigma with", "With / without"]
    return TableOnPage(anchor, "Known target", "What its geometry gained.", heads, rows, folded=False)


def _sigmas(calibration: Calibration) -> pd.DataFrame:
    told = calibration.diagnostics.reset_index(drop=True)
    numbers = pose_numbers(calibration)
    return pd.DataFrame(
        {
            "name": [number.name for number in numbers],
            "unit": [number.unit for number in numbers],
            "without": told["sigma_without_target"][: len(numbers)],
            "with": told["laplace_sigma"][: len(numbers)],
        }
    )


def _misfit(calibration: Calibration) -> float:
    return float(calibration.diagnostics["target_misfit_sigmas"].iloc[0])

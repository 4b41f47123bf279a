"""Published numbers beside those of a simulated survey, and its estimates beside the truth.

What is simulated is alike to the field survey in layout and reported sigmas, not the same: tolerances are wide.
"""

from collections.abc import Mapping
from typing import Any, Final

import numpy as np
import pandas as pd
from scipy.stats import chi2

from linepose.estimation.outliers import removal_order, stage_observations
from linepose.experiments.truth_error import POSE, POSITION, ROTATION
from linepose.geometry.pose import POSE_COLUMNS, SIGMA_COLUMNS
from linepose.paper.row import row

SIMULATED_RELATIVE: Final = 0.40
SIMULATED: Final = "simulated"
_LIMIT_SIGMAS: Final = 3.0
_PARAMETERS: Final = {POSITION: 3, ROTATION: 3, POSE: 6}  # that each whole is made of
_MISSED_AT_MOST: Final = 0.05
_REQUIRED: Final = "simulated; required, not published"
_CORRELATED: Final = (
    "simulated; the likelihood takes the points of a view as independent, where their navigation errors are alike: "
    "its sigmas come out too small for errors as large as the reported ones"
)


def sigma_rows(quantity: str, published: Mapping[str, Any], obtained: pd.Series) -> list[dict[str, Any]]:
    """Table 3's sigmas of one stage, to 40 %."""
    return [
        row(f"{quantity}, {column}", p, obtained[column], SIMULATED_RELATIVE * p, SIMULATED)
        for column, p in zip(SIGMA_COLUMNS, published["sigma"], strict=True)
    ]


def fault_rows(
    name: str, counts: Mapping[str, int], truth: pd.DataFrame, outliers: pd.DataFrame
) -> list[dict[str, Any]]:
    """Section 4's counts, and whether exactly the observations with planted faults are removed."""
    removed, remaining = removal_order(outliers), stage_observations(outliers)["inliers"]
    planted = sorted(int(number) for number in truth.loc[truth["faulty"], "observation"].unique())
    rows = [
        row(f"{name}, section 4, number of outliers", counts["outliers"], len(removed), 0, SIMULATED),
        row(f"{name}, section 4, number of inliers", counts["inliers"], len(remaining), 0, SIMULATED),
    ]
    return rows + [
        row(f"{name}, planted fault {number} removed", number, number if number in removed else 0, 0, SIMULATED)
        for number in planted
    ]


def extraction_rows(
    name: str, accuracy: pd.DataFrame, detection: pd.DataFrame, sigma_px: Mapping[str, float]
) -> list[dict[str, Any]]:
    """What is asked of extraction: 95 % of the visible points found without labels, and none with a wrong id.

    Points refined by the platform's method are off by no more, as a root mean square, than its camera's `sigma_px`
    (u_px and v_px), on which the likelihood rests.
    """
    visible, wrong = int(detection["n_visible"].sum()), int(detection["n_wrong"].sum())
    found = int(detection["n_found"].sum()) - wrong
    refined = accuracy[accuracy["chosen"]]
    seen = refined["n_points"] - refined["n_missing"]
    rows = [
        row(f"{name}, detection, visible points found", visible, found, _MISSED_AT_MOST * visible, _REQUIRED),
        row(f"{name}, detection, wrong ids", 0, wrong, 0, _REQUIRED),
    ]
    for axis in ("u_px", "v_px"):
        square = (seen * refined[f"bias_{axis}"] ** 2 + (seen - 1) * refined[f"sigma_{axis}"] ** 2).sum() / seen.sum()
        rows.append(row(f"{name}, extraction, rms error_{axis}", 0.0, np.sqrt(square), sigma_px[axis], _REQUIRED))
    return rows


def truth_rows(
    name: str, published: Mapping[str, Any], truth_error: pd.DataFrame, stage: str = "inliers"
) -> list[dict[str, Any]]:
    """The inliers' error against the truth: in its unit to three published sigmas, and over its own sigma to three.

    Position and rotation as wholes are held to three times the root of the summed squares of their published sigmas.
    A whole's limit in sigmas has the same probability as three sigmas of one parameter. An error beyond its limit is
    a known deviation of the paper's likelihood, and says why.
    """
    errors = truth_error[truth_error["stage"] == stage].set_index("quantity")
    sigma = dict(zip(POSE_COLUMNS, published["sigma"], strict=True))
    sigma |= {POSITION: np.linalg.norm(published["sigma"][:3]), ROTATION: np.linalg.norm(published["sigma"][3:])}
    rows = [
        row(f"{name}, error against truth, {column}", 0.0, errors.loc[column, "error"], _LIMIT_SIGMAS * s, SIMULATED)
        for column, s in sigma.items()
    ]
    for column in (*POSE_COLUMNS, POSITION, ROTATION, POSE):
        ratio = float(errors.loc[column, "error_in_sigmas"])
        limit = float(np.sqrt(chi2.isf(chi2.sf(_LIMIT_SIGMAS**2, 1), _PARAMETERS.get(column, 1))))
        rows.append(
            row(
                f"{name}, error against truth in sigmas, {column}",
                0.0,
                ratio,
                limit,
                _CORRELATED,
                known_deviation=abs(ratio) > limit,
            )
        )
    return rows

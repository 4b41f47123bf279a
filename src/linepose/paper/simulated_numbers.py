"""Published numbers beside those of a simulated survey, and its estimates beside the truth.

What is simulated is alike to the field survey in layout and reported sigmas, not the same.
"""

from collections.abc import Mapping

import numpy as np
import pandas as pd

from linepose.estimation.outliers import removal_order, stage_observations
from linepose.experiments.truth_error import POSE, POSITION, ROTATION
from linepose.geometry.pose import POSE_COLUMNS, SIGMA_COLUMNS
from linepose.paper.number import Number, Published, Results, numbers
from linepose.paper.stage_numbers import navigation_numbers


def fault_numbers(name: str, counts: Mapping[str, int], truth: pd.DataFrame, outliers: pd.DataFrame) -> list[Number]:
    """Section 4's counts, and whether exactly the observations with planted faults are removed."""
    removed, remaining = removal_order(outliers), stage_observations(outliers)["inliers"]
    planted = sorted(int(number) for number in truth.loc[truth["faulty"], "observation"].unique())
    return [
        Number(f"{name}, section 4, number of outliers", counts["outliers"], len(removed)),
        Number(f"{name}, section 4, number of inliers", counts["inliers"], len(remaining)),
        *(Number(f"{name}, planted fault {one} removed", one, one if one in removed else 0) for one in planted),
    ]


def extraction_numbers(name: str, accuracy: pd.DataFrame, detection: pd.DataFrame) -> list[Number]:
    """Points found without labels of those visible, those with a wrong id, and the refined ones' RMS error (px)."""
    visible, wrong = int(detection["n_visible"].sum()), int(detection["n_wrong"].sum())
    refined = accuracy[accuracy["chosen"]]
    seen = refined["n_points"] - refined["n_missing"]
    mean_square = {
        axis: (seen * refined[f"bias_{axis}"] ** 2 + (seen - 1) * refined[f"sigma_{axis}"] ** 2).sum() / seen.sum()
        for axis in ("u_px", "v_px")
    }
    return [
        Number(f"{name}, detection, visible points found", visible, int(detection["n_found"].sum()) - wrong),
        Number(f"{name}, detection, wrong ids", 0, wrong),
        *(
            Number(f"{name}, extraction, rms error_{axis}", 0.0, np.sqrt(square))
            for axis, square in mean_square.items()
        ),
    ]


def truth_numbers(name: str, sigma: list[float], truth_error: pd.DataFrame) -> list[Number]:
    """The inliers' error against the truth, in its unit and over its own sigma; the paper's sigmas (6,) beside them.

    Position and rotation as wholes have the root of the summed squares of their published sigmas.
    """
    errors = truth_error[truth_error["stage"] == "inliers"].set_index("quantity")
    published_sigma = dict(zip(POSE_COLUMNS, sigma, strict=True))
    published_sigma |= {POSITION: float(np.linalg.norm(sigma[:3])), ROTATION: float(np.linalg.norm(sigma[3:]))}
    in_sigmas = (*POSE_COLUMNS, POSITION, ROTATION, POSE)
    return [
        *(
            Number(f"{name}, error against truth, {column}", 0.0, errors.loc[column, "error"], one)
            for column, one in published_sigma.items()
        ),
        *(
            Number(f"{name}, error against truth in sigmas, {column}", 0.0, errors.loc[column, "error_in_sigmas"])
            for column in in_sigmas
        ),
    ]


def simulated_numbers(key: str, name: str, published: Published, results: Results) -> list[Number]:
    """A simulated platform beside the one of the paper that it is like (`key`), and beside its own truth."""
    table3, counts = published["table3"][key], published["section4"][key]
    every, inliers = table3[f"all_{counts['observations']}"], table3[f"inliers_{counts['inliers']}"]
    poses = results["pose"].set_index("stage")
    return [
        *navigation_numbers(name, published["table2"][key], results),
        *fault_numbers(name, counts, results["truth"], results["outliers"]),
        *numbers(f"{name}, Table 3, all", SIGMA_COLUMNS, every["sigma"], poses.loc["all"]),
        *numbers(f"{name}, Table 3, inliers", SIGMA_COLUMNS, inliers["sigma"], poses.loc["inliers"]),
        *truth_numbers(name, inliers["sigma"], results["truth_error"]),
        *extraction_numbers(name, results["extraction_accuracy"], results["detection"]),
    ]

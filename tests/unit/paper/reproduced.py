"""Results of the four platforms of the paper that reproduce every number, or deviate just as declared."""

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from linepose.config.yaml_file import read_yaml
from linepose.experiments.truth_error import POSE, POSITION, ROTATION
from linepose.geometry.pose import POSE_COLUMNS, SIGMA_COLUMNS
from linepose.paper.declarations import load_declarations
from linepose.survey.navigation import SIGMA_COLUMNS as NAVIGATION_SIGMA_COLUMNS

PAPER = Path(__file__).parents[3] / "config" / "paper"
PUBLISHED = read_yaml(PAPER / "published.yaml")
DECLARED = load_declarations(PAPER / "regression.yaml")
REMOVED = PUBLISHED["section4"]["ladybird_removed"]


def outliers(n_observations: int, removed: list[int]) -> pd.DataFrame:
    """All observations down to one below the accepted stage, removed in this order."""
    rows = []
    left = list(range(1, n_observations + 1))
    order = [*removed, next(n for n in left if n not in removed)]
    for turn, worst in enumerate([*order, None]):
        rows += [
            {"n_observations": len(left), "observation": n, "removed": n == worst, "accepted": turn == len(removed)}
            for n in left
        ]
        left = [n for n in left if n != worst]
    return pd.DataFrame(rows)


def navigation_sigma(published: list[float]) -> pd.DataFrame:
    """Table 2's medians in m and rad."""
    sigma = np.array(published)
    sigma[3:] = np.deg2rad(sigma[3:])
    return pd.DataFrame([sigma], columns=list(NAVIGATION_SIGMA_COLUMNS))


def estimate(printed: dict[str, list[float]], **columns: Any) -> dict[str, Any]:
    """A row with a printed pose and its sigmas."""
    sigma = printed.get("sigma", [0.01] * 6)
    return (
        columns | dict(zip(POSE_COLUMNS, printed["pose"], strict=True)) | dict(zip(SIGMA_COLUMNS, sigma, strict=True))
    )


def stages(all_: dict[str, Any], inliers: dict[str, Any], hand: dict[str, Any], minimum: float) -> pd.DataFrame:
    """A table of poses, one row a stage."""
    named = {"all": all_, "inliers": inliers, "hand_measured": hand}
    return pd.DataFrame([estimate(one, stage=name, neg_log_likelihood=minimum) for name, one in named.items()])


def basin(outside: float) -> pd.DataFrame:
    """Success rates of two searches; only the paper's counts."""
    return pd.DataFrame(
        {
            "optimiser": ["powell", "powell", "wide", "wide"],
            "region": ["inside", "outside"] * 2,
            "success_rate": [1.0, outside, 0.0, 0.0],
        }
    )


def ladybird() -> dict[str, pd.DataFrame]:
    """The field platform's results."""
    table3, low = PUBLISHED["table3"]["ladybird"], PUBLISHED["table4_low_verified"]
    low = low | {"sigma": PUBLISHED["table4"]["low"]["sigma"]}
    subsets = {"high": PUBLISHED["table4"]["high"], "low": low}
    minimum = low["neg_log_likelihood"]
    return {
        "pose": stages(
            table3["all_25"],
            table3["inliers_16"],
            table3["hand_measured"],
            PUBLISHED["notebook"]["neg_log_likelihood"],
        ),
        "outliers": outliers(25, REMOVED),
        "navigation_sigma": navigation_sigma(PUBLISHED["table2"]["ladybird"]),
        "subsets": pd.DataFrame(
            [estimate(one, subset=name, neg_log_likelihood=minimum) for name, one in subsets.items()]
        ),
        "repeatability": pd.DataFrame([estimate(one, subset=name) for name, one in PUBLISHED["table5"].items()]),
        "basin_summary": basin(0.6),
    }


def attitude() -> dict[str, pd.DataFrame]:
    """The field platform's results under the other attitude columns."""
    own = PUBLISHED["ladybird_attitude"]
    return ladybird() | {"pose": stages(own, own, own, own["neg_log_likelihood"])}


def truth_errors(platform: str) -> pd.DataFrame:
    """Errors in sigmas as declared, and none in metres and radians."""
    quantities = [*POSE_COLUMNS, POSITION, ROTATION, POSE]
    declared = [f"{platform}, error against truth in sigmas, {one}" for one in quantities]
    return pd.DataFrame(
        {
            "stage": "inliers",
            "quantity": quantities,
            "error": 0.0,
            "error_in_sigmas": [DECLARED.expected[name][0].expected for name in declared],
        }
    )


def simulated(platform: str, key: str) -> dict[str, pd.DataFrame]:
    """A simulated platform's results; the removed observations are those with planted faults."""
    counts, table3 = PUBLISHED["section4"][key], PUBLISHED["table3"][key]
    n, faulty = counts["observations"], list(range(1, counts["outliers"] + 1))
    observation = np.arange(1, n + 1)
    every, inliers = table3[f"all_{n}"], table3[f"inliers_{counts['inliers']}"]
    return {
        "pose": stages(every, inliers, table3["hand_measured"], 1.0),
        "outliers": outliers(n, faulty),
        "navigation_sigma": navigation_sigma(PUBLISHED["table2"][key]),
        "truth": pd.DataFrame({"observation": observation, "faulty": observation <= len(faulty)}),
        "truth_error": truth_errors(platform),
        "extraction_accuracy": pd.DataFrame(
            {
                "chosen": [True, False] * 2,
                "n_points": 15,
                "n_missing": 0,
                "bias_u_px": [0.0, 9.0] * 2,
                "sigma_u_px": [0.01, 9.0] * 2,
                "bias_v_px": 0.0,
                "sigma_v_px": 0.01,
            }
        ),
        "detection": pd.DataFrame({"n_visible": [50, 50], "n_found": [50, 50], "n_wrong": [0, 0]}),
        "basin_summary": basin(DECLARED.expected["shrimp-sim, section 4.7, success outside"][0].expected),
    }


def everything() -> dict[str, dict[str, pd.DataFrame]]:
    """The results of all four platforms."""
    return {
        "ladybird": ladybird(),
        "ladybird-attitude": attitude(),
        "ladybird-sim": simulated("ladybird-sim", "ladybird"),
        "shrimp-sim": simulated("shrimp-sim", "shrimp"),
    }

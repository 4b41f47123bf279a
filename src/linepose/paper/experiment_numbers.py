"""The published numbers of the experiments beside the obtained ones: Tables 4 and 5, and section 4.7."""

from collections.abc import Mapping, Sequence
from typing import Final

import pandas as pd

from linepose.geometry.pose import POSE_COLUMNS, SIGMA_COLUMNS
from linepose.paper.number import Number, Published, Results, numbers

_SWEEP: Final = "powell"  # the search that section 4.7 describes


def subset_numbers(
    quantity: str, published: Mapping[str, Sequence[float]], obtained: "pd.Series[float]"
) -> list[Number]:
    """A subset's pose and, where they are printed, its sampled sigmas."""
    pose = numbers(quantity, POSE_COLUMNS, published["pose"], obtained)
    return pose + (numbers(quantity, SIGMA_COLUMNS, published["sigma"], obtained) if "sigma" in published else [])


def basin_numbers(name: str, published: Published, results: Results) -> list[Number]:
    """Section 4.7: the share of the starts inside the triangle that find the optimum, and outside."""
    summary = results["basin_summary"]
    rates = summary[summary["optimiser"] == _SWEEP].set_index("region")["success_rate"]
    beyond = published["section4"]["basin"]["beyond_success_rate"]
    return [
        Number(f"{name}, section 4.7, success inside", 1.0, rates["inside"]),
        Number(f"{name}, section 4.7, success outside", beyond, rates["outside"]),
    ]


def table_numbers(name: str, published: Published, results: Results) -> list[Number]:
    """Tables 4 and 5, and the true minimum of Table 4's "low"."""
    diversity, pairs = results["subsets"].set_index("subset"), results["repeatability"].set_index("subset")
    table4, table5, verified = published["table4"], published["table5"], published["table4_low_verified"]
    low = diversity.loc["low"]
    minimum = Number(
        f"{name}, verified, low, neg_log_likelihood", verified["neg_log_likelihood"], low["neg_log_likelihood"]
    )
    return [
        *subset_numbers(f"{name}, Table 4, high", table4["high"], diversity.loc["high"]),
        *subset_numbers(f"{name}, Table 4, low", table4["low"], low),
        *subset_numbers(f"{name}, verified, low", verified, low),
        minimum,
        *subset_numbers(f"{name}, Table 5, subset_1", table5["subset_1"], pairs.loc["subset_1"]),
        *subset_numbers(f"{name}, Table 5, subset_2", table5["subset_2"], pairs.loc["subset_2"]),
    ]

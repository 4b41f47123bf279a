"""The published numbers beside the obtained ones: which hold, which do not, and which are known not to."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any, Final

import numpy as np
import pandas as pd

from linepose.arrays import Floats
from linepose.errors import EstimationError
from linepose.estimation.outliers import removal_order, stage_observations
from linepose.geometry.pose import POSE_COLUMNS, SIGMA_COLUMNS, rotation_vector_covariance, rotation_vector_pose
from linepose.paper.row import row
from linepose.paper.simulated_regression import fault_rows, sigma_rows, truth_rows
from linepose.survey.navigation import SIGMA_COLUMNS as NAVIGATION_SIGMA_COLUMNS

NAVIGATION_RELATIVE: Final = 0.02
POSE_ABSOLUTE: Final = 0.0015
SIGMA_RELATIVE: Final = 0.10
LIKELIHOOD_RELATIVE: Final = 1e-5
ROUNDING: Final = 0.0005  # half of the last printed digit
_STAGES: Final = {"all": "all_25", "inliers": "inliers_16", "hand_measured": "hand_measured"}


@dataclass(frozen=True)
class PlatformResults:
    """What the regression reads of one platform: its poses, outlier stages and median navigation sigmas.

    Of a simulated one also the truth and how far the estimate is from it; both are empty for the others.
    """

    pose: pd.DataFrame
    outliers: pd.DataFrame
    navigation_sigma: pd.DataFrame
    truth: pd.DataFrame = field(default_factory=pd.DataFrame)
    truth_error: pd.DataFrame = field(default_factory=pd.DataFrame)


def navigation_rows(name: str, published: Sequence[float], sigma: pd.DataFrame) -> list[dict[str, Any]]:
    """Table 2: median navigation sigmas, m and deg."""
    obtained = sigma.iloc[0][list(NAVIGATION_SIGMA_COLUMNS)].to_numpy(dtype=float, copy=True)
    obtained[3:] = np.rad2deg(obtained[3:])
    labels = [column.replace("_rad", "_deg") for column in NAVIGATION_SIGMA_COLUMNS]
    return [
        row(f"{name}, Table 2, {label}", p, o, NAVIGATION_RELATIVE * p)
        for label, p, o in zip(labels, published, obtained, strict=True)
    ]


def pose_rows(quantity: str, published: Mapping[str, Sequence[float]], obtained: pd.Series) -> list[dict[str, Any]]:
    """A pose and its sampled sigmas (Tables 3-5): the pose to 0.0015, the sigmas to 10 % and rounding."""
    poses = [
        row(f"{quantity}, {column}", p, obtained[column], POSE_ABSOLUTE)
        for column, p in zip(POSE_COLUMNS, published["pose"], strict=True)
    ]
    sigmas = [
        row(f"{quantity}, {column}", p, obtained[column], SIGMA_RELATIVE * p + ROUNDING)
        for column, p in zip(SIGMA_COLUMNS, published.get("sigma", ()), strict=False)
    ]
    return poses + sigmas


def hand_measured_rows(
    name: str, published: Mapping[str, Sequence[float]], pose: Floats, sigma: Floats, deviation: str = ""
) -> list[dict[str, Any]]:
    """Table 3's hand-measured row, which follows from Table 1 by conversion alone: to the last printed digit.

    `deviation` says why the sigmas are known not to follow.
    """
    quantity = f"{name}, Table 3, hand_measured"
    poses = [
        row(f"{quantity}, {c}", p, o, ROUNDING) for c, p, o in zip(POSE_COLUMNS, published["pose"], pose, strict=True)
    ]
    sigmas = [
        row(f"{quantity}, {c}", p, o, ROUNDING, deviation, bool(deviation) and abs(p - o) > ROUNDING)
        for c, p, o in zip(SIGMA_COLUMNS, published["sigma"], sigma, strict=True)
    ]
    return poses + sigmas


def outlier_rows(
    name: str, removed: Sequence[int], inliers: Sequence[int], outliers: pd.DataFrame
) -> list[dict[str, Any]]:
    """Figure 8: which observation is removed at each turn, and which remain; a missing one counts as 0."""
    order = removal_order(outliers)
    remaining = stage_observations(outliers)["inliers"]
    counts = [
        row(f"{name}, section 4, number of outliers", len(removed), len(order), 0),
        row(f"{name}, section 4, number of inliers", len(inliers), len(remaining), 0),
    ]
    turns = [
        row(f"{name}, Figure 8, removed at turn {turn}", number, order[turn - 1] if turn <= len(order) else 0, 0)
        for turn, number in enumerate(removed, start=1)
    ]
    kept = [
        row(f"{name}, Figure 8, inlier {number}", number, number if number in remaining else 0, 0) for number in inliers
    ]
    return counts + turns + kept


def likelihood_row(quantity: str, published: float, obtained: float, rounding: float) -> dict[str, Any]:
    """-log L, to 1e-5 of itself and the rounding of the printed number."""
    return row(quantity, published, obtained, LIKELIHOOD_RELATIVE * published + rounding)


def ladybird_rows(name: str, published: Mapping[str, Any], results: PlatformResults) -> list[dict[str, Any]]:
    """Every number of the field platform: Tables 2 and 3, Figure 8, and the authors' notebook."""
    section = published["section4"]
    poses = results.pose.set_index("stage")
    table3 = published["table3"]["ladybird"]
    hand = poses.loc["hand_measured"]
    rows = navigation_rows(name, published["table2"]["ladybird"], results.navigation_sigma)
    rows += outlier_rows(name, section["ladybird_removed"], section["ladybird_inliers"], results.outliers)
    for stage in ("all", "inliers"):
        rows += pose_rows(f"{name}, Table 3, {_STAGES[stage]}", table3[_STAGES[stage]], poses.loc[stage])
    rows += hand_measured_rows(
        name,
        table3["hand_measured"],
        hand[list(POSE_COLUMNS)].to_numpy(dtype=float),
        hand[list(SIGMA_COLUMNS)].to_numpy(dtype=float),
    )
    notebook = published["notebook"]
    inliers = poses.loc["inliers"]
    rows.append(
        likelihood_row(
            f"{name}, notebook, neg_log_likelihood", notebook["neg_log_likelihood"], inliers["neg_log_likelihood"], 0.0
        )
    )
    return rows + pose_rows(f"{name}, notebook", notebook, inliers)


def attitude_rows(name: str, published: Mapping[str, Any], results: PlatformResults) -> list[dict[str, Any]]:
    """The field platform under the other attitude columns: -log L, the pose, and the same inliers."""
    expected = published["ladybird_attitude"]
    inliers = results.pose.set_index("stage").loc["inliers"]
    remaining = stage_observations(results.outliers)["inliers"]
    rows = [
        likelihood_row(
            f"{name}, verified, neg_log_likelihood",
            expected["neg_log_likelihood"],
            inliers["neg_log_likelihood"],
            ROUNDING,
        )
    ]
    rows += pose_rows(f"{name}, verified", expected, inliers)
    return rows + [
        row(f"{name}, verified, inlier {number}", number, number if number in remaining else 0, 0)
        for number in published["section4"]["ladybird_inliers"]
    ]


def check_passed(regression: pd.DataFrame) -> None:
    """Raise EstimationError naming the rows that neither pass nor are known deviations."""
    failed = regression[~regression["passed"] & ~regression["known_deviation"]]
    if len(failed):
        told = "; ".join(
            f"{r.quantity}: published {r.published:g}, obtained {r.obtained:.6g}, tolerance {r.tolerance:.2g}"
            for r in failed.itertuples()
        )
        raise EstimationError(f"{len(failed)} of {len(regression)} published numbers are not reproduced: {told}")


_SHRIMP_DEVIATION: Final = (
    "does not follow from 2 deg per Euler angle: first-order propagation through any Euler sequence gives other sigmas"
)


def shrimp_hand_measured_rows(published: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Table 3's hand-measured Shrimp row from its Table 1 pose, 0.1 m and 2 deg; its rotation sigmas deviate."""
    table1 = published["table1"]["shrimp"]
    euler_pose = np.concatenate([table1["position_m"], np.deg2rad(table1["euler_deg"])])
    covariance = np.diag(np.repeat([0.1, np.deg2rad(2.0)], 3) ** 2)
    sigma = np.sqrt(np.diag(rotation_vector_covariance(euler_pose, covariance)))
    table3 = published["table3"]["shrimp"]["hand_measured"]
    return hand_measured_rows("shrimp", table3, rotation_vector_pose(euler_pose), sigma, _SHRIMP_DEVIATION)


def simulated_rows(key: str, name: str, published: Mapping[str, Any], results: PlatformResults) -> list[dict[str, Any]]:
    """A simulated platform beside the one of the paper that it is like (`key`), and beside its own truth."""
    table3, counts = published["table3"][key], published["section4"][key]
    inliers = table3[f"inliers_{counts['inliers']}"]
    poses = results.pose.set_index("stage")
    return [
        *navigation_rows(name, published["table2"][key], results.navigation_sigma),
        *fault_rows(name, counts, results.truth, results.outliers),
        *sigma_rows(f"{name}, Table 3, all", table3[f"all_{counts['observations']}"], poses.loc["all"]),
        *sigma_rows(f"{name}, Table 3, inliers", inliers, poses.loc["inliers"]),
        *truth_rows(name, inliers, results.truth_error),
    ]


ROWS_OF: Final[dict[str, Callable[[str, Mapping[str, Any], PlatformResults], list[dict[str, Any]]]]] = {
    "ladybird": ladybird_rows,
    "ladybird_attitude": attitude_rows,
    "ladybird_simulated": partial(simulated_rows, "ladybird"),
    "shrimp_simulated": partial(simulated_rows, "shrimp"),
}


def regression_table(
    published: Mapping[str, Any], results: Mapping[str, PlatformResults], published_as: Mapping[str, str]
) -> pd.DataFrame:
    """One row a published number; `published_as` says which numbers each platform (by name) is held against.

    Columns as in `row.REGRESSION`.
    """
    rows = shrimp_hand_measured_rows(published)
    for name, platform in results.items():
        rows += ROWS_OF[published_as[name]](name, published, platform)
    return pd.DataFrame(rows)

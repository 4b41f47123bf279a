"""The published numbers of a platform's stages beside the obtained ones: Tables 2 and 3, Figure 8, the notebook."""

from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np
import pandas as pd

from linepose.estimation.outliers import removal_order, stage_observations
from linepose.geometry.pose import POSE_COLUMNS, SIGMA_COLUMNS, rotation_vector_pose
from linepose.paper.hand_measured import as_printed, hand_measured_sigma
from linepose.paper.number import Number, Published, Results, numbers
from linepose.survey.navigation import SIGMA_COLUMNS as NAVIGATION_SIGMA_COLUMNS

_STAGES: Final = {"all": "all_25", "inliers": "inliers_16", "hand_measured": "hand_measured"}


def navigation_numbers(name: str, published: Sequence[float], results: Results) -> list[Number]:
    """Table 2: median navigation sigmas, m and deg."""
    obtained = results["navigation_sigma"].iloc[0][list(NAVIGATION_SIGMA_COLUMNS)].to_numpy(dtype=float, copy=True)
    obtained[3:] = np.rad2deg(obtained[3:])
    labels = [column.replace("_rad", "_deg") for column in NAVIGATION_SIGMA_COLUMNS]
    return numbers(f"{name}, Table 2", labels, published, pd.Series(obtained, labels))


def pose_numbers(quantity: str, published: Mapping[str, Sequence[float]], obtained: "pd.Series[float]") -> list[Number]:
    """A pose and its sigmas (Table 3, the notebook)."""
    pose = numbers(quantity, POSE_COLUMNS, published["pose"], obtained)
    return pose + (numbers(quantity, SIGMA_COLUMNS, published["sigma"], obtained) if "sigma" in published else [])


def outlier_numbers(name: str, published: Published, outliers: pd.DataFrame) -> list[Number]:
    """Figure 8: which observation is removed at each turn, and which remain; a missing one counts as 0."""
    removed, inliers = published["section4"]["ladybird_removed"], published["section4"]["ladybird_inliers"]
    order, remaining = removal_order(outliers), stage_observations(outliers)["inliers"]
    return [
        Number(f"{name}, section 4, number of outliers", len(removed), len(order)),
        Number(f"{name}, section 4, number of inliers", len(inliers), len(remaining)),
        *(
            Number(f"{name}, Figure 8, removed at turn {turn}", number, order[turn - 1] if turn <= len(order) else 0)
            for turn, number in enumerate(removed, start=1)
        ),
        *inlier_numbers(f"{name}, Figure 8", inliers, outliers),
    ]


def inlier_numbers(quantity: str, inliers: Sequence[int], outliers: pd.DataFrame) -> list[Number]:
    """Each observation that must remain, and itself where it does; 0 where not."""
    remaining = stage_observations(outliers)["inliers"]
    return [Number(f"{quantity}, inlier {number}", number, number if number in remaining else 0) for number in inliers]


def field_numbers(name: str, published: Published, results: Results) -> list[Number]:
    """Every number of the field platform's stages: Tables 2 and 3, Figure 8, and the authors' notebook."""
    poses, table3, notebook = as_printed(results["pose"]), published["table3"]["ladybird"], published["notebook"]
    inliers = poses.loc["inliers"]
    return [
        *navigation_numbers(name, published["table2"]["ladybird"], results),
        *outlier_numbers(name, published, results["outliers"]),
        *(
            number
            for stage, printed in _STAGES.items()
            for number in pose_numbers(f"{name}, Table 3, {printed}", table3[printed], poses.loc[stage])
        ),
        _minimum(f"{name}, notebook", notebook, inliers),
        *pose_numbers(f"{name}, notebook", notebook, inliers),
    ]


def attitude_numbers(name: str, published: Published, results: Results) -> list[Number]:
    """The field platform under the other attitude columns: -log L, the pose, and the same inliers."""
    expected, inliers = published["ladybird_attitude"], results["pose"].set_index("stage").loc["inliers"]
    return [
        _minimum(f"{name}, verified", expected, inliers),
        *pose_numbers(f"{name}, verified", expected, inliers),
        *inlier_numbers(f"{name}, verified", published["section4"]["ladybird_inliers"], results["outliers"]),
    ]


def shrimp_hand_measured_numbers(published: Published) -> list[Number]:
    """Table 3's hand-measured Shrimp row from its Table 1 pose, 0.1 m and 2 deg; no data set is needed for it."""
    table1 = published["table1"]["shrimp"]
    euler_pose = np.concatenate([table1["position_m"], np.deg2rad(table1["euler_deg"])])
    pose = rotation_vector_pose(euler_pose)
    obtained = pd.Series([*pose, *hand_measured_sigma(pose)], [*POSE_COLUMNS, *SIGMA_COLUMNS])
    return pose_numbers("shrimp, Table 3, hand_measured", published["table3"]["shrimp"]["hand_measured"], obtained)


def _minimum(quantity: str, published: Mapping[str, float], obtained: "pd.Series[float]") -> Number:
    column = "neg_log_likelihood"
    return Number(f"{quantity}, {column}", published[column], float(obtained[column]))

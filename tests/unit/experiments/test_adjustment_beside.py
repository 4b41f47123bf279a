"""The adjustment of several sets of observations, and random halves of each."""

import numpy as np
import pandas as pd
import pytest

from linepose.adjustment import AdjustmentSettings
from linepose.estimation.adjustment_estimator import AdjustmentEstimator
from linepose.experiments.adjustment_beside import (
    ADJUSTED_SPLITS,
    ADJUSTMENT,
    adjusted_splits,
    adjustment_table,
)
from linepose.geometry.distance import mahalanobis_between
from linepose.geometry.pose import POSE_COLUMNS, euler_pose
from linepose.survey.hand_measured import HandMeasured
from linepose.tables import read_table, write_table
from unit.adjustment import timed_survey

POSE = timed_survey.POSE


@pytest.fixture(scope="module")
def sets():
    hand = HandMeasured(position_m=tuple(POSE[:3].tolist()), euler_deg=tuple(np.degrees(euler_pose(POSE)[3:]).tolist()))
    settings = AdjustmentSettings(line_period_s=timed_survey.LINE_S, n_draws=20, n_samples=40)
    survey = timed_survey.make_survey(10, 6, seed=4)
    whole = AdjustmentEstimator(survey, timed_survey.CAMERA, hand, settings)
    return {"all": whole, "inliers": whole.select(survey.number[:7].tolist())}


def test_a_row_a_set_with_levels_and_the_error_against_the_truth(sets, tmp_path):
    adjusted = {name: estimator.adjusted(seed=3) for name, estimator in sets.items()}
    table = adjustment_table(sets, adjusted, POSE)
    write_table(table, tmp_path / "adjustment.parquet", ADJUSTMENT)
    table = read_table(tmp_path / "adjustment.parquet", ADJUSTMENT).set_index("set")
    assert table["n_observations"].to_dict() == {"all": 10, "inliers": 7}
    found = adjusted["inliers"]
    assert table.loc["inliers", "drift"] == found.levels.drift
    np.testing.assert_allclose(table.loc["inliers", ["white_low", "white_high"]].tolist(), found.level_intervals[1])
    error = np.linalg.norm(found.pose[:3] - POSE[:3])
    assert table.loc["inliers", "position_error_m"] == pytest.approx(error)
    assert table.loc["all", "position_error_m"] != pytest.approx(error)
    assert np.isnan(adjustment_table({"all": sets["all"]}, adjusted).loc[0, "error_in_sigmas"])


def test_halves_are_disjoint_and_depend_on_their_index_alone(sets, tmp_path):
    together = adjusted_splits(sets, "all", POSE, [0, 1], seed=7)
    alone = adjusted_splits(sets, "all", POSE, [1], seed=7)
    pd.testing.assert_frame_equal(together.iloc[[1]].reset_index(drop=True), alone)
    write_table(together, tmp_path / "splits.parquet", ADJUSTED_SPLITS)
    row = alone.iloc[0]
    first, second = (set(row[f"observations_{k}"].split()) for k in (1, 2))
    assert len(first) == len(second) == 5
    assert not first & second
    halves = [sets["all"].select(sorted(map(int, half))).estimate(POSE) for half in (first, second)]
    np.testing.assert_array_equal(row[[f"{name}_1" for name in POSE_COLUMNS]].to_numpy(dtype=float), halves[0].pose)
    apart = mahalanobis_between(halves[0].pose, halves[0].covariance, halves[1].pose, halves[1].covariance)
    assert row["mahalanobis"] == pytest.approx(apart)

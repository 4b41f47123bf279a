import numpy as np
import pyarrow as pa
import pytest

from linepose.errors import EstimationError
from linepose.estimation.outliers import (
    OUTLIERS,
    accepted_stage,
    outlier_table,
    reject_outliers,
    removal_order,
    stage_observations,
)
from linepose.geometry.pose import POSE_COLUMNS


@pytest.fixture
def with_outliers(gaussian):
    """Observations 3, 6 and 1 measure 30, 18 and 10 of their sigmas off, in directions of their own."""
    directions = np.random.default_rng(7).normal(size=(3, 6))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    factor = np.linalg.cholesky(gaussian.covariance)
    for number, sigmas, direction in zip((3, 6, 1), (30.0, 18.0, 10.0), directions, strict=True):
        gaussian.measured[number - 1] += factor @ (sigmas * direction)
    return gaussian


def removed_by_hand(likelihood, n_removed):
    """The same in closed form: the optimum is the mean, the error the Mahalanobis distance."""
    inverse = np.linalg.inv(likelihood.covariance)
    left, turns = list(range(8)), []
    for _ in range(n_removed + 1):
        off = likelihood.measured[left] - likelihood.measured[left].mean(axis=0)
        error = np.sqrt(np.einsum("ni,ij,nj->n", off, inverse, off))
        turns.append((np.array(left) + 1, error))
        left.pop(int(np.argmax(error)))
    return turns


@pytest.fixture
def stages(with_outliers, true_pose):
    return reject_outliers(with_outliers, true_pose, 4)


def test_stages_are_those_of_the_closed_form(with_outliers, stages):
    for stage, (number, error) in zip(stages, removed_by_hand(with_outliers, 4), strict=True):
        assert stage.number.tolist() == number.tolist()
        assert stage.worst == number[np.argmax(error)]
        # the optimum is good to 0.01 of its own sigma, which is a third of an observation's or less
        np.testing.assert_allclose(stage.error_px, error, atol=0.01)
    assert [stage.worst for stage in stages[:3]] == [3, 6, 1]


def test_removal_goes_on_to_the_minimum_and_tells_of_each_stage(with_outliers, true_pose):
    told = []
    stages = reject_outliers(with_outliers, true_pose, 5, progress=told.append)
    assert told == [len(stage.number) for stage in stages] == [8, 7, 6, 5]


def test_no_fewer_observations_than_asked_for_is_one_stage(with_outliers, true_pose):
    assert len(reject_outliers(with_outliers, true_pose, 8)) == 1
    assert len(reject_outliers(with_outliers, true_pose, 9)) == 1


def test_mean_is_over_the_points_that_an_observation_has(with_outliers, true_pose):
    u_px = with_outliers.survey.u_px
    before = reject_outliers(with_outliers, true_pose, 8)[0]
    u_px[3, 1:] = np.nan
    u_px[5, :] = np.nan
    after = reject_outliers(with_outliers, true_pose, 8)[0]
    np.testing.assert_allclose(np.delete(after.error_px, 5), np.delete(before.error_px, 5), rtol=1e-12)
    assert np.isnan(after.error_px[5])
    assert after.worst == 3


def test_accepted_stage_is_the_first_with_every_mean_below(stages):
    largest = [stage.error_px.max() for stage in stages]
    assert accepted_stage(stages, largest[1] + 1e-9) == 1
    assert accepted_stage(stages, largest[1]) == 2
    assert accepted_stage(stages, largest[0] + 1e-9) == 0


def test_no_accepted_stage_is_told(stages):
    worst = stages[-1].worst
    error_px = stages[-1].error_px.max()
    with pytest.raises(EstimationError) as error:
        accepted_stage(stages, 0.5)
    assert str(error.value) == (
        f"outlier rejection: with 4 observations left, observation {worst} still has a mean error of "
        f"{error_px:.1f} px, expected below 0.5 px; check its labels and the navigation at its time, or raise "
        "outliers.threshold_px in config/config.yaml"
    )


def test_worst_observation_is_told_in_the_callers_words(stages):
    with pytest.raises(EstimationError, match=rf"left, view {stages[-1].worst}\.csv still has"):
        outlier_table(stages, 0.5, "view {}.csv".format)


def test_survey_without_any_error_is_told(function_likelihood):
    likelihood = function_likelihood(lambda p: np.full(len(p), np.inf))
    with pytest.raises(EstimationError) as error:
        reject_outliers(likelihood, np.zeros(6), 3)
    assert str(error.value) == (
        "outlier rejection: none of 8 observations has a reprojection error at the optimum; "
        "check the hand-measured pose and the observations"
    )


def test_table_holds_every_stage_and_fits_its_schema(stages):
    table = outlier_table(stages, 5.0)
    pa.Table.from_pandas(table, schema=OUTLIERS, preserve_index=False)
    assert list(table.columns) == OUTLIERS.names
    assert table.groupby("n_observations").size().to_dict() == {4: 4, 5: 5, 6: 6, 7: 7, 8: 8}
    removed = table[table["removed"]].sort_values("n_observations", ascending=False)
    assert removed["observation"].tolist() == [stage.worst for stage in stages[:-1]]
    second = table[table["n_observations"] == 7]
    np.testing.assert_array_equal(second["error_px"], stages[1].error_px)
    np.testing.assert_array_equal(second[list(POSE_COLUMNS)].iloc[3], stages[1].optimum.parameters)
    assert set(second["neg_log_likelihood"]) == {stages[1].optimum.neg_log_likelihood}
    assert table.loc[table["accepted"], "n_observations"].unique().tolist() == [5]


def test_stages_between_all_and_the_accepted_one_are_named(stages):
    table = outlier_table(stages, 5.0)
    everyone = list(range(1, 9))
    assert stage_observations(table) == {
        "all": everyone,
        "observations_7": [n for n in everyone if n != 3],
        "observations_6": [n for n in everyone if n not in (3, 6)],
        "inliers": [n for n in everyone if n not in (3, 6, 1)],
    }
    assert list(stage_observations(table)) == ["all", "observations_7", "observations_6", "inliers"]


def test_removal_order_ends_at_the_accepted_stage(stages):
    assert removal_order(outlier_table(stages, 5.0)) == [3, 6, 1]


def test_survey_without_outliers_is_all_inliers(gaussian, true_pose):
    table = outlier_table(reject_outliers(gaussian, true_pose, 6), 6.0)
    assert removal_order(table) == []
    assert stage_observations(table) == {"all": list(range(1, 9)), "inliers": list(range(1, 9))}

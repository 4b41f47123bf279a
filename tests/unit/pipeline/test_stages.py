import numpy as np
import pandas as pd
import pyarrow as pa
import pytest

from linepose.estimation.diagnostics import diagnose_samples
from linepose.estimation.optimise import Search, laplace_covariance, optimise
from linepose.estimation.sampling import Chain
from linepose.geometry.pose import POSE_COLUMNS, SIGMA_COLUMNS
from linepose.pipeline.stages import (
    DIAGNOSTICS,
    LAPLACE_SIGMA_COLUMNS,
    OPTIMA,
    POSE,
    SAMPLES,
    diagnostics_table,
    optimise_stages,
    pose_table,
    sample_table,
    samples_from_table,
)

STAGES = {"all": list(range(1, 9)), "observations_7": [1, 2, 3, 4, 5, 7, 8], "inliers": [1, 2, 4, 5, 7]}


def fits(table, schema):
    pa.Table.from_pandas(table, schema=schema, preserve_index=False)
    return list(table.columns) == schema.names


@pytest.fixture
def optima(gaussian, true_pose):
    gaussian.survey.u_px[0, 1] = np.nan
    return optimise_stages(gaussian, STAGES, true_pose, Search())


def test_optima_have_the_schema(optima):
    assert fits(optima, OPTIMA)
    assert optima["stage"].tolist() == list(STAGES)
    assert optima["n_observations"].tolist() == [8, 7, 5]
    assert optima["converged"].all()


def test_each_stage_is_the_optimum_of_its_observations(optima, gaussian, pose_covariance, true_pose):
    for (_, row), numbers in zip(optima.iterrows(), STAGES.values(), strict=True):
        selected = gaussian.select(numbers)
        found = optimise(selected, true_pose)
        np.testing.assert_array_equal(row[list(POSE_COLUMNS)], found.parameters)
        assert (row["neg_log_likelihood"], row["n_evaluations"]) == (found.neg_log_likelihood, found.n_evaluations)
        assert row["start_neg_log_likelihood"] == -selected.log_likelihood(true_pose)
        # n measurements of covariance 8 C each leave 8 C / n
        sigma = row[list(LAPLACE_SIGMA_COLUMNS)].to_numpy(dtype=float)
        np.testing.assert_allclose(sigma, np.sqrt(8 / len(numbers) * np.diag(pose_covariance)), rtol=1e-7)
        np.testing.assert_allclose(sigma**2, np.diag(laplace_covariance(selected, found.parameters)), rtol=1e-12)


def test_reduced_chi_square_counts_the_reprojected_points(optima, gaussian):
    for (_, row), numbers in zip(optima.iterrows(), STAGES.values(), strict=True):
        residuals = gaussian.select(numbers).residuals(row[list(POSE_COLUMNS)].to_numpy(dtype=float))
        n = 4 * len(numbers) - 1  # observation 1 lacks a point
        assert row["degrees_of_freedom"] == n - 6
        expected = np.nansum((residuals.error_px / 2.0) ** 2) / (n - 6)
        assert row["reduced_chi_square"] == pytest.approx(expected, rel=1e-13)


def chain():
    parameters = np.random.default_rng(1).normal(size=(5, 3, 6))
    return Chain(parameters, parameters.sum(axis=2), np.full(3, 0.4))


def test_samples_are_told_by_step_and_walker():
    table = sample_table(chain(), POSE_COLUMNS)
    assert fits(table, SAMPLES)
    assert table[["step", "walker"]].to_numpy().tolist() == [[s, w] for s in range(5) for w in range(3)]
    row = table[(table["step"] == 4) & (table["walker"] == 1)].iloc[0]
    np.testing.assert_array_equal(row[list(POSE_COLUMNS)], chain().parameters[4, 1])
    assert row["log_likelihood"] == chain().log_likelihood[4, 1]


def test_samples_return_from_their_table_in_any_order():
    shuffled = sample_table(chain(), POSE_COLUMNS).sample(frac=1, random_state=3)
    np.testing.assert_array_equal(samples_from_table(shuffled, POSE_COLUMNS), chain().parameters)


def test_diagnostics_stand_beside_the_laplace_sigmas(optima):
    chains = {
        name: diagnose_samples(np.random.default_rng(n).normal(size=(20, 10, 6))) for n, name in enumerate(STAGES)
    }
    table = diagnostics_table(optima, chains)
    assert fits(table, DIAGNOSTICS)
    assert table["stage"].tolist() == [name for name in STAGES for _ in range(6)]
    assert table["parameter"].tolist() == list(POSE_COLUMNS) * 3
    inliers = table[table["stage"] == "inliers"]
    expected = optima.set_index("stage").loc["inliers"]
    np.testing.assert_array_equal(inliers["laplace_sigma"], expected[list(LAPLACE_SIGMA_COLUMNS)])
    np.testing.assert_array_equal(inliers["sampled_sigma"], chains["inliers"].sigma)
    np.testing.assert_array_equal(inliers["split_r_hat"], chains["inliers"].split_r_hat)
    np.testing.assert_array_equal(inliers["autocorrelation_time"], chains["inliers"].autocorrelation_time)
    np.testing.assert_array_equal(inliers["effective_sample_size"], chains["inliers"].effective_sample_size)
    assert set(inliers["n_observations"]) == {5}
    assert set(inliers["warning"]) == {chains["inliers"].warning}
    assert set(inliers["reduced_chi_square"]) == {expected["reduced_chi_square"]}


def test_poses_open_with_the_hand_measured_one(optima, true_pose):
    sigma = {name: np.arange(6) + 10.0 * n for n, name in enumerate(STAGES, start=1)}
    table = pose_table(optima, sigma, true_pose, np.full(6, 0.1))
    assert fits(table, POSE)
    assert table["stage"].tolist() == ["hand_measured", *STAGES]
    hand, *_, inliers = (row for _, row in table.iterrows())
    np.testing.assert_array_equal(hand[list(POSE_COLUMNS)], true_pose)
    np.testing.assert_array_equal(hand[list(SIGMA_COLUMNS)], np.full(6, 0.1))
    by_stage = optima.set_index("stage")
    assert hand["neg_log_likelihood"] == by_stage.loc["inliers", "start_neg_log_likelihood"]
    assert (hand["n_observations"], hand["n_evaluations"]) == (5, 1)
    np.testing.assert_array_equal(inliers[list(POSE_COLUMNS)], by_stage.loc["inliers", list(POSE_COLUMNS)])
    np.testing.assert_array_equal(inliers[list(SIGMA_COLUMNS)], sigma["inliers"])
    pd.testing.assert_series_equal(
        table["n_evaluations"][1:], optima["n_evaluations"], check_index=False, check_names=False
    )

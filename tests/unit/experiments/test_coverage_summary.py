import numpy as np
import pandas as pd
import pytest
from scipy.stats import beta

from linepose.experiments.coverage import ERROR_COLUMNS, ERROR_SIGMA_COLUMNS
from linepose.experiments.coverage_summary import (
    ALL_PLATFORMS,
    COVERAGE_SUMMARY,
    clopper_pearson,
    coverage_curve,
    coverage_summary,
    ratio_interval,
    stated_probabilities,
)
from linepose.tables import write_table


def surveys(credibility, failed=None, regime="white", noise_model="adjustment", platform="p"):
    n = len(credibility)
    failed = np.zeros(n, dtype=bool) if failed is None else np.asarray(failed)
    values = {
        "platform": platform,
        "regime": regime,
        "noise_model": noise_model,
        "survey": np.arange(n),
        "failed": failed,
        "credibility": credibility,
        "heavy_tails": np.arange(n) % 4 == 0,
        "least_eigenvalue": np.where(failed, np.nan, 0.9 - 0.001 * np.arange(n)),
        **{name: np.where(failed, 1e6, 0.3) for name in ERROR_COLUMNS},
        **dict.fromkeys(ERROR_SIGMA_COLUMNS, 0.1),
    }
    return pd.DataFrame(values)


def even(n):
    return (np.arange(n) + 0.5) / n


@pytest.mark.parametrize(("successes", "trials"), [(0, 20), (13, 20), (20, 20), (204, 300)])
def test_binomial_interval_is_that_of_the_beta_quantiles(successes, trials):
    low, high = clopper_pearson(successes, trials)
    assert low == pytest.approx(0 if successes == 0 else beta.ppf(0.025, successes, trials - successes + 1))
    assert high == pytest.approx(1 if successes == trials else beta.ppf(0.975, successes + 1, trials - successes))


def test_binomial_interval_without_trials():
    assert np.all(np.isnan(clopper_pearson(0, 0)))


def test_coverage_is_the_share_below_the_stated_probability():
    table = surveys(even(100))
    summary = coverage_summary(table, {}).iloc[0]
    assert (summary["coverage_68"], summary["coverage_95"]) == (0.68, 0.95)
    curve = coverage_curve(table, stated_probabilities())
    np.testing.assert_allclose(curve["coverage"], curve["nominal"], atol=1e-12)
    assert np.all((curve["coverage_low"] < curve["coverage"]) & (curve["coverage"] < curve["coverage_high"]))
    assert {0.68, 0.95} <= set(curve["nominal"])


def test_errors_are_told_in_metres_and_in_sigmas():
    summary = coverage_summary(surveys(even(8)), {}).iloc[0]
    assert summary["ratio"] == pytest.approx(3.0)
    assert summary["bias_r_x_m"] == pytest.approx(3.0)
    assert summary["rmse_r_x_m"] == pytest.approx(0.3)
    assert summary["rmse_position_m"] == summary["rmse_turn_rad"] == pytest.approx(0.3 * np.sqrt(3))
    assert summary["heavy_tails_share"] == pytest.approx(0.25)
    assert summary["smallest_eigenvalue"] == pytest.approx(0.893)


def test_credibility_that_is_not_uniform_has_a_small_p_value():
    assert coverage_summary(surveys(even(100)), {})["uniform_p_value"][0] > 0.99
    assert coverage_summary(surveys(even(100) ** 2), {})["uniform_p_value"][0] < 1e-3


def test_failed_estimate_is_a_miss_and_no_error():
    summary = coverage_summary(surveys([0.1, 0.1, 1.0, 1.0], [False, False, True, True]), {}).iloc[0]
    assert (summary["coverage_95"], summary["n_failed"], summary["n_surveys"]) == (0.5, 2, 4)
    assert summary["rmse_r_x_m"] == pytest.approx(0.3)


def test_nothing_but_failures(tmp_path):
    table = coverage_summary(surveys([1.0, 1.0], [True, True]), {})
    assert table["coverage_68"][0] == 0
    assert np.isnan(table["rmse_r_x_m"][0])
    write_table(table, tmp_path / "summary.parquet", COVERAGE_SUMMARY)


def test_each_cell_has_a_row_of_its_own():
    both = pd.concat([surveys([0.1, 0.2]), surveys([0.9, 0.99], regime="shared")])
    assert coverage_summary(both, {})["coverage_68"].tolist() == [1.0, 0.0]


def test_pool_is_of_all_platforms_and_of_the_models_that_have_its_regimes(tmp_path):
    parts = [surveys([0.1, 0.2], regime=regime, platform=name) for regime in ("a", "b", "c") for name in ("p", "s")]
    table = pd.concat([*parts, surveys([0.9, 0.9], regime="a", noise_model="published")])
    summary = coverage_summary(table, {"ab": ["a", "b"]})
    pool = summary[summary["platform"] == ALL_PLATFORMS]
    assert pool[["regime", "noise_model", "n_surveys", "coverage_68"]].to_numpy().tolist() == [
        ["ab", "adjustment", 8, 1.0]
    ]
    assert pool["ratio"].item() == pytest.approx(3.0)
    assert np.isnan(pool["rmse_r_x_m"].item())
    write_table(summary, tmp_path / "summary.parquet", COVERAGE_SUMMARY)


def test_ratio_of_right_sigmas_lies_within_its_interval():
    random = np.random.default_rng(5)
    low, high = ratio_interval(50)
    ratios = np.sqrt(np.mean(random.standard_normal((1000, 300)) ** 2, axis=1))
    assert np.mean((ratios > low) & (ratios < high)) == pytest.approx(0.95, abs=4 * np.sqrt(0.95 * 0.05 / 1000))

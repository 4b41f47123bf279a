import numpy as np
import pandas as pd
import pytest
from scipy.stats import beta

from linepose.experiments.coverage import N_RANKED, RANK_COLUMNS, TRUE_COLUMNS
from linepose.experiments.coverage_summary import (
    N_BINS,
    clopper_pearson,
    coverage_curve,
    coverage_summary,
    rank_histogram,
    rank_p_value,
    stated_probabilities,
)
from linepose.geometry.pose import POSE_COLUMNS, SIGMA_COLUMNS


def surveys(credibility, failed=None, regime="white"):
    n = len(credibility)
    failed = np.zeros(n, dtype=bool) if failed is None else np.asarray(failed)
    values = {
        "platform": "p",
        "regime": regime,
        "noise_model": "shared",
        "survey": np.arange(n),
        "failed": failed,
        "credibility": credibility,
        "laplace_credibility": credibility,
        "effective_sample_size": 500.0,
        "pareto_shape": 0.1,
        **dict.fromkeys(TRUE_COLUMNS, 0.0),
        **{name: np.where(failed, 1e6, 0.3) for name in POSE_COLUMNS},
        **dict.fromkeys(SIGMA_COLUMNS, 0.1),
        **{name: np.arange(n) % (N_RANKED + 1) for name in RANK_COLUMNS},
    }
    return pd.DataFrame(values)


@pytest.mark.parametrize(("successes", "trials"), [(0, 20), (13, 20), (20, 20), (204, 300)])
def test_binomial_interval_is_that_of_the_beta_quantiles(successes, trials):
    low, high = clopper_pearson(successes, trials)
    assert low == pytest.approx(0 if successes == 0 else beta.ppf(0.025, successes, trials - successes + 1))
    assert high == pytest.approx(1 if successes == trials else beta.ppf(0.975, successes + 1, trials - successes))


def test_binomial_interval_without_trials():
    assert np.all(np.isnan(clopper_pearson(0, 0)))


def test_coverage_is_the_share_below_the_stated_probability():
    table = surveys((np.arange(100) + 0.5) / 100)
    summary = coverage_summary(table).iloc[0]
    assert (summary["coverage_68"], summary["coverage_95"]) == (0.68, 0.95)
    curve = coverage_curve(table, stated_probabilities())
    np.testing.assert_allclose(curve["coverage"], curve["nominal"], atol=1e-12)
    assert np.all((curve["coverage_low"] < curve["coverage"]) & (curve["coverage"] < curve["coverage_high"]))
    assert {0.68, 0.95} <= set(curve["nominal"])


def test_failed_estimate_is_a_miss_and_no_error():
    summary = coverage_summary(surveys([0.1, 0.1, 1.0, 1.0], [False, False, True, True])).iloc[0]
    assert (summary["coverage_95"], summary["n_failed"], summary["n_surveys"]) == (0.5, 2, 4)
    assert summary["rmse_r_x_m"] == pytest.approx(0.3)
    assert summary["bias_r_x_m"] == pytest.approx(3.0)


def test_nothing_but_failures():
    summary = coverage_summary(surveys([1.0, 1.0], [True, True])).iloc[0]
    assert summary["coverage_68"] == 0
    assert np.isnan(summary["rmse_r_x_m"])


def test_each_cell_has_a_row_of_its_own():
    both = pd.concat([surveys([0.1, 0.2]), surveys([0.9, 0.99], regime="shared")])
    assert coverage_summary(both)["coverage_68"].tolist() == [1.0, 0.0]


def test_even_ranks_fill_all_bins_alike():
    np.testing.assert_array_equal(rank_histogram(pd.Series(np.arange(N_RANKED + 1))), (N_RANKED + 1) // N_BINS)
    assert rank_p_value(pd.Series(np.arange(N_RANKED + 1))) == pytest.approx(1.0)
    assert rank_p_value(pd.Series(np.zeros(100))) < 1e-9
    assert np.isnan(rank_p_value(pd.Series(np.zeros(99))))

"""Subsets by list and by rule, and their estimates against the closed form."""

import numpy as np
import pytest

from linepose.errors import InputError
from linepose.estimation.likelihood_estimator import LikelihoodEstimator
from linepose.estimation.sampling import SamplingSettings
from linepose.experiments.accepted import Accepted
from linepose.experiments.subsets import (
    AngleRule,
    SubsetSettings,
    check_subset,
    chosen_subsets,
    draw_by_rules,
    subset_estimates,
)

SMALL = AngleRule(angle="roll", maximum_deg=1.9, count=2)
LARGE = AngleRule(angle="roll", minimum_deg=3.3, maximum_deg=5.8, count=3)


def test_drawn_observations_obey_their_rules(survey):
    numbers = draw_by_rules(survey, [SMALL, LARGE], seed=1, place="subsets.mixed")
    roll = np.degrees(np.abs(survey.euler_rad[[n - 1 for n in numbers], 0, 0]))
    assert np.sum(roll < 1.9) == 2
    assert np.sum((roll >= 3.3) & (roll < 5.8)) == 3
    assert len(set(numbers)) == 5
    assert list(numbers) == sorted(numbers)


def test_draw_is_a_function_of_the_seed(survey):
    draws = {draw_by_rules(survey, [SMALL, LARGE], seed, "subset") for seed in range(12)}
    assert len(draws) > 1
    assert draw_by_rules(survey, [SMALL, LARGE], 4, "subset") == draw_by_rules(survey, [SMALL, LARGE], 4, "subset")


def test_rules_that_overlap_never_draw_twice(survey):
    wide = AngleRule(angle="roll", count=6)
    assert draw_by_rules(survey, [wide, wide], 1, "subset") == tuple(range(1, 13))


def test_rule_that_selects_too_few_is_named(survey):
    too_many = AngleRule(angle="roll", maximum_deg=1.9, count=9)
    with pytest.raises(InputError, match=r"subsets\.flat: found 4 observations with 0 <= \|roll\| < 1\.9 deg"):
        draw_by_rules(survey, [too_many], 1, "subsets.flat")


@pytest.mark.parametrize(
    ("numbers", "message"),
    [
        ([1, 2, 7], "observation 7, which was rejected"),
        ([1, 99], "observation 99, which does not exist"),
        ([1, 2, 2], "observation 2 twice"),
        ([3], "1 observations"),
    ],
)
def test_subset_that_cannot_be_used_is_named(numbers, message):
    with pytest.raises(InputError, match=rf"^subsets\.high: found {message}"):
        check_subset(numbers, [1, 2, 3, 4], [1, 2, 3, 4, 7], "subsets.high")


def test_accepted_subset_passes():
    check_subset([4, 1], [1, 2, 3, 4], [1, 2, 3, 4, 7], "subsets.high")


@pytest.mark.statistical
@pytest.mark.parametrize("model", ["gaussian", "gaussian_11"])
def test_estimate_is_the_mean_and_its_sigma(model, request):
    """Of n direct measurements: the mean, and sigma / sqrt(n).

    Powell stops at 1e-8 of -log L, so within sqrt(2e-8 * 30) sigmas; a sampled sigma of 40,000 samples with an
    autocorrelation of about 60 steps has a relative sigma of 1 / sqrt(2 * 40000 / 60) = 3 %; four of those.
    """
    likelihood = request.getfixturevalue(model)
    numbers = [2, 5, 7, 11]
    start = likelihood.means[0, :6]
    settings = SamplingSettings(n_walkers=100, n_burn_in=300, n_steps=400, start_sigma_m=0.05)
    table = subset_estimates(LikelihoodEstimator(likelihood, sampling=settings), {"some": numbers}, start, seed=1)
    row = table.iloc[0]
    mean = likelihood.means[[n - 1 for n in numbers]].mean(axis=0)[:6]
    sigma = np.sqrt(np.diag(np.linalg.inv(likelihood.information))[:6] / len(numbers))
    pose = row[[c for c in table if c.startswith(("r_", "theta_"))]].to_numpy(dtype=float)
    sampled = row[[c for c in table if c.startswith("sigma_")]].to_numpy(dtype=float)
    np.testing.assert_allclose((pose - mean) / sigma, 0, atol=2e-3)
    np.testing.assert_allclose(sampled / sigma, 1, atol=0.12)
    assert row["observations"] == "2 5 7 11"
    assert row["neg_log_likelihood"] == pytest.approx(
        -likelihood.select(numbers).log_likelihood(likelihood.means[[n - 1 for n in numbers]].mean(axis=0)), rel=1e-6
    )


@pytest.fixture
def data(gaussian):
    """Observation 7 of twelve was rejected."""
    everything = LikelihoodEstimator(gaussian)
    return Accepted(everything, everything.select([1, 2, 3, 4, 5, 6, 8, 9, 10, 11, 12]))


def test_listed_and_drawn_subsets(data):
    listed = SubsetSettings(observations=[5, 3, 9])
    drawn = SubsetSettings(rules=[AngleRule(angle="roll", count=11)])
    found = chosen_subsets(data, {"listed": listed, "drawn": drawn}, "robot.yaml: subsets")
    assert found["listed"] == (5, 3, 9)
    assert found["drawn"] == (1, 2, 3, 4, 5, 6, 8, 9, 10, 11, 12)


@pytest.mark.parametrize(
    ("section", "told"),
    [
        (SubsetSettings(observations=[1, 7]), "observation 7, which was rejected as an outlier"),
        (SubsetSettings(observations=[1, 13]), "observation 13, which does not exist"),
        (SubsetSettings(rules=[AngleRule(angle="roll", count=12)]), "11 observations with 0 <= |roll| < 180 deg"),
    ],
)
def test_subset_that_cannot_be_used_names_its_key(data, section, told):
    with pytest.raises(InputError) as caught:
        chosen_subsets(data, {"bad": section}, "robot.yaml: subsets")
    assert str(caught.value).startswith(f"robot.yaml: subsets.bad: found {told}")

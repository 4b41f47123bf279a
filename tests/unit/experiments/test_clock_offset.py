"""A planted clock offset is found where passes differ in direction and speed, and owned up to where they do not."""

from dataclasses import replace

import numpy as np
import pytest

from linepose.config.platform import load_platform
from linepose.estimation.adjustment_estimator import AdjustmentEstimator
from linepose.estimation.optimise import laplace_covariance, optimise
from linepose.estimation.sampling import SamplingSettings
from linepose.experiments.clock_offset import (
    CLOCK_OFFSET,
    CORRELATION_COLUMNS,
    PoseWithoutOffset,
    adjusted_clock_offset,
    correlation_with_all,
    estimate_clock_offset,
)
from linepose.experiments.clock_offset_evidence import ClockOffsetEvidence
from linepose.geometry.pose import POSE_COLUMNS
from linepose.tables import read_table, write_table
from unit import clock_survey
from unit.navigation_errors import mixed

PLANTED_S = 0.03
LARGE_S = 0.1  # six sigmas of ten passes
SHORT = SamplingSettings(n_walkers=40, n_burn_in=150, n_steps=150)


@pytest.fixture(scope="module")
def platform(platforms_folder):
    return load_platform(platforms_folder, "ladybird-sim")


def estimated(platform, settings, planted_s, maximum_s):
    """The experiment's row for one simulated survey with a planted offset, and the samples."""
    seed = 1
    survey, log = clock_survey.record(platform.intrinsics(), settings, planted_s, seed)
    model = clock_survey.likelihood(platform.intrinsics(), survey, log, maximum_s)
    plain = optimise(model.inner, platform.start_pose())
    without = PoseWithoutOffset(
        plain.parameters, laplace_covariance(model.inner, plain.parameters), plain.neg_log_likelihood
    )
    table, samples = estimate_clock_offset(model, without, platform.start_pose(), seed, settings=SHORT)
    return table, samples


@pytest.fixture(scope="module")
def both_ways(platform):
    return estimated(platform, clock_survey.both_ways(platform.simulation), LARGE_S, 0.2)


@pytest.fixture(scope="module")
def one_way(platform):
    return estimated(platform, clock_survey.one_way(platform.simulation), PLANTED_S, 0.5)


@pytest.mark.statistical
def test_planted_offset_is_recovered_within_its_sigma(platform):
    """Six surveys: the squared errors in sigmas are chi-square of 6; both tails of one in a thousand."""
    settings, errors = clock_survey.both_ways(platform.simulation), []
    for seed in range(6):
        survey, log = clock_survey.record(platform.intrinsics(), settings, PLANTED_S, seed)
        model = clock_survey.likelihood(platform.intrinsics(), survey, log)
        found = optimise(model, platform.start_pose())
        sigma = np.sqrt(laplace_covariance(model, found.parameters)[-1, -1])
        assert sigma < 0.5 * PLANTED_S  # an offset of zero would be four sigmas off in the mean
        errors.append((found.parameters[-1] - PLANTED_S) / sigma)
    assert 0.38 < np.sum(np.square(errors)) < 22.5
    assert abs(np.mean(errors)) < 3.3 / np.sqrt(6)


@pytest.mark.statistical
def test_the_adjustment_finds_the_offset_without_a_log_where_views_share_their_errors(platform):
    """Nine tenths of the variance common to a view; three surveys, chi-square of 3."""
    settings, errors = clock_survey.both_ways(platform.simulation), []
    reported = settings.reported_sigma
    common = mixed([*reported.position_m, *reported.euler_rad], 0.9)
    for seed in range(3):
        moved = replace(settings, navigation_error=common)
        survey, _ = clock_survey.record(platform.intrinsics(), moved, PLANTED_S, seed)
        estimator = AdjustmentEstimator(survey, platform.intrinsics(), platform.hand_measured)
        plain = estimator.adjusted()
        without = PoseWithoutOffset(plain.pose, plain.covariance, 0.5 * plain.diagnostics.chi_squared)
        table, samples = adjusted_clock_offset(estimator, without, 0.3, 1)
        row = table.iloc[0]
        assert np.std(samples["clock_offset_s"], ddof=1) == pytest.approx(row["sampled_sigma_s"], rel=1e-9)
        errors.append((row["offset_s"] - PLANTED_S) / row["sigma_s"])
    assert 0.024 < np.sum(np.square(errors)) < 16.3


@pytest.mark.statistical
def test_row_holds_the_offset_its_sigma_and_the_pose_with_and_without(both_ways, tmp_path):
    table, samples = both_ways
    write_table(table, tmp_path / "x.parquet", CLOCK_OFFSET)
    row = read_table(tmp_path / "x.parquet", CLOCK_OFFSET).iloc[0]
    assert abs(row["offset_s"] - LARGE_S) < 3.3 * row["sigma_s"]
    assert row["laplace_sigma_s"] == pytest.approx(row["sampled_sigma_s"], rel=0.25)
    assert row["sigma_s"] == max(row["sampled_sigma_s"], row["jackknife_sigma_s"])
    # of ten observations the jackknife's own relative error is about 1 / sqrt(2 x 9), and its tails are long
    assert row["jackknife_sigma_s"] == pytest.approx(row["laplace_sigma_s"], rel=0.7)
    assert row["identifiable"]
    assert row["verdict"].startswith("The camera's clock is behind the navigation's: the offset is ")
    assert f"Add {round(1e6 * row['offset_s'])} us to the camera's time stamps" in row["advice"]
    assert row["neg_log_likelihood"] < row["neg_log_likelihood_without"]
    assert set(samples) == {"walker", "step", *POSE_COLUMNS, "clock_offset_s", "log_likelihood"}
    assert np.std(samples["clock_offset_s"], ddof=1) == pytest.approx(row["sampled_sigma_s"], rel=1e-9)


@pytest.mark.statistical
def test_passes_of_one_direction_and_speed_bring_the_warning(one_way, both_ways):
    row, free = one_way[0].iloc[0], both_ways[0].iloc[0]
    assert not row["identifiable"]
    assert row["shrinkage"] < 0.5
    assert free["identifiable"]
    assert row["correlation_r_x"] > 0.7  # the offset takes it along as far as it is allowed to
    assert row["correlation_r_x"] == max(row[list(CORRELATION_COLUMNS)].abs())
    assert free["correlation_pose"] < 0.9 < row["correlation_pose"]
    assert "cannot be told from the pose" in row["verdict"]
    assert "it goes with the forward lever arm, correlation +0." in row["verdict"]
    assert "passes in the other direction" in row["advice"]
    # in reverse at 0.2 m/s a later pose lies behind, and a lever arm makes up for it
    slope = np.polyfit(one_way[1]["clock_offset_s"], one_way[1]["r_x_m"], 1)[0]
    # some 50 independent samples, the lever arm known to 0.04 m beside an offset spread over 0.25 s: 0.02 m/s
    assert slope == pytest.approx(0.2, abs=0.07)


def told(**changes):
    values = {
        "offset_s": 0.03,
        "sigma_s": 0.004,
        "maximum_s": 0.1,
        "shrinkage": 0.99,
        "correlation_pose": 0.5,
        "correlation": dict.fromkeys(("correlation_r_x", "correlation_r_y", "correlation_r_z"), 0.1)
        | {"correlation_roll": 0.0, "correlation_pitch": -0.4, "correlation_yaw": 0.2},
        "mahalanobis": 1.5,
    }
    return ClockOffsetEvidence(**(values | changes))


def test_words():
    assert told().verdict() == (
        "The camera's clock is behind the navigation's: the offset is 30.0 ± 4.0 ms. With it the pose moves by 1.5 "
        "sigmas."
    )
    assert told().advice() == "Add 30000 us to the camera's time stamps and run again, or mend its clock."
    early = told(offset_s=-0.03)
    assert "clock is ahead of the navigation's" in early.verdict()
    assert early.advice().startswith("Subtract 30000 us from")
    assert told(offset_s=0.003).verdict() == "No clock offset shows: 3.0 ± 4.0 ms is less than 3 sigmas."
    assert told(offset_s=0.003).advice() == ""


@pytest.mark.parametrize("changes", [{"shrinkage": 0.5, "correlation_pose": 0.95}, {"correlation_pose": 0.99}])
def test_words_where_the_pose_hides_it(changes):
    linked = told(**changes)
    assert not linked.is_identifiable()
    assert "cannot be told from the pose: 30.0 ± 4.0 ms" in linked.verdict()
    assert linked.verdict().endswith("it goes with the turn about right, correlation -0.40.")
    assert "add passes in the other direction" in linked.advice()


def test_words_where_the_noise_hides_it():
    noisy = told(shrinkage=0.5)
    assert not noisy.is_identifiable()
    assert noisy.verdict() == "The data do not tell the clock offset: 30.0 ± 4.0 ms, where ±100 ms were allowed."
    assert "Faster passes" in noisy.advice()


def test_words_at_the_end_of_the_range():
    end = told(offset_s=0.099)
    assert not end.is_identifiable()
    assert end.verdict() == "The clock offset is at the end of its range: 99.0 ± 4.0 ms of ±100 ms."
    assert end.advice().startswith("Raise experiments.clock_offset.maximum_s")


def test_correlation_with_the_whole_pose_is_that_of_the_best_combination():
    """Known by regression: a sum of two independent parts of unit size and noise of a half."""
    random = np.random.default_rng(1)
    parts = random.standard_normal((100_000, 2))
    last = parts.sum(axis=1) + 0.5 * random.standard_normal(100_000)
    expected = np.sqrt(2 / 2.25)
    assert correlation_with_all(np.cov(np.column_stack([parts, last]).T)) == pytest.approx(expected, abs=0.005)

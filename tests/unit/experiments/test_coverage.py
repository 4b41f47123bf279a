"""The coverage study's judgement, on a linear-Gaussian estimate of which everything is known."""

import numpy as np
import pandas as pd
import pytest
from scipy.stats import binom

from linepose.config.platform import load_platform
from linepose.experiments.coverage import RANK_COLUMNS, Cell, estimate_row, levels_from_prior
from linepose.experiments.coverage_summary import rank_p_value
from linepose.likelihood.shared import SharedPriors
from linepose.simulation.noise_levels import NoiseLevels

SIGMA = np.array([0.03, 0.05, 0.06, 0.016, 0.018, 0.009])
N = 400


def estimates(function_likelihood, claimed):
    """Rows of N conjugate estimates: truth at zero, data of sigma SIGMA, a likelihood that claims so many times it."""
    random, rows = np.random.default_rng(11), []
    for _ in range(N):
        data = SIGMA * random.standard_normal(6)
        likelihood = function_likelihood(
            lambda p, data=data: 0.5 * np.sum(((p - data) / (claimed * SIGMA)) ** 2, axis=1)
        )
        rows.append(estimate_row(likelihood, np.zeros(6), np.zeros(6), random, 300))
    return pd.DataFrame(rows)


@pytest.mark.statistical
def test_honest_sigmas_cover_as_stated_and_ranks_are_uniform(function_likelihood):
    honest = estimates(function_likelihood, 1.0)
    assert not honest["failed"].any()
    for nominal in (0.5, 0.68, 0.95):
        low, high = binom.interval(0.999, N, nominal)
        for column in ("credibility", "laplace_credibility"):
            # 300 draws are worth about 200: a credibility is off by 0.035, which moves the share by 0.002 at most
            assert low - 0.002 * N <= (honest[column] < nominal).sum() <= high + 0.002 * N
    for column in RANK_COLUMNS:
        assert rank_p_value(honest[column]) > 1e-3


@pytest.mark.statistical
def test_sigmas_of_half_the_size_are_found_out(function_likelihood):
    rows = estimates(function_likelihood, 0.5)
    # chi-square with 6 degrees of freedom: four times the distance squared is below the 68 % point in 6 % of cases
    assert (rows["credibility"] < 0.68).mean() < 0.15
    assert rank_p_value(rows[RANK_COLUMNS[0]]) < 1e-6


def test_open_direction_is_a_failed_estimate_that_holds_nothing(function_likelihood):
    likelihood = function_likelihood(lambda p: 0.5 * np.sum((p[:, 1:] / SIGMA[1:]) ** 2, axis=1))
    row = estimate_row(likelihood, np.zeros(6), np.zeros(6), np.random.default_rng(1), 100)
    assert row["failed"]
    assert (row["credibility"], row["laplace_credibility"]) == (1.0, 1.0)
    assert np.isnan(row["rank_r_x_m"])


def test_same_number_is_the_same_survey_for_every_noise_model(platforms_folder):
    platform = load_platform(platforms_folder, "ladybird-sim")

    def cell(model, regime="white"):
        simulation, camera = platform.simulation, platform.intrinsics()
        return Cell("p", regime, model, camera, simulation, platform.start_pose(), NoiseLevels(white_level=1.0), 7)

    first, second = (cell(model).survey(4)[0] for model in ("published", "balanced"))
    np.testing.assert_array_equal(first.position_m, second.position_m)
    assert not np.array_equal(first.position_m, cell("published").survey(5)[0].position_m)
    assert not np.array_equal(first.position_m, cell("published", "shared").survey(4)[0].position_m)


@pytest.mark.statistical
def test_levels_are_the_priors():
    random, priors = np.random.default_rng(1), SharedPriors()
    levels = [levels_from_prior(random, priors) for _ in range(500)]
    logs = np.log([[one.shared_level, one.white_level, one.pixel_level] for one in levels])
    np.testing.assert_allclose(logs.mean(axis=0), np.log(0.5), atol=4 * 1.5 / np.sqrt(500))
    np.testing.assert_allclose(logs.std(axis=0), 1.5, atol=4 * 1.5 / np.sqrt(1000))

"""Weights of draws."""

import numpy as np
import pytest
from scipy.stats import norm, t

from linepose.adjustment.importance import smoothed_weights
from linepose.adjustment.thresholds import TRUSTED_SHAPE


def log_ratios(proposal, count=1000):
    draws = proposal.rvs(size=count, random_state=np.random.default_rng(4))
    return draws, norm.logpdf(draws) - proposal.logpdf(draws)


def test_weighted_draws_have_the_moments_of_the_target():
    draws, ratios = log_ratios(t(5, scale=1.3))
    weight, shape = smoothed_weights(ratios)
    assert weight.sum() == pytest.approx(1)
    assert shape < TRUSTED_SHAPE
    assert weight @ draws == pytest.approx(0, abs=0.15)
    assert weight @ draws**2 == pytest.approx(1, abs=0.2)


def test_a_proposal_that_is_far_too_narrow_is_told():
    _, ratios = log_ratios(norm(scale=0.3))
    assert smoothed_weights(ratios)[1] > TRUSTED_SHAPE


def test_draws_that_are_too_few_or_all_alike_keep_their_weights():
    weight, shape = smoothed_weights(np.array([0.0, 1.0, 0.5]))
    assert weight == pytest.approx(np.exp([0.0, 1.0, 0.5]) / np.exp([0.0, 1.0, 0.5]).sum())
    assert shape == np.inf
    assert smoothed_weights(np.zeros(50))[0] == pytest.approx(np.full(50, 0.02))

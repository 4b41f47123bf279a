"""Gross errors: their bound against the mixture's own likelihood, what is found of drawn ones, a flight half wrong."""

import numpy as np
import pytest
from scipy.special import logsumexp

from linepose.adjustment import AdjustmentSettings, adjust
from linepose.adjustment.gross_errors import (
    GrossErrors,
    bound_of_gross_errors,
    expected_gross_errors,
    first_gross_errors,
)
from linepose.simulation.flight import FlightSettings, simulate_flight


def drawn_squares(n, share, factor, seed):
    random = np.random.default_rng(seed)
    bad = random.random(n) < share
    return np.sum(random.standard_normal((n, 2)) ** 2, axis=1) * np.where(bad, factor**2, 1.0), bad


def test_the_bound_is_the_likelihood_of_the_mixture():
    squares, _ = drawn_squares(50, 0.3, 6.0, seed=1)
    share, factor = 0.2, 5.0
    good = expected_gross_errors(squares, GrossErrors(np.ones(50), share, factor)).good
    gross = GrossErrors(good, share, factor)
    bound = bound_of_gross_errors(gross) + np.sum(np.log(gross.weight) - 0.5 * gross.weight * squares)
    of_kinds = [
        np.log(1 - share) - 0.5 * squares,
        np.log(share) - 2 * np.log(factor) - 0.5 * squares / factor**2,
    ]
    assert bound == pytest.approx(np.sum(logsumexp(of_kinds, axis=0)), rel=1e-12)


def test_share_and_factor_of_drawn_errors():
    n, share, factor = 4000, 0.4, 20.0
    squares, bad = drawn_squares(n, share, factor, seed=2)
    found = first_gross_errors(n, 0.1, 5.0)
    for _ in range(50):
        found = expected_gross_errors(squares, found)
    assert found.share == pytest.approx(share, abs=4 * np.sqrt(share * (1 - share) / n))
    # log k of 1,600 pairs has the sigma 1 / sqrt(4 x 1,600)
    assert np.log(found.factor) == pytest.approx(np.log(factor), abs=4 / np.sqrt(4 * share * n))
    # of pairs twenty times as large 1 - exp(-s / 2 / 400) lie within s = 14, where both kinds are as likely
    assert np.mean((found.good < 0.5) == bad) > 0.98


def test_a_flight_of_which_half_of_the_points_are_wrong_is_nearly_as_good_as_without():
    clean, half_wrong = (simulate_flight(FlightSettings(n_points=40, wrong_share=share), 11) for share in (0.0, 0.5))
    settings = AdjustmentSettings(line_period_s=clean.line_period_s, n_draws=20, n_samples=10)
    without, found = (
        adjust(one.survey, one.camera, one.hand_pose, one.hand_covariance, settings) for one in (clean, half_wrong)
    )
    assert np.all(found.sigma[3:] < 1.4 * without.sigma[3:])
    assert np.all(np.abs(found.pose - half_wrong.pose) < 3 * found.sigma)
    of_wrong = np.nanmin(found.measurement_weight[:, half_wrong.wrong], axis=0)
    assert np.mean(of_wrong < 0.25) > 0.9
    of_right = found.measurement_weight[:, ~half_wrong.wrong]
    assert np.mean(of_right[np.isfinite(of_right)] > 0.25) > 0.95

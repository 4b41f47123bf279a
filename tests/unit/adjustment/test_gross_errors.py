"""Gross errors: their bound against the mixture's own likelihood, what is found of drawn ones, a flight half wrong."""

from dataclasses import replace

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
from linepose.adjustment.thresholds import DOUBTFUL_WEIGHT
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
    found = first_gross_errors(n)
    for _ in range(50):
        found = expected_gross_errors(squares, found)
    assert found.share == pytest.approx(share, abs=4 * np.sqrt(share * (1 - share) / n))
    # log k of 1,600 pairs has the sigma 1 / sqrt(4 x 1,600)
    assert np.log(found.factor) == pytest.approx(np.log(factor), abs=4 / np.sqrt(4 * share * n))
    # of pairs twenty times as large 1 - exp(-s / 2 / 400) lie within s = 14, where both kinds are as likely
    assert np.mean((found.good < 0.5) == bad) > 0.98


@pytest.mark.parametrize(("wrong_share", "seed"), [(0.5, 11), (0.65, 1), (0.8, 1)])
def test_a_flight_with_wrong_matches_is_as_good_as_one_without_these_measurements(wrong_share, seed):
    """The same flight, once with wrong matches, once with these measurements removed.

    Which of two rays of a point is wrong cannot be told, so that sigmas are larger by what such points were worth.
    """
    right, wrong = (simulate_flight(FlightSettings(n_points=40, wrong_share=share), seed) for share in (0, wrong_share))
    bad = np.abs(wrong.survey.u_px - right.survey.u_px) > 0
    removed = replace(wrong.survey, u_px=np.where(bad, np.nan, wrong.survey.u_px))
    settings = AdjustmentSettings(line_period_s=right.line_period_s, n_draws=20, n_samples=10)
    found, expected = (
        adjust(survey, wrong.camera, wrong.hand_pose, wrong.hand_covariance, settings)
        for survey in (wrong.survey, removed)
    )
    assert np.all(found.sigma[3:] < 1.5 * expected.sigma[3:])
    assert np.all(np.abs(found.pose - expected.pose) < 2 * expected.sigma)
    light = found.measurement_weight < DOUBTFUL_WEIGHT
    far_off = np.abs(wrong.survey.u_px - right.survey.u_px) > 10 * wrong.camera.sigmas.u_px
    n_right = np.sum(~bad & np.isfinite(wrong.survey.u_px), axis=0)
    assert np.all(light[far_off & (n_right >= 3)])
    assert np.mean(light[np.isfinite(found.measurement_weight) & ~bad & (n_right >= 3)]) < 0.1

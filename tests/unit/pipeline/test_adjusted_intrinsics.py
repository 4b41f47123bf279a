"""How far the intrinsics of an adjustment lie from the platform's file, in sigmas of how far they may move."""

import numpy as np
import pytest

from linepose.pipeline.adjusted_intrinsics import AdjustedIntrinsics


def found(prior_sigma, survey_sigma, survey_value):
    """What one measurement of each, of a known sigma, makes of a prior about 0: a linear problem in closed form."""
    prior, survey, value = (np.array(one, dtype=float) for one in (prior_sigma, survey_sigma, survey_value))
    weight = prior**2 / (prior**2 + survey**2)
    covariance = np.diag((1 - weight) * prior**2)
    names = ("principal_point_px", "focal_length_m")
    return AdjustedIntrinsics(names, weight * value, covariance, np.zeros((6, 2)), np.zeros(2), prior)


def test_the_move_is_counted_in_sigmas_of_survey_and_prior_together():
    values = np.array([2.5, -4.0]) * np.hypot([2.0, 1e-4], [1.0, 3e-4])
    np.testing.assert_allclose(found([2.0, 1e-4], [1.0, 3e-4], values).moved_sigmas, [2.5, -4.0], rtol=1e-9)


def test_what_the_survey_says_next_to_nothing_of_has_not_moved():
    assert found([2.0, 1e-4], [1.0, 1e-3], [1.0, 1e-2]).moved_sigmas[1] == 0.0  # one per cent of the variance
    assert found([2.0, 1e-4], [1.0, 5e-4], [1.0, 1e-2]).moved_sigmas[1] == pytest.approx(19.6, abs=0.1)

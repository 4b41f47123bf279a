"""How far the intrinsics of an adjustment lie from the platform's file, in sigmas of survey and file together."""

import importlib

import numpy as np
import pytest

from linepose.adjustment import AdjustmentSettings, adjust
from linepose.pipeline.adjusted_intrinsics import AdjustedIntrinsics, farthest
from linepose.pipeline.adjusted_tables import adjusted_intrinsics
from unit.adjustment import timed_survey

NAMES = ("principal_point_px", "focal_length_m")
PRIOR = np.array([320.0, 8e-3])


def found(prior_sigma, survey_sigma, survey_off):
    """What one measurement of each, of a known sigma, so far off, makes of a prior: a linear problem in closed form."""
    prior, survey, off = (np.array(one, dtype=float) for one in (prior_sigma, survey_sigma, survey_off))
    weight = prior**2 / (prior**2 + survey**2)
    covariance = np.diag((1 - weight) * prior**2)
    return AdjustedIntrinsics(NAMES, PRIOR + weight * off, covariance, np.zeros((6, 2)), PRIOR, prior)


def test_the_move_is_counted_in_sigmas_of_survey_and_prior_together():
    off = np.array([2.5, -4.0]) * np.hypot([2.0, 1e-4], [1.0, 3e-4])
    one = found([2.0, 1e-4], [1.0, 3e-4], off)
    np.testing.assert_allclose(one.moved_sigmas, [2.5, -4.0], rtol=1e-9)
    np.testing.assert_allclose(one.survey_sigma, [1.0, 3e-4], rtol=1e-9)
    assert farthest(one) == ("focal_length_m", pytest.approx(4.0))


@pytest.mark.parametrize("stated_m", [1e-4, 1e-5, 1e-6, 1e-8])
def test_a_data_sheet_that_is_too_sure_of_itself_is_contradicted(stated_m):
    """A focal length 10 % off, that the survey knows to 1.25 %: 8 sigmas of the survey, whatever is stated."""
    off_m, survey_m = 8e-4, 1e-4
    one = found([2.0, stated_m], [1.0, survey_m], [0.0, off_m])
    assert one.is_tested.all()
    assert farthest(one) == ("focal_length_m", pytest.approx(off_m / np.hypot(stated_m, survey_m), rel=1e-3))


@pytest.mark.parametrize("most_points", [150, 11])  # of normal equations that are formed as a matrix
def test_an_adjustment_is_contradicted_alike_by_ever_smaller_sigmas(monkeypatch, most_points):
    monkeypatch.setattr(importlib.import_module("linepose.adjustment.adjust"), "MANY_POINTS", most_points)
    survey, camera = timed_survey.make_survey(10, 12, seed=41), timed_survey.CAMERA
    settings = AdjustmentSettings(line_period_s=timed_survey.LINE_S, n_draws=10, n_samples=10, tails=False)
    moved = []
    for stated_m in (1e-6, 1e-7):
        sigmas = camera.sigmas.replaced(focal_length_m=stated_m)
        given = camera.replaced(focal_length_m=1.05 * camera.focal_length_m, sigmas=sigmas)
        one = adjusted_intrinsics(adjust(survey, given, timed_survey.POSE, settings=settings), given)
        assert one.is_tested[1]
        moved.append(one.moved_sigmas[1])
    assert moved[0] < -4
    assert moved[1] == pytest.approx(moved[0], rel=0.01)  # the search ends within 1e-3 of a sigma


def test_what_the_survey_says_next_to_nothing_of_is_not_tested():
    """Three sigmas of the survey would be more than half of the focal length, or 500 px; the rest is rounding."""
    hardly = found([2.0, 1e-4], [170.0, 1.4e-3], [600.0, 9e-3])
    assert np.all(np.abs(hardly.moved_sigmas) > 3)
    assert farthest(hardly) == ("", None)
    assert farthest(found([2.0, 1e-4], [160.0, 1.4e-3], [0.0, 9e-3])) == ("principal_point_px", pytest.approx(0.0))
    assert not np.any(hardly.is_held)
    nothing = found([2.0, 1e-4], [1e12, 1e9], [0.0, 0.0])
    assert farthest(nothing) == ("", None)
    assert not np.any(nothing.is_held)


def test_of_a_wide_prior_what_the_survey_narrows_is_tested():
    wide = found([400.0, 1e-2], [600.0, 2e-2], [0.0, 0.1])
    assert farthest(wide) == ("focal_length_m", pytest.approx(0.1 / np.hypot(1e-2, 2e-2)))


def test_a_prior_so_tight_that_nothing_can_be_computed_is_held():
    one = found([2.0, 1e-12], [1.0, 1e-4], [0.0, 8e-4])
    assert one.is_held.tolist() == [False, True]
    assert farthest(one)[0] == "principal_point_px"


def test_sigmas_that_are_not_known_are_no_agreement():
    one = found([2.0, 1e-4], [1.0, 1e-4], [0.0, 0.0])
    unknown = AdjustedIntrinsics(
        NAMES, one.estimate, np.diag([1.0, np.nan]), one.pose_by_intrinsics, PRIOR, one.prior_sigma
    )
    name, sigmas = farthest(unknown)
    assert name == "focal_length_m"
    assert np.isnan(sigmas)

"""Odd input to the adjustment is defined, or told in one line that can be followed."""

from dataclasses import replace

import numpy as np
import pytest

from linepose.adjustment import AdjustmentSettings, KnownPoints, LevelPriors, adjust
from linepose.adjustment.many_points import FEW_POINTS, some_points
from linepose.adjustment.measurements import measurements_from_survey
from linepose.errors import InputError
from unit.adjustment import timed_survey

CAMERA = timed_survey.CAMERA


@pytest.fixture(scope="module")
def survey():
    return timed_survey.make_survey(6, 5, seed=3)


def test_sigma_across_the_line_is_checked(survey):
    nameless = CAMERA.model_copy(update={"sigmas": CAMERA.sigmas.model_copy(update={"v_px": float("nan")})})
    with pytest.raises(InputError, match=r"camera\.sigmas\.v_px: found nan"):
        adjust(survey, nameless, timed_survey.POSE)


def test_a_camera_without_rays_is_named(survey):
    with pytest.raises(InputError, match="camera: found intrinsic parameters whose rays are no numbers"):
        adjust(survey, CAMERA.replaced(principal_point_px=1e300), timed_survey.POSE)


@pytest.mark.parametrize(
    "settings",
    [
        {"start": [0.0, *AdjustmentSettings().start[1:]]},
        {"start": [1e300, *AdjustmentSettings().start[1:]]},
        {"n_draws": 10**9},
        {"n_samples": 1},
        {"line_period_s": 100.0},
    ],
)
def test_settings_out_of_range_are_refused(settings):
    with pytest.raises(InputError, match=next(iter(settings))):
        AdjustmentSettings(**settings)


@pytest.mark.parametrize(("name", "value"), [("median", 0.0), ("median", -1.0), ("log_sigma", 0.0), ("log_sigma", 1e6)])
def test_priors_that_no_level_has_are_refused(name, value):
    with pytest.raises(InputError, match=f"{name}.*expected 7 numbers from"):
        LevelPriors(**{name: [value] * 7})


@pytest.mark.parametrize(
    ("position", "information", "told"),
    [
        (np.full((5, 3), np.nan), np.tile(np.eye(3), (5, 1, 1)), "known points, point 0"),
        (np.zeros((5, 3)), np.tile(-np.eye(3), (5, 1, 1)), "known points, point 0"),
        (np.zeros((5, 3)), np.full((5, 3, 3), np.inf), "known points, point 0"),
        (np.zeros((5, 3)), np.tile(np.eye(3) + np.eye(3, k=1), (5, 1, 1)), "known points, point 0"),
        (np.zeros((4, 3)), np.zeros((4, 3, 3)), "known points: found shapes"),
    ],
)
def test_knowledge_of_points_that_is_none_is_named(survey, position, information, told):
    with pytest.raises(InputError, match=told):
        measurements_from_survey(survey, CAMERA, KnownPoints(position, information))


def test_the_position_of_a_point_that_is_not_known_need_not_be_a_number(survey):
    known = KnownPoints(np.full((5, 3), np.nan), np.zeros((5, 3, 3)))
    assert np.all(measurements_from_survey(survey, CAMERA, known).known.position_m == 0)


def test_known_points_are_among_those_that_tell_the_levels_of_many():
    survey = timed_survey.make_survey(4, 100, seed=3)
    information = np.zeros((100, 3, 3))
    information[[3, 50, 97]] = np.eye(3)
    chosen = some_points(survey, 0, KnownPoints(np.zeros((100, 3)), information).apart)
    seen = np.isfinite(chosen.u_px).any(axis=0)
    assert seen[[3, 50, 97]].all()
    assert FEW_POINTS <= seen.sum() <= FEW_POINTS + 3


def test_views_in_any_order_are_laid_out_by_time(survey):
    """Times that run back along the points of a view, and views that stand in another order."""
    mixed = survey.select([4, 1, 6, 2, 5, 3])
    one, other = measurements_from_survey(survey, CAMERA), measurements_from_survey(mixed, CAMERA)
    np.testing.assert_array_equal(one.number, other.number)
    np.testing.assert_array_equal(one.u_px, other.u_px)
    np.testing.assert_allclose(one.rate, other.rate)
    assert np.all(one.structure.gap_s >= 0)


def test_clocks_that_begin_anew_in_every_view_are_told_to_be_one(survey):
    time = survey.time_us - survey.time_us.min(axis=1, keepdims=True)
    with pytest.raises(InputError, match="those of all views are of one clock"):
        measurements_from_survey(replace(survey, time_us=time), CAMERA)

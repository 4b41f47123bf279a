"""What the errors of a view that is far off are called, of surveys into which one fault was put."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import binom, multivariate_t

from linepose.adjustment import AdjustmentSettings, adjust
from linepose.adjustment.faults import view_faults
from linepose.adjustment.lost_weight import SHARE_OF_TAILS, most_lost_by_tails
from linepose.adjustment.reprojection import reprojection
from linepose.adjustment.thresholds import CLOCK, DOUBTFUL_WEIGHT, JUMP, LABEL, UNCLEAR
from unit.adjustment import timed_survey

QUICK = AdjustmentSettings(line_period_s=timed_survey.LINE_S, n_draws=20, n_samples=50)
VIEW = 5


@pytest.fixture(scope="module")
def survey():
    return timed_survey.make_survey(12, 8, seed=31)


def faults(survey):
    found = adjust(survey, timed_survey.CAMERA, timed_survey.POSE, settings=QUICK)
    return view_faults(found, reprojection(survey, timed_survey.CAMERA, found, timed_survey.LINE_S))


def test_a_faultless_survey_has_none(survey):
    assert faults(survey) == [""] * 12


def test_a_view_that_is_late_by_one_time_is_a_clocks(survey):
    """Body poses of 1.5 s later, on the path of the view: 0.3 m."""
    position = survey.position_m.copy()
    seconds = 1e-6 * (survey.time_us[VIEW] - survey.time_us[VIEW].mean())
    rate = np.polyfit(seconds, position[VIEW], 1)[0]
    position[VIEW] += 1.5 * rate
    words = faults(replace(survey, position_m=position))
    assert words[VIEW] == CLOCK
    assert words.count("") == 11


def test_a_view_with_some_wrong_points_is_the_labels(survey):
    u_px = survey.u_px.copy()
    for view, point in [(1, 2), (VIEW, 6), (7, 0), (10, 5), (2, 7)]:
        u_px[view, point] += 60.0
    words = faults(replace(survey, u_px=u_px))
    assert words[VIEW] == LABEL
    assert {view for view, word in enumerate(words) if word} == {1, 2, VIEW, 7, 10}


def test_a_view_in_the_middle_of_which_the_navigation_jumps(survey):
    position = survey.position_m.copy()
    late = np.argsort(survey.time_us[VIEW])[4:]
    position[VIEW, late] += [0.4, -0.3, 0.1]
    words = faults(replace(survey, position_m=position))
    assert words[VIEW] == JUMP


def test_words_go_by_the_weight(survey):
    found = adjust(survey, timed_survey.CAMERA, timed_survey.POSE, settings=QUICK)
    errors = reprojection(survey, timed_survey.CAMERA, found, timed_survey.LINE_S)
    light = np.ones(12)
    light[3] = 0.99 * DOUBTFUL_WEIGHT
    assert [view for view, word in enumerate(view_faults(replace(found, view_weight=light), errors)) if word] == [3]


def test_what_two_measurements_cannot_tell_is_unclear(survey):
    u_px = survey.u_px.copy()
    u_px[3, 2:] = np.nan
    thin = replace(survey, u_px=u_px)
    found = adjust(thin, timed_survey.CAMERA, timed_survey.POSE, settings=QUICK)
    errors = reprojection(thin, timed_survey.CAMERA, found, timed_survey.LINE_S)
    light = np.ones(12)
    light[3] = 0.99 * DOUBTFUL_WEIGHT
    assert view_faults(replace(found, view_weight=light), errors)[3] == UNCLEAR


def test_the_share_that_tails_let_expect_is_that_of_drawn_errors():
    """Four sigmas of a binomial count of 40,000 errors."""
    squares = np.sum(multivariate_t(np.zeros(2), np.eye(2), df=4).rvs(40_000, random_state=4) ** 2, axis=1)
    share = np.mean(6 / (4 + squares) < DOUBTFUL_WEIGHT)
    assert share == pytest.approx(SHARE_OF_TAILS, abs=4 * np.sqrt(SHARE_OF_TAILS / 40_000))
    for count in (150, 6000):
        assert most_lost_by_tails(count) == binom.ppf(0.999, count, SHARE_OF_TAILS)


def strips(survey, lost):
    """Words of views with 20 times the points, of which the first `lost` of each (12,) have no weight."""
    found = adjust(survey, timed_survey.CAMERA, timed_survey.POSE, settings=QUICK)
    errors = reprojection(survey, timed_survey.CAMERA, found, timed_survey.LINE_S)
    weight = np.tile(found.measurement_weight, 20)
    for view, count in enumerate(lost):
        weight[view, :count] = 0.01
    wide = replace(
        errors,
        error_px=np.tile(errors.error_px, 20),
        error_uv_px=np.tile(errors.error_uv_px, (1, 20, 1)),
    )
    return view_faults(replace(found, measurement_weight=weight), wide)


def test_some_bad_matches_of_a_strip_are_no_fault_and_half_of_it_are(survey):
    words = strips(survey, [1, 4, 12, 80, *[1] * 8])
    assert words == ["", "", "", LABEL, *[""] * 8]
    assert most_lost_by_tails(160) < 80

"""Heavy tails: gross errors lose their weight, and faultless surveys lose nothing."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.stats import gamma

from linepose.adjustment import AdjustmentSettings, adjust
from linepose.adjustment.tails import _bound
from linepose.adjustment.thresholds import DEGREES_OF_FREEDOM
from unit.adjustment import timed_survey

CAMERA = timed_survey.CAMERA
QUICK = AdjustmentSettings(line_period_s=timed_survey.LINE_S, n_draws=60, n_samples=200)


@pytest.fixture(scope="module")
def survey():
    return timed_survey.make_survey(12, 8, seed=31)


@pytest.fixture(scope="module")
def clean(survey):
    return adjust(survey, CAMERA, timed_survey.POSE, settings=QUICK)


def test_the_bound_by_numerical_integration():
    weight, dimension = 0.3, 6
    alpha = (DEGREES_OF_FREEDOM + dimension) / 2
    q = gamma(alpha, scale=weight / alpha)
    p = gamma(DEGREES_OF_FREEDOM / 2, scale=2 / DEGREES_OF_FREEDOM)

    def integrand(w):
        gain = 0.5 * dimension * (np.log(w) - np.log(weight))
        return q.pdf(w) * (gain + p.logpdf(w) - q.logpdf(w))

    assert _bound(np.array([weight]), np.array([float(dimension)])) == pytest.approx(
        quad(integrand, 1e-9, 5)[0], abs=1e-6
    )


def test_a_faultless_survey_keeps_the_normal_model(survey, clean):
    assert not clean.diagnostics.heavy_tails
    assert np.all(clean.view_weight == 1)
    without = adjust(survey, CAMERA, timed_survey.POSE, settings=QUICK.replaced(tails=False))
    assert np.array_equal(without.covariance, clean.covariance)


def test_views_that_jump_lose_their_weight(survey, clean):
    position = survey.position_m.copy()
    position[3, 4:] += [0.4, -0.3, 0.1]
    position[8, :4] += [-0.3, 0.3, -0.2]
    found = adjust(replace(survey, position_m=position), CAMERA, timed_survey.POSE, settings=QUICK)
    assert found.diagnostics.heavy_tails
    view = np.nanmean(found.measurement_weight, axis=1)
    assert set(np.argsort(view)[:2]) == {3, 8}
    assert np.all(np.abs(found.pose - clean.pose) < 3 * clean.sigma)


def test_a_clock_that_is_off_takes_the_weight_of_a_views_constant(survey, clean):
    position = survey.position_m.copy()
    position[5] += [0.5, 0.3, 0.0]
    found = adjust(replace(survey, position_m=position), CAMERA, timed_survey.POSE, settings=QUICK)
    assert found.diagnostics.heavy_tails
    assert np.argmin(found.view_weight) == 5
    assert np.all(np.abs(found.pose - clean.pose) < 3 * clean.sigma)


def test_one_view_off_by_a_few_sigmas_moves_the_pose_little(survey, clean):
    """A displacement of a view by ten sigmas, which levels alone could take for a larger constant of all views."""
    position = survey.position_m.copy()
    position[5] += 0.15 * np.array([1.0, 0.6, 0.0])
    found = adjust(replace(survey, position_m=position), CAMERA, timed_survey.POSE, settings=QUICK)
    assert np.argmin(found.view_weight) == 5
    assert found.view_weight[5] < 0.2
    # such tails are of constants only: all noise keeps its weight
    assert np.nanmin(found.measurement_weight) == 1
    assert np.all(np.abs(found.pose - clean.pose) < 1.5 * clean.sigma)


def test_wrong_labels_lose_their_weight_alone(survey, clean):
    u_px = survey.u_px.copy()
    wrong = [(1, 2), (4, 6), (7, 0), (10, 5), (2, 7)]
    for view, point in wrong:
        u_px[view, point] += 60.0
    found = adjust(replace(survey, u_px=u_px), CAMERA, timed_survey.POSE, settings=QUICK)
    assert found.diagnostics.heavy_tails
    order = np.argsort(found.measurement_weight, axis=None)[: len(wrong)]
    assert {tuple(map(int, np.unravel_index(k, u_px.shape))) for k in order} == set(wrong)
    assert np.all(np.abs(found.pose - clean.pose) < 3 * clean.sigma)

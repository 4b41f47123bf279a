"""Derivatives of the levels' density by complex step through dense matrices, and by differences of the pass itself."""

import numpy as np
import pytest

from linepose.adjustment.gradient import slopes_of_density
from linepose.adjustment.levels import LevelPriors, Levels, log_from_levels
from linepose.adjustment.process import Weights
from linepose.adjustment.reml import Restricted, most_likely
from unit.adjustment import dense, timed_survey
from unit.adjustment.test_against_dense import CAMERA, LEVELS, Case

STEP = 1e-20


@pytest.fixture(scope="module")
def case():
    return Case(LEVELS)


@pytest.fixture(scope="module")
def slopes(case):
    return slopes_of_density(
        case.measurements.structure, case.model.image, case.process, case.levels, case.weights, case.done
    )


def density(case, levels, view_weight, line_weight):
    """`chi^2 + log|C| + log|N|` with dense matrices; complex where an argument is."""
    m = case.measurements
    survey = timed_survey.without(timed_survey.make_survey(5, 6, seed=3), (0, 1), (3, 2), (4, 5))
    time_s = survey.time_us[m.row, m.column] * 1e-6
    n = len(m.u_px)
    roots = [dense.symmetric_root(c) for c in survey.covariance[m.row, m.column]]
    scale = np.diag(np.array([1, 1, 1, *[levels.attitude] * 3]))
    factors = [case.image[2 * i : 2 * i + 2, 6 * i : 6 * i + 6] @ scale @ roots[i] for i in range(n)]
    covariance = np.zeros((2 * n, 2 * n), dtype=complex)
    for i in range(n):
        for j in range(n):
            unit = levels.drift**2 * np.exp(-abs(time_s[i] - time_s[j]) / levels.correlation_time_s)
            unit = unit + (m.view[i] == m.view[j]) * levels.constant**2 / view_weight[m.view[i]]
            unit = unit + (i == j) * levels.white**2 / line_weight[i]
            covariance[2 * i : 2 * i + 2, 2 * j : 2 * j + 2] = unit * factors[i] @ factors[j].T
        late = case.image[2 * i : 2 * i + 2, 6 * i : 6 * i + 6] @ m.structure.motion[i]
        own = levels.lateness**2 * np.outer(late, late) + np.diag(
            np.array([(levels.pixel * CAMERA.sigmas.u_px) ** 2, 0.05**2])
        )
        covariance[2 * i : 2 * i + 2, 2 * i : 2 * i + 2] += own / line_weight[i]
    inverse = np.linalg.inv(covariance)
    normal = case.a.T @ inverse @ case.a + case.information
    right = case.a.T @ inverse @ case.e + case.vector
    chi_squared = case.e @ inverse @ case.e - right @ np.linalg.solve(normal, right)
    return chi_squared + np.log(np.linalg.det(covariance * 10)) + np.log(np.linalg.det(normal / 1e4))


def test_by_levels(case, slopes):
    for i in range(7):
        moved = np.array(LEVELS, dtype=complex)
        moved[i] *= np.exp(1j * STEP)
        expected = density(case, Levels(*moved), case.weights.of_view, case.weights.of_measurement).imag / STEP
        assert slopes.by_level[i] == pytest.approx(expected, rel=1e-7, abs=1e-7)


def test_by_the_variances_of_constants_and_noises(case, slopes):
    weights = case.weights
    for i in range(case.measurements.n_views):
        moved = weights.of_view.astype(complex)
        moved[i] *= np.exp(-1j * STEP)
        expected = density(case, LEVELS, moved, weights.of_measurement).imag / STEP
        assert slopes.by_view[i] == pytest.approx(expected, rel=1e-7, abs=1e-7)
    for i in (0, 7, len(weights.of_measurement) - 1):
        moved = weights.of_measurement.astype(complex)
        moved[i] *= np.exp(-1j * STEP)
        expected = density(case, LEVELS, weights.of_view, moved).imag / STEP
        assert slopes.by_measurement[i] == pytest.approx(expected, rel=1e-7, abs=1e-7)


def test_most_likely_levels_have_no_slope(case):
    weights = Weights(np.ones_like(case.weights.of_view), np.ones_like(case.weights.of_measurement))
    restricted = Restricted(
        case.measurements, case.model, weights, LevelPriors(), tuple(range(7)), log_from_levels(LEVELS)
    )
    found, _ = most_likely(restricted, restricted.start(LEVELS), slope=1e-6)
    assert np.allclose(restricted.value_and_gradient(found)[1], 0, atol=1e-3)
    assert restricted.negative_log_density(found) < restricted.negative_log_density(restricted.start(LEVELS))

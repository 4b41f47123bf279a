"""A noise model with the clock offset, against the model of the survey moved to the offset."""

import numpy as np
import pytest

from linepose.config.platform import load_platform
from linepose.errors import InputError
from linepose.estimation.noise_models import likelihood_of
from linepose.geometry.pose import POSE_COLUMNS
from linepose.likelihood.clock_offset import STEPS, ClockOffsetLikelihood
from linepose.survey.navigation_motion import survey_at, survey_motions
from unit import clock_survey


@pytest.fixture(scope="module")
def simulated(platforms_folder):
    platform = load_platform(platforms_folder, "ladybird-sim")
    survey, log = clock_survey.record(platform.intrinsics(), clock_survey.both_ways(platform.simulation), 0.03, 1)
    return platform, survey, log


@pytest.fixture(scope="module")
def model(simulated):
    platform, survey, log = simulated
    return clock_survey.likelihood(platform.intrinsics(), survey, log)


def at(simulated, offset_s):
    platform, survey, log = simulated
    moved = survey_at(survey, survey_motions(log, survey, 0.1 * (1 + 2 / STEPS)), offset_s)
    return likelihood_of("published", moved, platform.intrinsics())


@pytest.mark.parametrize("offset_s", [-0.1, -0.0437, 0.0, 0.00123, 0.0289, 0.1])
def test_it_is_the_model_of_the_survey_at_that_offset(simulated, model, offset_s):
    """Between the grid's nodes to 1e-4 of a unit of -log L, where a sigma is half a unit."""
    pose = np.array(simulated[0].simulation.true_pose)
    expected = at(simulated, offset_s)
    vector = np.append(pose, offset_s)
    assert model.log_likelihood(vector) == pytest.approx(expected.log_likelihood(pose), abs=1e-4)
    residuals = model.residuals(vector)
    np.testing.assert_allclose(residuals.error_px, expected.residuals(pose).error_px, rtol=1e-9, atol=1e-9)


def test_at_no_offset_it_is_the_model_itself(simulated, model):
    platform, survey, _ = simulated
    pose = np.array(platform.simulation.true_pose)
    plain = likelihood_of("published", survey, platform.intrinsics())
    assert model.log_likelihood(np.append(pose, 0.0)) == pytest.approx(plain.log_likelihood(pose), rel=1e-9)
    assert model.parameter_names == (*POSE_COLUMNS, "clock_offset_s")
    np.testing.assert_array_equal(model.start(pose), [*pose, 0.0])
    assert model.half_widths(2.0, 3.0).tolist() == [2.0, 2.0, 2.0, 3.0, 3.0, 3.0, 0.1]


def test_rows_are_what_single_vectors_are(simulated, model):
    random = np.random.default_rng(2)
    rows = np.append(simulated[0].simulation.true_pose, 0.02) + [*[1e-3] * 6, 0.08] * random.standard_normal((40, 7))
    values = model.log_likelihoods(rows)
    np.testing.assert_allclose(values, [model.log_likelihood(row) for row in rows], rtol=1e-12)
    outside = np.abs(rows[:, -1]) > 0.1
    assert 0 < outside.sum() < len(rows)
    np.testing.assert_array_equal(np.isneginf(values), outside)


def test_selected_observations_are_the_model_of_these(simulated, model):
    platform, survey, log = simulated
    vector = np.append(platform.simulation.true_pose, 0.0123)
    apart = clock_survey.likelihood(platform.intrinsics(), survey.select([1, 2, 5, 8]), log)
    assert model.select([1, 2, 5, 8]).log_likelihood(vector) == pytest.approx(apart.log_likelihood(vector), rel=1e-12)
    assert model.without_cheirality().log_likelihood(vector) == pytest.approx(model.log_likelihood(vector), rel=1e-9)


def test_where_a_neighbour_is_undefined_so_is_what_lies_between(function_likelihood):
    def made(offset_s):
        value = 0.0 if offset_s < 0.05 else np.inf
        return function_likelihood(lambda rows: np.full(len(rows), value))

    model = ClockOffsetLikelihood(made, 0.1)
    step = 0.1 / STEPS
    rows = np.array([[*[0.0] * 6, offset] for offset in (0.0, 0.05 - 3.5 * step, 0.05 - 0.5 * step, 0.08)])
    np.testing.assert_array_equal(model.log_likelihoods(rows), [0.0, 0.0, -np.inf, -np.inf])
    assert [model.log_likelihood(row) for row in rows] == [0.0, 0.0, -np.inf, -np.inf]


def test_a_cubic_of_the_offset_is_met_exactly(function_likelihood):
    def made(offset_s):
        return function_likelihood(
            lambda rows: np.full(len(rows), 1 + 20 * offset_s - 300 * offset_s**2 + 5e3 * offset_s**3)
        )

    model = ClockOffsetLikelihood(made, 0.1)
    for offset_s in (-0.0999, -0.03141, 0.00001, 0.0777):
        expected = -(1 + 20 * offset_s - 300 * offset_s**2 + 5e3 * offset_s**3)
        assert model.log_likelihood(np.array([*[0.0] * 6, offset_s])) == pytest.approx(expected, rel=1e-12)


def test_a_largest_offset_of_nothing_is_told(function_likelihood):
    with pytest.raises(InputError, match="largest offset 0 s"):
        ClockOffsetLikelihood(lambda _: function_likelihood(np.sum), 0)

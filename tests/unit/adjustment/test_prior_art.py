"""Other least-squares programs on the same problem with the same levels find the same optimum."""

import sys
from pathlib import Path

import numpy as np
import pytest

from linepose.adjustment.estimate import unit_weights
from linepose.adjustment.hand_measured import hand_measured
from linepose.adjustment.measurements import measurements_from_survey
from linepose.adjustment.settings import covariance_of_sigmas
from linepose.adjustment.solve import solve
from linepose.adjustment.start import start_points
from linepose.adjustment.state import Knowledge, state_at
from unit.adjustment import timed_survey
from unit.adjustment.plain_problem import PlainProblem
from unit.adjustment.test_against_dense import HAND, LEVELS

sys.path.insert(0, str(Path(__file__).parents[3] / "benchmarks"))
from prior_art import by_ceres, by_gtsam, by_scipy

CAMERA = timed_survey.CAMERA


@pytest.fixture(scope="module")
def problem():
    m = measurements_from_survey(timed_survey.make_survey(3, 4, seed=12), CAMERA, line_period_s=timed_survey.LINE_S)
    knowledge = Knowledge(CAMERA, hand_measured(HAND, covariance_of_sigmas(0.1, np.deg2rad(2))))
    return PlainProblem(m, knowledge, LEVELS, state_at(HAND, CAMERA, start_points(m, CAMERA, HAND), m))


@pytest.fixture(scope="module")
def found(problem):
    m = problem.measurements
    return solve(m, problem.knowledge, problem.start, LEVELS, unit_weights(m), tolerance=1e-11)


@pytest.mark.parametrize(("program", "package"), [(by_scipy, "scipy"), (by_ceres, "pyceres"), (by_gtsam, "gtsam")])
def test_the_same_optimum(problem, found, program, package):
    pytest.importorskip(package)
    pose, chi_squared = program(problem)
    assert chi_squared == pytest.approx(found.done.chi_squared, rel=1e-8)
    assert np.allclose(pose, found.state.pose, rtol=0, atol=1e-6)


def test_the_plain_problem_has_the_derivatives_it_states(problem):
    x = np.concatenate([part.ravel() for part in problem.first()])
    x = x + 1e-3 * np.random.default_rng(1).normal(size=len(x))
    x[6:8] = [1.0, 1e-5]
    _, jacobian = problem.residuals(x)
    for column in (0, 4, 6, 7, 9, 30, 90, 120, len(x) - 1):
        step = np.zeros_like(x)
        step[column] = 1e-9 if column == 7 else 1e-6
        ahead, behind = problem.residuals(x + step)[0], problem.residuals(x - step)[0]
        expected = jacobian[:, [column]].toarray()[:, 0]
        assert np.allclose(
            (ahead - behind) / (2 * step[column]), expected, rtol=1e-5, atol=1e-5 * np.abs(expected).max()
        )

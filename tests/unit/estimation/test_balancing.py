"""The balanced model's reference is the optimum that it has itself."""

import numpy as np
import pytest

from linepose.estimation.balancing import balanced, reference_from
from linepose.estimation.optimise import minimise
from unit.likelihood.small_survey import CAMERA, POSE, Truth, make_survey

START = POSE + np.array([0.05, -0.05, 0.04, 0.03, -0.02, 0.02])


def test_the_reference_is_where_the_search_ends():
    likelihood = balanced(make_survey(8, 6, Truth(0.5, 0.1, 1.0), seed=3), CAMERA, START)
    found = minimise(likelihood, likelihood.start(START), START)
    sigma = 0.05  # of the levels, about; their priors differ in width between the two
    assert found.converged
    np.testing.assert_allclose(found.parameters[:6], likelihood.reference.pose, atol=5e-3)
    assert np.exp(found.parameters[6]) == pytest.approx(likelihood.reference.levels.shared, abs=sigma)


def test_it_does_not_depend_on_where_it_starts():
    survey = make_survey(8, 6, Truth(0.5, 0.1, 1.0), seed=3)
    first, second = (reference_from(start)(survey, CAMERA) for start in (POSE, START))
    np.testing.assert_allclose(first.pose, second.pose, atol=2e-3)
    np.testing.assert_allclose(first.levels, second.levels, atol=0.02)


def test_a_level_of_zero_is_found_to_be_none():
    reference = reference_from(START)(make_survey(10, 8, Truth(0.5, 0.0, 1.0), seed=5), CAMERA)
    assert reference.levels.white < 0.1

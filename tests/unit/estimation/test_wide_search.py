"""The wide search's parts, and that it finds what Powell's method from afar does not."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from scipy.stats import kstest

from linepose.errors import InputError
from linepose.estimation.optimise import Search, optimise
from linepose.estimation.optimisers import OPTIMISERS, optimiser
from linepose.estimation.wide_search import WideSearch, moved_and_turned, refine, search_widely, whitened_residuals
from linepose.experiments.basin import BasinSettings, start_pose
from linepose.likelihood.published import PublishedLikelihood
from linepose.survey.observations import Survey
from unit.likelihood.surveys import DISTORTED_CAMERA, SYNTHETIC_POSE, synthetic_survey


@pytest.fixture(scope="module")
def survey() -> Survey:
    return synthetic_survey(8, 6, seed=3)


@pytest.fixture
def likelihood(survey):
    return PublishedLikelihood(survey, DISTORTED_CAMERA)


def test_candidates_fill_both_balls_evenly_and_start_with_the_given_pose():
    """A radius cubed is uniform within its ball; a Sobol sequence of 1024 is nearer to uniform than random numbers."""
    parameters = np.append(SYNTHETIC_POSE, 7.0)
    around = moved_and_turned(parameters, 1024, 2.0, 0.9)
    np.testing.assert_allclose(around[0], parameters, atol=1e-12)
    np.testing.assert_array_equal(around[:, 6], 7.0)
    turns = (Rotation.from_rotvec(around[:, 3:6]) * Rotation.from_rotvec(SYNTHETIC_POSE[3:]).inv()).as_rotvec()
    for vectors, radius in ((turns, 0.9), (around[:, :3] - SYNTHETIC_POSE[:3], 2.0)):
        length = np.linalg.norm(vectors, axis=1)
        assert length.max() <= radius + 1e-12
        assert kstest((length / radius) ** 3, "uniform").pvalue > 0.1
        assert np.linalg.norm(vectors.mean(axis=0)) < 0.02 * radius


def test_whitened_residuals_add_up_to_the_likelihood(likelihood):
    whitened = whitened_residuals(likelihood, SYNTHETIC_POSE)
    assert -0.5 * np.sum(whitened**2) == pytest.approx(likelihood.log_likelihood(SYNTHETIC_POSE), rel=1e-10)


def test_what_was_not_observed_has_no_residual(survey):
    survey = survey.select(survey.number.tolist())
    survey.u_px[2, 3] = np.nan
    likelihood = PublishedLikelihood(survey, DISTORTED_CAMERA)
    whitened = whitened_residuals(likelihood, SYNTHETIC_POSE).reshape(8, 6, 2)
    np.testing.assert_array_equal(whitened[2, 3], 0)
    assert np.count_nonzero(whitened) == 2 * (8 * 6 - 1)


def test_least_squares_reach_the_optimum_of_powells_method(likelihood):
    """To 1e-6 of the squared residuals, that is of -log L."""
    start = SYNTHETIC_POSE + np.array([0.2, -0.1, 0.15, 0.1, -0.1, 0.1])
    refined, spent = refine(likelihood, start, start, Search(), WideSearch())
    expected = optimise(likelihood, SYNTHETIC_POSE)
    assert -likelihood.log_likelihood(refined) == pytest.approx(expected.neg_log_likelihood, rel=1e-5)
    assert 6 < spent < 500


def test_refinement_stays_in_the_searched_range(likelihood):
    start = SYNTHETIC_POSE + np.array([0.2, -0.1, 0.15, 0.0, 0.0, 0.0])
    refined, _ = refine(likelihood, start, start, Search(half_width_m=0.05), WideSearch())
    assert np.max(np.abs(refined[:3] - start[:3])) <= 0.05 + 1e-5


def test_finds_the_optimum_where_a_point_lies_behind_the_start(likelihood):
    """Two starts of a sweep at which the likelihood is not defined; at the second one, for no rotation."""
    expected = optimise(likelihood, SYNTHETIC_POSE).neg_log_likelihood
    for cell in (34, 53):
        start = start_pose(BasinSettings(n_distances=8, n_angles=8), SYNTHETIC_POSE, 1, cell)
        assert likelihood.log_likelihood(start) == -np.inf
        assert search_widely(likelihood, start).neg_log_likelihood == pytest.approx(expected, rel=1e-5)
        assert optimise(likelihood, start).neg_log_likelihood > 2 * expected


def test_the_same_start_gives_the_same_bits(likelihood):
    start = SYNTHETIC_POSE + 0.1
    np.testing.assert_array_equal(
        search_widely(likelihood, start).parameters, search_widely(likelihood, start).parameters
    )


def test_start_that_is_not_finite_is_refused(likelihood):
    with pytest.raises(InputError, match="start pose"):
        search_widely(likelihood, [np.nan, 0, 0, 0, 0, 0])


@pytest.mark.parametrize("name", OPTIMISERS)
def test_every_optimiser_finds_the_near_optimum(likelihood, name):
    start = SYNTHETIC_POSE + np.array([0.05, -0.05, 0.05, 0.02, -0.02, 0.02])
    found = optimiser(name)(likelihood, start, Search())
    expected = optimise(likelihood, SYNTHETIC_POSE)
    assert found.neg_log_likelihood == pytest.approx(expected.neg_log_likelihood, rel=1e-5)
    np.testing.assert_allclose(found.parameters, expected.parameters, atol=5e-3)


def test_unknown_optimiser_is_named():
    with pytest.raises(InputError, match="'powel'"):
        optimiser("powel")

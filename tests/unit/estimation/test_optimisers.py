"""The search of section 4.7: its ranges, and its basin on the field data."""

import numpy as np
import pytest

from linepose.estimation.optimise import Search, optimise
from linepose.estimation.optimisers import search_as_published
from linepose.experiments.basin import BasinSettings, start_pose
from linepose.geometry.distance import mahalanobis_distance
from linepose.likelihood.published import PublishedLikelihood
from unit.likelihood.surveys import INLIERS, field_survey


@pytest.mark.parametrize(
    ("wanted", "reached"),
    [
        ([5.0, 0, 0, 1.0, 0, 0], [2.5, 0, 0, 1.0, 0, 0]),  # 2 m from the start
        ([0.5, 0, 0, 4.0, 0, 0], [0.5, 0, 0, np.pi, 0, 0]),  # pi, not pi from the start
        ([0.5, 0, 0, 0, 0, -4.0], [0.5, 0, 0, 0, 0, -np.pi]),
    ],
)
def test_position_stays_near_the_start_and_rotation_within_pi(function_likelihood, wanted, reached):
    likelihood = function_likelihood(lambda p: 1.0 + np.sum((p - wanted) ** 2, axis=1))
    found = search_as_published(likelihood, np.array([0.5, 0, 0, 1.5, 0, 0]), Search())
    np.testing.assert_allclose(found.parameters, reached, atol=2e-3)


def test_start_turned_by_half_a_revolution_is_no_edge(function_likelihood):
    start = np.array([0.2, -0.1, 0.3, np.pi, 0, 0])
    likelihood = function_likelihood(lambda p: 1.0 + np.sum((p - start - 0.1) ** 2, axis=1))
    np.testing.assert_allclose(optimise(likelihood, start).parameters, start + 0.1, atol=1e-3)
    # the published ranges end there; the search starts all the same
    assert search_as_published(likelihood, start, Search()).parameters[3] <= np.pi


@pytest.mark.field
def test_triangle_of_section_4_7_is_all_basin(field_data, ladybird, published):
    """From each cell of the default grid within the triangle the optimum is found, as the paper claims."""
    survey = field_survey().select(list(INLIERS))
    likelihood = PublishedLikelihood(survey, ladybird.intrinsics())
    inliers = published["table3"]["ladybird"]["inliers_16"]
    reference = optimise(likelihood, inliers["pose"]).parameters
    grid = BasinSettings()
    region = grid.region()
    cells = [cell for cell in range(grid.n_cells) if region.holds(*grid.offset(cell))]
    assert len(cells) == 37
    for cell in cells:
        found = search_as_published(likelihood, start_pose(grid, reference, 2017, cell), Search())
        assert mahalanobis_distance(found.parameters, reference, np.diag(np.square(inliers["sigma"]))) < 0.1

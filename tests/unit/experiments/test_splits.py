"""Random splits where the poses of all subsets are known in closed form."""

import numpy as np
import pytest
from scipy.stats import kstest

from linepose.errors import InputError
from linepose.estimation.likelihood_estimator import LikelihoodEstimator
from linepose.experiments.splits import random_splits, split_numbers
from unit.experiments.conftest import SIGMA, TRUE_POSE, GaussianLikelihood, make_survey


class OpenLikelihood(GaussianLikelihood):
    def __init__(self, inner):
        self.__dict__.update(inner.__dict__)

    def select(self, numbers):
        chosen = OpenLikelihood(self)
        rows = [self.survey.number.tolist().index(n) for n in numbers]
        chosen.survey, chosen.means = self.survey.select(numbers), self.means[rows]
        return chosen


def test_splits_are_disjoint_and_depend_on_seed_and_index_alone():
    numbers = np.arange(1, 17)
    splits = [split_numbers(numbers, 8, 5, index) for index in range(50)]
    for first, second in splits:
        assert sorted(first + second) == numbers.tolist()
    assert len({tuple(first) for first, _ in splits}) > 40
    assert splits[31] == split_numbers(numbers, 8, 5, 31)
    assert splits[31] != split_numbers(numbers, 8, 6, 31)


@pytest.mark.parametrize("size", [0, 9])
def test_split_size_out_of_range_is_refused(size):
    with pytest.raises(InputError, match=rf"split_size: found {size}, expected 1 to 8"):
        split_numbers(np.arange(16), size, 1, 0)


@pytest.mark.statistical
def test_p_values_of_splits_of_independent_data_are_uniform():
    """400 surveys, one split each; Kolmogorov-Smirnov at the 0.1 % level, seed fixed."""
    random, survey = np.random.default_rng(11), make_survey(8)
    values = []
    for index in range(400):
        means = TRUE_POSE + random.standard_normal((8, 6)) * SIGMA
        likelihood = GaussianLikelihood(survey, means, np.diag(SIGMA**2))
        values.append(random_splits(LikelihoodEstimator(likelihood), TRUE_POSE, 4, [index], seed=1)["p_value"].iloc[0])
    assert kstest(values, "uniform").pvalue > 1e-3


def test_splits_do_not_depend_on_the_batch(gaussian):
    together = random_splits(LikelihoodEstimator(gaussian), TRUE_POSE, 5, range(4), seed=3)
    alone = random_splits(LikelihoodEstimator(gaussian), TRUE_POSE, 5, [2], seed=3)
    assert together.iloc[[2]].reset_index(drop=True).equals(alone)


def test_split_that_leaves_a_direction_open_has_a_pose_but_no_distance(gaussian):
    """Nothing measures r_y."""
    gaussian.information[1, :] = gaussian.information[:, 1] = 0.0
    table = random_splits(LikelihoodEstimator(OpenLikelihood(gaussian)), TRUE_POSE, 5, range(2), seed=3)
    assert table[["mahalanobis", "p_value", "sigma_r_x_m_1"]].isna().all(axis=None)
    assert np.isfinite(table[["r_x_m_1", "theta_z_rad_2", "distance_m"]].to_numpy()).all()

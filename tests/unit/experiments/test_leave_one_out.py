"""Leaving one observation out, where its share of the pose is known."""

import numpy as np

from linepose.estimation.likelihood_estimator import LikelihoodEstimator
from linepose.experiments.leave_one_out import leave_one_out
from linepose.geometry.pose import POSE_COLUMNS
from unit.experiments.conftest import SIGMA, TRUE_POSE


def test_leaving_one_out_moves_the_mean_by_its_share(gaussian):
    """Without observation k the mean moves by (mean - m_k) / (n - 1)."""
    estimator = LikelihoodEstimator(gaussian)
    full = estimator.estimate(TRUE_POSE)
    table = leave_one_out(estimator, full.pose, full.covariance)
    mean = gaussian.means.mean(axis=0)
    expected = mean + (mean - gaussian.means) / (len(gaussian.means) - 1)
    np.testing.assert_allclose((table[list(POSE_COLUMNS)].to_numpy() - expected) / SIGMA, 0, atol=2e-3)
    assert table["left_out"].tolist() == list(range(1, 13))
    assert table["influence"].idxmax() == np.argmax(np.sum(((gaussian.means - mean) / SIGMA) ** 2, axis=1))

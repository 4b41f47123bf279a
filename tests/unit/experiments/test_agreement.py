"""How far two estimates lie apart, where both are known in closed form."""

import numpy as np
import pytest

from linepose.estimation.likelihood_estimator import LikelihoodEstimator
from linepose.experiments.agreement import agreement
from unit.experiments.conftest import SIGMA, TRUE_POSE


def test_agreement_of_two_known_estimates(gaussian):
    """Same rotation, positions 0.3 m apart with sigmas 0.1 / sqrt(6) each: 0.3 / (0.1 / sqrt(3)) sigmas."""
    gaussian.means[:] = TRUE_POSE
    gaussian.means[6:, 0] += 0.3
    first, second = (
        LikelihoodEstimator(gaussian).select(list(n)).estimate(TRUE_POSE) for n in (range(1, 7), range(7, 13))
    )
    found = agreement(first, second)
    assert found["distance_m"] == pytest.approx(0.3, rel=1e-3)
    assert found["mahalanobis"] == pytest.approx(0.3 / (SIGMA[0] / np.sqrt(3)), rel=1e-3)
    assert found["p_value"] < 0.05

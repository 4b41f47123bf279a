"""The shared-error model on the Ladybird field data: the numbers that a separate, dense prototype found."""

import numpy as np
import pytest
from scipy.optimize import minimize

from linepose.likelihood.shared import SharedLikelihood
from unit.likelihood import field_data

pytestmark = [pytest.mark.field, pytest.mark.skipif(not field_data.PRESENT, reason="no field data")]
SCALE = [*[0.05] * 3, *[0.01] * 3, *[0.5] * 3, 0.6, 3e-5]
HAND_MEASURED = [0.200, 0.000, -0.800, -0.762, 0.762, -1.433]


def optimum(likelihood, pose):
    """Parameters (11,) at the optimum, and the covariance that the curvature there means."""
    start, scale = likelihood.start(pose), np.array(SCALE)

    def negative(step):
        return -likelihood.log_likelihood(start + step * scale)

    found = minimize(negative, np.zeros(11), method="BFGS")
    h = 0.02
    unit = h * np.eye(11)
    hessian = np.array(
        [
            [
                negative(found.x + p + q)
                - negative(found.x + p - q)
                - negative(found.x - p + q)
                + negative(found.x - p - q)
                for q in unit
            ]
            for p in unit
        ]
    ) / (4 * h * h)
    return start + found.x * scale, np.linalg.inv(hessian) * np.outer(scale, scale)


def test_sixteen_inliers():
    likelihood = SharedLikelihood(field_data.reverse_views(), field_data.CAMERA).select(field_data.INLIERS)
    parameters, covariance = optimum(likelihood, HAND_MEASURED)
    assert np.allclose(parameters[:6], [0.180, 0.001, -0.810, -0.794, 0.773, -1.447], rtol=0, atol=6e-4)
    sigma = np.sqrt(np.diag(covariance))[:6]
    assert np.allclose(sigma, [0.042, 0.019, 0.059, 0.010, 0.011, 0.004], rtol=0, atol=6e-4)
    assert np.allclose(np.exp(parameters[6:9]), [0.51, 0.03, 2.3], rtol=0, atol=[6e-3, 6e-3, 6e-2])


def test_all_twenty_five_and_the_forward_views_agree_with_the_inliers():
    survey = field_data.reverse_views()
    inliers, covariance = optimum(SharedLikelihood(survey.select(field_data.INLIERS), field_data.CAMERA), HAND_MEASURED)
    for other in (survey, field_data.forward_views()):
        parameters, other_covariance = optimum(SharedLikelihood(other, field_data.CAMERA), HAND_MEASURED)
        both = np.sqrt(np.diag(covariance + other_covariance))[:6]
        assert np.all(np.abs(parameters - inliers)[:6] < 2.5 * both)
        assert -0.08 < parameters[1] < 0.02

"""The adjustment on the Ladybird field data: what a separate prototype of section 6's model found."""

import numpy as np
import pytest

from linepose.adjustment import AdjustmentSettings, adjust
from unit.likelihood import field_data

pytestmark = [pytest.mark.field, pytest.mark.skipif(not field_data.PRESENT, reason="no field data")]
HAND_MEASURED = [0.200, 0.000, -0.800, -0.762, 0.762, -1.433]


def found(survey, **settings):
    return adjust(survey, field_data.CAMERA, HAND_MEASURED, settings=AdjustmentSettings(**settings))


@pytest.mark.parametrize(
    ("prior", "all_views", "position", "sigma"),
    [
        (False, False, [0.197, 0.035, -0.780], [0.040, 0.014, 0.075]),
        (True, False, [0.200, 0.033, -0.790], [0.037, 0.014, 0.059]),
        (False, True, [0.169, 0.029, -0.700], [0.041, 0.014, 0.084]),
    ],
)
def test_pose_and_sigmas(prior, all_views, position, sigma):
    survey = field_data.reverse_views()
    one = found(survey if all_views else survey.select(field_data.INLIERS), hand_measured_prior=prior)
    assert np.allclose(one.pose[:3], position, rtol=0, atol=3e-3)
    # draws worth fifty: a sigma is known to some 10 %
    assert np.allclose(one.sigma[:3], sigma, rtol=0.12)
    assert one.diagnostics.converged
    assert not one.diagnostics.heavy_tails
    assert one.diagnostics.least_eigenvalue > 0.9


def test_levels_say_what_is_wrong_with_the_reported_sigmas():
    levels = found(field_data.reverse_views().select(field_data.INLIERS), hand_measured_prior=False, n_draws=50).levels
    assert np.allclose(levels, [0.83, 0.044, 0.40, 0.235, 0.61, 13.8, 0.42], rtol=0.06)

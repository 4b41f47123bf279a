"""What is stated is true: errors in sigmas over surveys with a known truth."""

import numpy as np
import pytest
from scipy.stats import chi2

from linepose.adjustment import AdjustmentSettings, adjust
from linepose.geometry.distance import difference_covariance, pose_difference
from unit.adjustment import timed_survey

N_SURVEYS = 10
REGIMES = {
    "drift": timed_survey.Errors(drift=0.8, white=0.0, constant=0.0),
    "constant": timed_survey.Errors(drift=0.0, white=0.0, constant=0.8),
    "white": timed_survey.Errors(drift=0.0, white=0.8, constant=0.0),
}


@pytest.mark.statistical
@pytest.mark.parametrize("regime", REGIMES)
def test_squared_errors_in_sigmas_add_up_to_chi_squared(regime):
    settings = AdjustmentSettings(
        hand_measured_prior=False, line_period_s=timed_survey.LINE_S, n_draws=80, n_samples=100
    )
    total = 0.0
    for seed in range(N_SURVEYS):
        survey = timed_survey.make_survey(10, 8, REGIMES[regime], seed=900 + seed)
        found = adjust(survey, timed_survey.CAMERA, timed_survey.POSE, settings=settings)
        error = pose_difference(timed_survey.POSE, found.pose)
        total += error @ np.linalg.solve(difference_covariance(found.pose, found.covariance), error)
    # 99.8 % of a chi squared of six for each survey, wider by 10 % of a sigma that 40 effective draws leave open
    low, high = chi2.ppf([0.001, 0.999], 6 * N_SURVEYS)
    assert 0.8 * low < total < 1.2 * high

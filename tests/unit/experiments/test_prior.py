"""Who decided a parameter, on Gaussians whose weights are known."""

import numpy as np
import pytest

from linepose.config.platform import Platform
from linepose.estimation.identifiability import data_weight
from linepose.experiments.prior import identifiability_table, prior_table
from linepose.likelihood.prior import pose_prior
from unit import made_up

CENTRE = np.array([0.2, 0.0, -0.8, -0.76, 0.76, -1.43])
PRIOR = np.diag([0.1, 0.1, 0.1, 0.03, 0.03, 0.03]) ** 2


@pytest.mark.parametrize("weight", [0.02, 0.5, 0.98])
def test_weight_is_the_data_s_share_of_the_information(weight):
    prior, data = 0.1, 0.1 * np.sqrt((1 - weight) / weight)
    posterior = 1 / np.sqrt(1 / prior**2 + 1 / data**2)
    assert data_weight(posterior, prior, True) == pytest.approx(weight, rel=1e-12)
    assert data_weight(data, prior, False) == pytest.approx(weight, rel=1e-12)


def posterior(data_sigmas):
    """Posterior covariance where the data measure position and rotation vector with these sigmas."""
    return np.linalg.inv(np.linalg.inv(PRIOR) + np.diag(1 / np.square(data_sigmas)))


def test_each_parameter_has_its_decider():
    covariance = posterior([0.01, 0.1, 1.0, 1e-4, 1e-4, 1e-4])
    table = prior_table(CENTRE, covariance, pose_prior(CENTRE, PRIOR), True).set_index("parameter")
    assert table["decided_by"].tolist() == ["data", "data and prior", "prior", "data", "data", "data"]
    np.testing.assert_allclose(table["data_weight"].iloc[:3], [1 / 1.01, 0.5, 0.01 / 1.01], rtol=1e-9)
    np.testing.assert_allclose(table["difference"], 0.0, atol=1e-12)
    assert table.index.tolist() == ["r_x_m", "r_y_m", "r_z_m", "roll_rad", "pitch_rad", "yaw_rad"]


def test_without_a_prior_the_data_decide_and_the_weight_tells_how_much_the_tape_would_add():
    covariance = np.diag(np.square([0.01, 0.1, 1.0, 0.01, 0.01, 0.01]))
    table = prior_table(CENTRE, covariance, pose_prior(CENTRE, PRIOR), False)
    assert set(table["decided_by"]) == {"data"}
    assert not table["prior_counted_in"].any()
    np.testing.assert_allclose(table["data_weight"].iloc[:3], [1 / 1.01, 0.5, 0.01 / 1.01], rtol=1e-9)


def test_what_is_known_least_is_named():
    covariance = np.diag(np.square([0.01, 0.01, 0.09, 1e-3, 1e-3, 1e-3]))
    table = identifiability_table(CENTRE, covariance, pose_prior(CENTRE, PRIOR))
    assert table["weakest_in_words"].unique().tolist() == ["r_z"]
    assert table.set_index("parameter").loc["r_z_m", "shrinkage"] == pytest.approx(1 - 0.81)


def test_platform_file_decides_whether_the_hand_measurement_counts():
    assert made_up.platform(prior="none").pose_prior() is None
    prior = made_up.platform(prior="hand_measured").pose_prior()
    np.testing.assert_allclose(prior.pose, made_up.platform().start_pose())
    np.testing.assert_allclose(prior.sigma()[:3], 0.1)
    np.testing.assert_allclose(prior.sigma()[3:], np.radians(2.0), rtol=1e-9)
    with pytest.raises(ValueError, match="hand_measured"):
        Platform.model_validate(made_up.PLATFORM | {"prior": "tape"})

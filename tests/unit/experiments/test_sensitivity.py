"""Sensitivity rows where the moved pose is known."""

import numpy as np
import pytest

from linepose.estimation.likelihood_estimator import LikelihoodEstimator
from linepose.experiments.sensitivity import NOMINAL, camera_changes, sensitivity
from linepose.geometry.pose import POSE_COLUMNS, SIGMA_COLUMNS
from unit.experiments.conftest import SIGMA, TRUE_POSE, GaussianLikelihood


def test_camera_changes_are_one_sigma_of_one_quantity(camera):
    changes = camera_changes(camera)
    assert changes["focal length + 1 sigma"].focal_length_m == pytest.approx(8.3e-3)
    assert changes["focal length - 1 sigma"].focal_length_m == pytest.approx(8.1e-3)
    assert changes["principal point + 1 sigma"].principal_point_px == 325
    assert changes["principal point - 1 sigma"].principal_point_px == 321
    assert all(changed.sigmas == camera.sigmas for changed in changes.values())
    assert changes["principal point - 1 sigma"].focal_length_m == camera.focal_length_m


def test_moved_and_narrowed_pose(gaussian):
    """Means 0.2 m to the right with half the sigma: the pose moves 0.2 m, by 0.2 / (sigma_y / sqrt 12) sigmas."""
    moved = GaussianLikelihood(gaussian.survey, gaussian.means + np.array([0, 0.2, 0, 0, 0, 0]), np.diag(SIGMA**2) / 4)
    table = sensitivity(LikelihoodEstimator(gaussian), {"moved": LikelihoodEstimator(moved)}, TRUE_POSE).set_index(
        "change"
    )
    assert table.index.tolist() == [NOMINAL, "moved"]
    assert table.loc[NOMINAL, "mahalanobis"] == 0
    assert table.loc["moved", "mahalanobis"] == pytest.approx(0.2 / (SIGMA[1] / np.sqrt(12)), rel=1e-3)
    assert table.loc["moved", "r_y_m"] - table.loc[NOMINAL, "r_y_m"] == pytest.approx(0.2, abs=1e-4)
    ratio = table.loc["moved", list(SIGMA_COLUMNS)].to_numpy(float) / table.loc[NOMINAL, list(SIGMA_COLUMNS)].to_numpy(
        float
    )
    np.testing.assert_allclose(ratio, 0.5, rtol=1e-4)
    np.testing.assert_allclose(
        table.loc[NOMINAL, list(POSE_COLUMNS)].to_numpy(float), gaussian.means.mean(axis=0), atol=1e-4
    )

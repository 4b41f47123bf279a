"""The hand measurement as a prior: its error and Jacobian against the general functions of rotations."""

import numpy as np
import pytest

from linepose.adjustment.hand_measured import hand_measured
from linepose.adjustment.settings import covariance_of_sigmas
from linepose.geometry import rotations

ANGLES_RAD = [0.0, 1e-9, 1e-5, 1e-3, 0.1, 1.0, 2.0, 3.0, np.pi - 1e-7]


@pytest.mark.parametrize("angle_rad", ANGLES_RAD)
def test_information_is_that_of_a_turn_about_body_axes(angle_rad):
    random = np.random.default_rng(1)
    for _ in range(20):
        axis, rotation = random.standard_normal(3), rotations.matrix_from_rotation_vector(random.standard_normal(3))
        turn = angle_rad * axis / np.linalg.norm(axis)
        pose = np.array(
            [
                0.1,
                -0.2,
                0.3,
                *rotations.rotation_vector_from_matrix(rotations.matrix_from_rotation_vector(turn) @ rotation),
            ]
        )
        position_m = pose[:3] - [0.01, 0.02, -0.03]
        information, vector, chi_squared = hand_measured(pose, covariance_of_sigmas(0.1, 0.05)).information(
            position_m, rotation
        )
        by_step = np.linalg.inv(rotations.left_jacobian_so3(-turn))
        np.testing.assert_allclose(information[3:, 3:], by_step.T @ by_step / 0.05**2, atol=1e-9)
        np.testing.assert_allclose(vector[3:], by_step.T @ turn / 0.05**2, atol=1e-9)
        np.testing.assert_allclose(vector[:3], [1.0, 2.0, -3.0], atol=1e-9)
        assert chi_squared == pytest.approx(turn @ turn / 0.05**2 + 0.0014 / 0.1**2, abs=1e-9)

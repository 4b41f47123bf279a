"""The sigmas of hand-measured rotations against scipy's rotations, and as the regression declares them."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from linepose.geometry.pose import SIGMA_COLUMNS, rotation_vector_pose
from linepose.paper.hand_measured import hand_measured_sigma
from unit.paper.reproduced import DECLARED, PUBLISHED

STEP_DEG = 1e-3


def by_differences(roll_pitch_yaw_deg) -> np.ndarray:
    """First-order sigmas (3,) of the rotation vector, where each Euler angle is known to 2 deg."""

    def vector(step):
        return Rotation.from_euler("ZYX", (np.array(roll_pitch_yaw_deg) + step)[::-1], degrees=True).as_rotvec()

    columns = [(vector(step) - vector(-step)) / (2 * STEP_DEG) for step in STEP_DEG * np.eye(3)]
    return 2.0 * np.linalg.norm(np.array(columns), axis=0)


@pytest.mark.parametrize("platform", ["ladybird", "shrimp"])
def test_rotation_sigmas_are_those_of_two_degrees_an_euler_angle(platform):
    measured = PUBLISHED["table1"][platform]
    pose = rotation_vector_pose([*measured["position_m"], *np.deg2rad(measured["euler_deg"])])
    np.testing.assert_allclose(hand_measured_sigma(pose)[3:], by_differences(measured["euler_deg"]), rtol=1e-6)


def test_the_regression_declares_what_differences_give():
    sigma = by_differences(PUBLISHED["table1"]["shrimp"]["euler_deg"])
    for name, value in zip(SIGMA_COLUMNS[3:], sigma, strict=True):
        declared, _ = DECLARED.expected[f"shrimp, Table 3, hand_measured, {name}"]
        assert declared.expected == round(value, 4)
        assert declared.tolerance == pytest.approx(0.5e-4)

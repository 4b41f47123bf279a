import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from linepose.geometry.pose import rotation_vector_pose
from linepose.geometry.pose_with_covariance import PoseWithCovariance
from linepose.pipeline.pose_tables import euler_numbers, rotation_vector_numbers

POSE = np.array([0.19, -0.14, -0.79, -0.82, 0.74, -1.43])
HAND = rotation_vector_pose([0.2, 0.0, -0.8, np.radians(-56), 0.0, np.radians(-90)])
COVARIANCE = np.diag([0.03, 0.05, 0.06, 0.016, 0.018, 0.009]) ** 2
ESTIMATE = PoseWithCovariance(POSE, COVARIANCE)


def test_numbers_stand_beside_the_hand_measurement_in_sigmas_of_the_difference():
    hand = PoseWithCovariance(HAND, np.diag([0.1, 0.12, 0.1, 0.04, 0.04, 0.04]) ** 2)
    number = rotation_vector_numbers(ESTIMATE, hand)[1]
    assert (number.unit, number.estimate, number.sigma, number.hand) == ("m", -0.14, pytest.approx(0.05), 0.0)
    assert number.difference_sigmas == pytest.approx(-0.14 / 0.13)
    assert number.error_sigmas is None


def test_beside_a_prior_that_counts_the_difference_is_that_of_the_data_alone():
    """From data and prior apart: by the textbook the weighted mean has 1/sigma^2 the sum of both's."""
    alone, sigma, by_hand = 0.3, 0.05, 0.1
    weight = by_hand**2 / (sigma**2 + by_hand**2)
    pose, covariance = HAND.copy(), COVARIANCE.copy()
    pose[0], covariance[0, 0] = HAND[0] + weight * alone, weight * sigma**2
    covariance[1, 1], pose[1] = (0.95 * by_hand) ** 2, HAND[1] + 0.02
    hand = PoseWithCovariance(HAND, np.diag([by_hand] * 3 + [0.04] * 3) ** 2)
    told = rotation_vector_numbers(PoseWithCovariance(pose, covariance), hand, hand_counts=True)
    assert told[0].difference_sigmas == pytest.approx(alone / np.hypot(sigma, by_hand), rel=1e-9)
    assert told[1].difference_sigmas == pytest.approx(0.02 / by_hand)  # the data have said nothing of it


def test_the_error_against_the_truth_is_in_sigmas_of_the_estimate():
    number = rotation_vector_numbers(ESTIMATE, ESTIMATE, POSE - 0.06)[2]
    assert number.error_sigmas == pytest.approx(1.0)


def test_euler_angles_and_their_sigmas_follow_the_samples():
    random = np.random.default_rng(1)
    drawn = POSE[3:] + np.sqrt(np.diag(COVARIANCE))[3:] * random.standard_normal((20000, 3))
    sampled = Rotation.from_rotvec(drawn).as_euler("ZYX", degrees=True)[:, ::-1]
    numbers = euler_numbers(ESTIMATE, PoseWithCovariance(HAND, COVARIANCE))
    assert [number.name for number in numbers] == ["roll", "pitch", "yaw"]
    # the mean and sigma of 20000 draws are known to 1 / sqrt(20000) and 1 / sqrt(40000) of a sigma; five of each
    sigma = [number.sigma for number in numbers]
    np.testing.assert_allclose(sigma, sampled.std(axis=0), rtol=5 / np.sqrt(40000))
    expected = Rotation.from_rotvec(POSE[3:]).as_euler("ZYX", degrees=True)[::-1]
    np.testing.assert_allclose([number.estimate for number in numbers], expected)
    np.testing.assert_allclose([number.hand for number in numbers], [-56, 0, -90], atol=1e-9)


def test_angles_on_either_side_of_half_a_turn_are_near_to_each_other():
    def pose(roll_deg):
        turned = rotation_vector_pose([0.0, 0.0, 0.0, np.radians(roll_deg), 0.2, 0.3])
        return PoseWithCovariance(turned, COVARIANCE)

    roll, *_ = euler_numbers(pose(-173.0), pose(180.0), pose(175.0).pose)
    assert roll.difference == pytest.approx(7.0)
    assert roll.error_sigmas == pytest.approx(12.0 / roll.sigma)


def test_euler_angles_that_mean_nothing_are_left_out():
    upright = rotation_vector_pose([0.0, 0.0, 0.0, 0.0, np.radians(89.9), 0.3])
    assert euler_numbers(PoseWithCovariance(upright, COVARIANCE), ESTIMATE) == []


def test_quaternion_turns_vectors_as_the_rotation_does():
    w, *vector = ESTIMATE.quaternion_wxyz
    assert w >= 0
    v = np.array([0.3, -0.2, 0.9])
    turned = v + 2 * np.cross(vector, np.cross(vector, v) + w * v)
    np.testing.assert_allclose(turned, Rotation.from_rotvec(POSE[3:]).apply(v))

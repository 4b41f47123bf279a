import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from linepose.errors import InputError
from linepose.geometry import pose

HALF_OF_LAST_DIGIT = 0.0005


def euler_pose_of_table_1(published, name):
    row = published["table1"][name]
    return np.concatenate([row["position_m"], np.deg2rad(row["euler_deg"])])


def hand_measured_covariance():
    return np.diag(np.repeat([0.1, np.deg2rad(2.0)], 3) ** 2)


@pytest.mark.parametrize("name", ["ladybird", "shrimp"])
def test_table_1_becomes_table_3s_hand_measured_pose(published, name):
    expected = published["table3"][name]["hand_measured"]["pose"]
    found = pose.rotation_vector_pose(euler_pose_of_table_1(published, name))
    np.testing.assert_allclose(found, expected, rtol=0, atol=HALF_OF_LAST_DIGIT)


def test_table_3s_hand_measured_ladybird_sigmas_follow_from_two_degrees(published):
    expected = published["table3"]["ladybird"]["hand_measured"]["sigma"]
    covariance = pose.rotation_vector_covariance(
        euler_pose_of_table_1(published, "ladybird"), hand_measured_covariance()
    )
    np.testing.assert_allclose(np.sqrt(np.diag(covariance)), expected, rtol=0, atol=HALF_OF_LAST_DIGIT)


def test_shrimps_hand_measured_sigmas_deviate_as_published_yaml_says(published):
    covariance = pose.rotation_vector_covariance(euler_pose_of_table_1(published, "shrimp"), hand_measured_covariance())
    np.testing.assert_allclose(np.sqrt(np.diag(covariance))[3:], [0.046, 0.034, 0.042], rtol=0, atol=0.001)


def test_representations_return(true_pose):
    np.testing.assert_allclose(pose.rotation_vector_pose(pose.euler_pose(true_pose)), true_pose, atol=1e-14)


def test_covariance_returns(true_pose, pose_covariance):
    euler = pose.euler_pose(true_pose)
    there = pose.euler_covariance(true_pose, pose_covariance)
    np.testing.assert_allclose(pose.rotation_vector_covariance(euler, there), pose_covariance, rtol=1e-11)


@pytest.mark.statistical
def test_covariance_is_that_of_converted_draws(true_pose, pose_covariance):
    n = 20_000
    small = pose_covariance * 1e-4  # sigmas below 2e-4 rad: the second order is below 1e-3 of the first
    draws = np.random.default_rng(3).multivariate_normal(true_pose, small, size=n)
    euler = Rotation.from_rotvec(draws[:, 3:]).as_euler("ZYX")[:, ::-1]
    converted = np.cov(np.hstack([draws[:, :3], euler]).T)
    expected = pose.euler_covariance(true_pose, small)
    diagonal = np.diag(expected)
    monte_carlo = np.sqrt((np.outer(diagonal, diagonal) + expected**2) / n)
    assert np.all(np.abs(converted - expected) < 4.5 * monte_carlo)


@pytest.mark.parametrize("wrong", [np.zeros(5), np.zeros((1, 6)), []])
def test_refuses_another_shape(wrong):
    with pytest.raises(InputError) as error:
        pose.check_pose(wrong, "start pose")
    expected = "expected shape (6,); give r_x, r_y, r_z (m) and theta (rad)"
    assert str(error.value) == f"start pose: found shape {np.shape(wrong)}, {expected}"


@pytest.mark.parametrize("number", [np.nan, np.inf])
def test_refuses_what_is_no_number(number):
    with pytest.raises(InputError) as error:
        pose.check_pose([0.0, 0.0, number, 0.0, 0.0, 0.0], "start pose")
    assert str(error.value) == (
        f"start pose: found [0.0, 0.0, {number}, 0.0, 0.0, 0.0], expected six finite numbers; "
        "replace what is not a number"
    )

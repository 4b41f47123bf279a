"""Pose distances against scipy's rotations, small-angle limits and Monte Carlo."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from scipy.stats import chi2, kstest

from linepose.errors import EstimationError
from linepose.geometry import distance

REFERENCE = np.array([0.19, -0.14, -0.79, -0.82, 0.74, -1.43])
SIGMA = np.array([0.03, 0.05, 0.06, 0.016, 0.018, 0.009])


def test_euclidean_distance_is_that_of_the_positions():
    other = REFERENCE + np.array([0.3, 0.0, -0.4, 1.0, 2.0, 3.0])
    assert distance.euclidean_distance_m(other, REFERENCE) == pytest.approx(0.5, rel=1e-14)


def test_geodesic_angle_agrees_with_scipy_magnitude():
    vectors = np.random.default_rng(1).uniform(-3, 3, (40, 2, 3))
    poses = np.concatenate([np.zeros((40, 2, 3)), vectors], axis=-1)
    expected = (Rotation.from_rotvec(vectors[:, 0]).inv() * Rotation.from_rotvec(vectors[:, 1])).magnitude()
    np.testing.assert_allclose(distance.geodesic_angle_rad(poses[:, 0], poses[:, 1]), expected, atol=1e-12)


def test_difference_is_the_left_rotation_that_leads_to_the_pose():
    turn = np.array([0.1, -0.2, 0.05])
    pose = np.concatenate([np.ones(3), (Rotation.from_rotvec(turn) * Rotation.from_rotvec(REFERENCE[3:])).as_rotvec()])
    np.testing.assert_allclose(
        distance.pose_difference(pose, REFERENCE), [*(1 - REFERENCE[:3]), *turn], rtol=0, atol=1e-14
    )


@pytest.mark.parametrize("short_of_pi", [1e-3, 1e-6, 1e-9])
def test_poses_on_both_sides_of_pi_are_near(short_of_pi):
    """Vectors (pi - e) n and -(pi - e) n differ by almost 2 pi; the rotations by 2 e."""
    axis = np.array([2.0, -1.0, 2.0]) / 3
    first = np.concatenate([np.zeros(3), (np.pi - short_of_pi) * axis])
    second = np.concatenate([np.zeros(3), -(np.pi - short_of_pi) * axis])
    assert distance.geodesic_angle_rad(first, second) == pytest.approx(2 * short_of_pi, abs=2e-15 * np.pi)
    along_axis = 0.01  # sigma; along the axis the small rotation equals the change of the vector
    sigmas = np.diag([1.0, 1, 1, along_axis, along_axis, along_axis]) ** 2
    assert distance.mahalanobis_distance(first, second, sigmas) == pytest.approx(
        2 * short_of_pi / along_axis, rel=1e-4, abs=1e-12
    )


def test_vector_beyond_pi_is_the_same_pose_as_its_short_form():
    axis = np.array([0.6, 0.0, 0.8])
    long = np.concatenate([REFERENCE[:3], (np.pi + 0.3) * axis])
    short = np.concatenate([REFERENCE[:3], -(np.pi - 0.3) * axis])
    assert distance.geodesic_angle_rad(long, short) == pytest.approx(0, abs=1e-14)


def test_small_difference_gives_the_mahalanobis_distance_of_the_parameters():
    """For d -> 0 the manifold's distance is the vector's, to first order in d: relative error below |d|."""
    random = np.random.default_rng(2)
    root = random.standard_normal((6, 6)) * 0.1
    covariance = root @ root.T + np.diag(SIGMA**2)
    change = 1e-6 * random.standard_normal(6)
    expected = np.sqrt(change @ np.linalg.solve(covariance, change))
    assert distance.mahalanobis_distance(REFERENCE + change, REFERENCE, covariance) == pytest.approx(expected, rel=1e-5)


@pytest.mark.parametrize("angle", [1.8, np.pi - 1e-3, np.pi + 1e-3])
def test_distance_does_not_depend_on_which_vector_names_the_rotation(angle):
    """The same estimate and covariance written with the long and the short rotation vector, also near pi."""
    axis = np.array([2.0, -1.0, 2.0]) / 3
    estimate = np.concatenate([REFERENCE[:3], angle * axis])
    flipped = np.concatenate([REFERENCE[:3], (angle - 2 * np.pi) * axis])
    small_covariance = np.diag([4.0, 5, 6, 1, 2, 3]) * 1e-4
    pose = estimate.copy()
    pose[3:] = (Rotation.from_rotvec([0.01, -0.02, 0.005]) * Rotation.from_rotvec(estimate[3:])).as_rotvec()

    def in_parameters(at):
        """Covariance of the rotation vector, its Jacobian by central differences of scipy's logarithm."""
        jacobian, h = np.eye(6), 1e-6
        for k in range(3):
            step = np.zeros(3)
            step[k] = h
            plus, minus = ((Rotation.from_rotvec(s * step) * Rotation.from_rotvec(at[3:])).as_rotvec() for s in (1, -1))
            sides = [v - 2 * np.pi * v / np.linalg.norm(v) if v @ at[3:] < 0 else v for v in (plus, minus)]
            jacobian[3:, 3 + k] = (sides[0] - sides[1]) / (2 * h)
        return jacobian @ small_covariance @ jacobian.T

    expected = np.sqrt(
        np.sum((pose[:3] - estimate[:3]) ** 2 / np.diag(small_covariance)[:3])
        + np.sum(np.array([0.01, -0.02, 0.005]) ** 2 / np.diag(small_covariance)[3:])
    )
    for name in (estimate, flipped):
        assert distance.mahalanobis_distance(pose, name, in_parameters(name)) == pytest.approx(expected, rel=1e-6)


def test_many_poses_at_once():
    poses = REFERENCE + SIGMA * np.random.default_rng(3).standard_normal((4, 5, 6))
    many = distance.mahalanobis_distance(poses, REFERENCE, np.diag(SIGMA**2))
    assert many.shape == (4, 5)
    one = distance.mahalanobis_distance(poses[2, 3], REFERENCE, np.diag(SIGMA**2))
    assert many[2, 3] == pytest.approx(float(one), rel=1e-13)


@pytest.mark.statistical
def test_p_values_of_pairs_of_estimates_are_uniform():
    """Two estimates of one pose, drawn with their covariances: Kolmogorov-Smirnov at the 0.1 % level, seed fixed."""
    random = np.random.default_rng(4)
    first_sigma, second_sigma = SIGMA, 1.7 * SIGMA
    values = [
        distance.p_value(
            distance.mahalanobis_between(
                REFERENCE + first_sigma * random.standard_normal(6),
                np.diag(first_sigma**2),
                REFERENCE + second_sigma * random.standard_normal(6),
                np.diag(second_sigma**2),
            )
        )
        for _ in range(1000)
    ]
    assert kstest(np.array(values), "uniform").pvalue > 1e-3


def test_p_value_is_the_chi_square_tail():
    assert distance.p_value(np.sqrt(chi2.ppf(0.95, 6))) == pytest.approx(0.05, rel=1e-9)


@pytest.mark.parametrize(
    "covariance",
    [np.zeros((6, 6)), np.ones((6, 6)), np.diag([1.0, 1, 1, 1, 1, np.nan]), np.diag([1.0, 1, 1, 1, 1, -1])],
    ids=["zero", "rank one", "not a number", "negative"],
)
def test_singular_covariance_is_one_clear_line(covariance):
    with pytest.raises(EstimationError, match="singular covariance") as caught:
        distance.mahalanobis_distance(REFERENCE, REFERENCE, covariance)
    assert "\n" not in str(caught.value)


def test_widely_different_units_are_not_singular():
    covariance = np.diag([1e-20, 1, 1, 1, 1, 1e10])
    assert np.isfinite(distance.mahalanobis_distance(REFERENCE, REFERENCE, covariance))

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.spatial.transform import Rotation

from linepose.geometry import rotations

RNG = np.random.default_rng(11)
AXES = RNG.normal(size=(20, 3))
AXES /= np.linalg.norm(AXES, axis=1, keepdims=True)
ANGLES_RAD = [0.0, 1e-12, 1e-8, 1e-5, 9.99e-4, 1.001e-3, 0.1, 1.0, 3.0, np.pi - 1e-7]
EULER_RAD = RNG.uniform([-3.0, -1.4, -3.0], [3.0, 1.4, 3.0], (40, 3))
STEP = 1e-30  # of the complex step: its square vanishes beside one


def cross_matrix(v):
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def plain_euler_matrix(euler):
    """Rz(yaw) Ry(pitch) Rx(roll), written out; complex angles allowed."""
    (cr, cp, cy), (sr, sp, sy) = np.cos(euler), np.sin(euler)
    rx = np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]])
    ry = np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
    rz = np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]])
    return rz @ ry @ rx


def small_rotation_of(derivative, matrix):
    """The vector w with dR = skew(w) R."""
    generator = derivative @ matrix.T
    return np.array([generator[2, 1], generator[0, 2], generator[1, 0]])


def by_complex_step(function, at):
    return np.stack([function(at + 1j * STEP * unit).imag / STEP for unit in np.eye(3)], axis=-1)


def test_skew_is_the_cross_product():
    a, b = RNG.normal(size=(2, 5, 3))
    np.testing.assert_array_equal(np.einsum("nij,nj->ni", rotations.skew(a), b).round(12), np.cross(a, b).round(12))


def test_euler_matrices_are_those_of_the_convention():
    expected = [plain_euler_matrix(euler) for euler in EULER_RAD]
    np.testing.assert_allclose(rotations.matrix_from_euler(EULER_RAD), expected, atol=1e-15)


def test_body_axes_of_a_single_turn():
    yawed, pitched, rolled = rotations.matrix_from_euler(np.deg2rad([[0, 0, 90], [0, 90, 0], [90, 0, 0]]))
    np.testing.assert_allclose(yawed @ [1, 0, 0], [0, 1, 0], atol=1e-15)  # bow from north to east
    np.testing.assert_allclose(pitched @ [1, 0, 0], [0, 0, -1], atol=1e-15)  # bow up
    np.testing.assert_allclose(rolled @ [0, 1, 0], [0, 0, 1], atol=1e-15)  # right side down


@pytest.mark.parametrize("angle_rad", ANGLES_RAD)
def test_rotation_vector_matrices_are_matrix_exponentials(angle_rad):
    for axis in AXES[:5]:
        expected = expm(angle_rad * cross_matrix(axis))
        np.testing.assert_allclose(rotations.matrix_from_rotation_vector(angle_rad * axis), expected, atol=4e-15)


@pytest.mark.parametrize("angle_rad", ANGLES_RAD)
def test_rotation_vector_returns_from_its_matrix(angle_rad):
    vectors = angle_rad * AXES
    back = rotations.rotation_vector_from_matrix(rotations.matrix_from_rotation_vector(vectors))
    np.testing.assert_allclose(back, vectors, atol=1e-14)


def test_half_turns_return_up_to_sign():
    vectors = np.pi * AXES
    back = rotations.rotation_vector_from_matrix(rotations.matrix_from_rotation_vector(vectors))
    sign = np.sign(np.sum(back * vectors, axis=1, keepdims=True))
    np.testing.assert_allclose(back * sign, vectors, atol=1e-7)  # at pi, the sine that tells the sign is rounding


def test_rotation_vector_is_never_longer_than_half_a_turn():
    back = rotations.rotation_vector_from_matrix(rotations.matrix_from_rotation_vector((np.pi + 0.2) * AXES))
    np.testing.assert_allclose(back, -(np.pi - 0.2) * AXES, atol=1e-14)


def test_euler_angles_return_from_matrix_and_rotation_vector():
    np.testing.assert_allclose(
        rotations.euler_from_matrix(rotations.matrix_from_euler(EULER_RAD)), EULER_RAD, atol=1e-13
    )
    vectors = rotations.rotation_vector_from_euler(EULER_RAD)
    np.testing.assert_allclose(rotations.euler_from_rotation_vector(vectors), EULER_RAD, atol=1e-13)


@pytest.mark.parametrize("angle_rad", ANGLES_RAD)
def test_angle_between_rotations_is_the_length_of_the_turn_between_them(angle_rad):
    first = rotations.matrix_from_euler(EULER_RAD[:20])
    second = first @ rotations.matrix_from_rotation_vector(angle_rad * AXES)
    np.testing.assert_allclose(rotations.rotation_angle_rad(first, second), angle_rad, atol=2e-14)


@pytest.mark.parametrize("angle_rad", ANGLES_RAD)
def test_left_jacobian_is_its_power_series(angle_rad):
    for axis in AXES[:5]:
        power, expected = np.eye(3), np.zeros((3, 3))
        for n in range(1, 40):  # pi^40 / 40! is below 1e-27
            expected += power
            power = power @ cross_matrix(angle_rad * axis) / (n + 1)
        # (1 - cos a) / a^2 at 1e-3 is known to eps / 1e-6, and counts with a: 1e-13
        np.testing.assert_allclose(rotations.left_jacobian_so3(angle_rad * axis), expected, rtol=0, atol=2e-13)


def test_euler_jacobian_is_the_complex_step_of_the_matrix():
    for euler in EULER_RAD:
        matrix = plain_euler_matrix(euler)
        expected = by_complex_step(lambda e, r=matrix: small_rotation_of(plain_euler_matrix(e), r), euler)
        np.testing.assert_allclose(rotations.small_rotation_by_euler(euler), expected, atol=1e-15)


def test_jacobians_between_representations_are_inverse_pairs():
    vectors = rotations.rotation_vector_from_euler(EULER_RAD)
    forth, back = rotations.rotation_vector_by_euler(EULER_RAD), rotations.euler_by_rotation_vector(vectors)
    np.testing.assert_allclose(forth @ back, np.broadcast_to(np.eye(3), (40, 3, 3)), atol=1e-12)


@pytest.mark.parametrize(
    "euler_rad", [*EULER_RAD[:5], np.array([1e-9, 0.0, -1e-9]), np.array([np.pi - 1e-4, 0.0, 0.0])]
)
def test_rotation_vector_by_euler_is_a_difference_quotient(euler_rad):
    step = 1e-5  # truncation step^2, rounding eps / step: both near 1e-10; near pi eps grows by 1e4 less than step
    expected = np.stack(
        [
            (
                Rotation.from_matrix(plain_euler_matrix(euler_rad + step * unit)).as_rotvec()
                - Rotation.from_matrix(plain_euler_matrix(euler_rad - step * unit)).as_rotvec()
            )
            / (2 * step)
            for unit in np.eye(3)
        ],
        axis=-1,
    )
    np.testing.assert_allclose(rotations.rotation_vector_by_euler(euler_rad), expected, atol=5e-9)


def test_leading_axes_pass_through():
    vectors = RNG.normal(size=(2, 3, 3))
    assert rotations.matrix_from_rotation_vector(vectors).shape == (2, 3, 3, 3)
    assert rotations.left_jacobian_so3(vectors).shape == (2, 3, 3, 3)
    assert rotations.rotation_vector_by_euler(vectors).shape == (2, 3, 3, 3)
    one = rotations.euler_by_rotation_vector(vectors[1, 2])
    np.testing.assert_allclose(rotations.euler_by_rotation_vector(vectors)[1, 2], one, atol=1e-15)

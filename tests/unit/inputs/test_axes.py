import numpy as np
from scipy.spatial.transform import Rotation

from linepose.geometry import rotations
from linepose.inputs import axes

EULER = np.array([0.2, -0.3, 2.5])


def test_a_vehicle_facing_east_and_level():
    """REP-103: facing east it is the identity; ours has a yaw of 90 degrees."""
    np.testing.assert_allclose(
        rotations.euler_from_matrix(axes.matrix_from_enu_flu(np.eye(3))), [0, 0, np.pi / 2], atol=1e-15
    )


def test_left_side_up_is_a_positive_roll_and_nose_up_a_positive_pitch():
    rolled = Rotation.from_euler("x", 0.1).as_matrix()  # about forward, right-handed: the left side goes up
    pitched = Rotation.from_euler("y", -0.1).as_matrix()  # about left, the nose goes up
    assert rotations.euler_from_matrix(axes.matrix_from_enu_flu(rolled))[0] > 0.09
    assert rotations.euler_from_matrix(axes.matrix_from_enu_flu(pitched))[1] > 0.09


def test_vectors_of_the_body_point_the_same_way():
    enu_flu = Rotation.random(random_state=np.random.default_rng(1)).as_matrix()
    ours = axes.matrix_from_enu_flu(enu_flu)
    forward, left = enu_flu[:, 0], enu_flu[:, 1]
    np.testing.assert_allclose(ours[:, 0], axes.ned_from_enu(forward), atol=1e-15)
    np.testing.assert_allclose(ours[:, 1], -axes.ned_from_enu(left), atol=1e-15)


def test_turned_covariance_is_that_of_turned_samples():
    """To first order: small samples of position and angles, turned one by one, have the turned covariance."""
    rng = np.random.default_rng(2)
    factor = 1e-5 * rng.normal(size=(6, 6))
    turn = Rotation.from_euler("ZYX", [0.7, 0.1, -0.2]).as_matrix()
    new, covariance = axes.turned((factor @ factor.T)[None], turn[None], EULER[None])
    steps = np.concatenate([factor.T, -factor.T])  # +- each column of the factor: their scatter is the covariance
    euler = rotations.euler_from_matrix(turn @ rotations.matrix_from_euler(EULER + steps[:, 3:]))
    changes = np.hstack([steps[:, :3] @ turn.T, euler - new[0]])
    np.testing.assert_allclose(covariance[0], changes.T @ changes / 2, atol=1e-4 * np.abs(covariance).max())

import numpy as np
import pytest

from linepose.errors import EstimationError, InputError
from linepose.estimation.identifiability import identifiability, in_body_axes, in_words
from linepose.geometry import rotations
from linepose.geometry.pose import POSE_COLUMNS

FURTHER = tuple(f"further_{k}" for k in range(5))
NAMES = ("r_z_m", "roll_rad", "focal_length_m")


def test_shrinkage_is_one_where_the_data_decide_and_zero_where_they_say_nothing():
    found = identifiability(NAMES, np.diag([1e-6, 0.25, 4.0]), [1.0, 1.0, 2.0])
    assert np.allclose(found.shrinkage, [1 - 1e-6, 0.75, 0.0], rtol=0, atol=1e-12)
    assert found.weakest_in_words() == "the focal length"
    assert found.weakest_shrinkage == pytest.approx(0.0, abs=1e-12)


def test_a_linear_model_gives_the_closed_form():
    """Observing only the sum of two parameters: the difference keeps its prior, and the sum shrinks."""
    prior = np.array([2.0, 2.0])
    noise = 0.1
    design = np.array([[1.0, 1.0]])
    posterior = np.linalg.inv(np.diag(prior**-2) + design.T @ design / noise**2)
    found = identifiability(("r_z_m", "roll_rad"), posterior, prior)
    assert found.weakest_shrinkage == pytest.approx(0.0, abs=1e-9)
    assert np.allclose(np.abs(found.weakest_direction), np.sqrt(0.5))
    assert found.weakest_in_words() in {"r_z against the turn about forward", "the turn about forward against r_z"}
    assert np.allclose(found.shrinkage, 0.5, atol=1e-3)
    assert found.correlation[0, 1] == pytest.approx(-1, abs=0.01)


def test_units_do_not_decide_the_weakest_direction():
    covariance = np.diag([0.01**2, 1e-3**2])
    prior = np.array([0.1, 2e-3])
    scale = np.array([1000.0, 1.0])
    metres = identifiability(NAMES[:2], covariance, prior)
    millimetres = identifiability(NAMES[:2], covariance * np.outer(scale, scale), prior * scale)
    assert np.allclose(metres.weakest_direction, millimetres.weakest_direction)
    assert metres.weakest_in_words() == "the turn about forward"


def test_words_name_the_notable_parts_largest_first():
    assert in_words(NAMES, [0.5, -0.8, 0.1]) == "the turn about forward against r_z"
    assert in_words(NAMES, [-0.6, -0.5, -0.5]) == "r_z with the turn about forward with the focal length"


def test_turns_about_the_body_axes_are_the_left_small_rotation():
    random = np.random.default_rng(1)
    parameters = random.normal(size=11)
    vector = parameters[3:6]
    jacobian = np.empty((3, 3))
    step = 1e-6
    for i in range(3):
        moved = [rotations.matrix_from_rotation_vector(vector + sign * step * np.eye(3)[i]) for sign in (1, -1)]
        jacobian[:, i] = rotations.rotation_vector_from_matrix(moved[0] @ moved[1].T) / (2 * step)
    root = random.normal(size=(11, 11))
    covariance = root @ root.T
    names, turned = in_body_axes((*POSE_COLUMNS, *FURTHER), parameters, covariance)
    full = np.eye(11)
    full[3:6, 3:6] = jacobian
    assert names[:7] == ("r_x_m", "r_y_m", "r_z_m", "roll_rad", "pitch_rad", "yaw_rad", "further_0")
    assert np.allclose(turned, full @ covariance @ full.T, rtol=1e-8, atol=1e-8)


def test_a_prior_without_width_is_refused():
    with pytest.raises(InputError, match="prior sigma"):
        identifiability(NAMES, np.eye(3), [1.0, np.inf, 1.0])


def test_a_covariance_of_too_few_samples_is_refused():
    with pytest.raises(EstimationError, match="longer chain"):
        identifiability(NAMES, np.outer([1.0, 2.0, 3.0], [1.0, 2.0, 3.0]) - 1e-9 * np.eye(3), np.ones(3))

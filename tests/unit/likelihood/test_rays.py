import numpy as np
import pytest

from linepose.geometry import rotations
from linepose.likelihood.rays import camera_axes


@pytest.mark.parametrize("angle", [0.0, 1e-9, 1e-4, 0.0099, 0.0101, 0.5, 3.0, np.pi, 6.0])  # the series ends at 0.01
def test_camera_axes_are_the_rotation_matrix(angle):
    vector = angle * np.array([2.0, -3.0, 6.0]) / 7
    axes = np.empty((3, 3))
    camera_axes(np.concatenate([np.zeros(3), vector]), axes)
    # A dozen roundings of numbers of size one.
    np.testing.assert_allclose(axes, rotations.matrix_from_rotation_vector(vector), rtol=0, atol=2e-15)

import numpy as np
import pytest

from linepose.geometry.plane import Plane
from linepose.output.figures.plane_view import plane_view


def test_a_plane_that_lies_is_drawn_as_a_map():
    view = plane_view(Plane(np.array([10.0, 20.0, 0.0]), np.array([0.0, 0.1, np.sqrt(0.99)])), np.zeros(3))
    np.testing.assert_allclose(view.flat([11.0, 22.0, 0.0]), [2.0, 1.0])  # east to the right, north up
    assert view.labels == ("East (m)", "North (m)")
    np.testing.assert_allclose(view.flat_covariance(np.diag([1.0, 4.0, 9.0])), np.diag([4.0, 1.0]))


@pytest.mark.parametrize(
    ("normal", "viewer", "right", "label"),
    [
        ([0.0, 1.0, 0.0], [0.0, -5.0, 0.0], [-1.0, 0.0, 0.0], "Towards south (m)"),  # seen from the west, looking east
        ([0.0, 1.0, 0.0], [0.0, 5.0, 0.0], [1.0, 0.0, 0.0], "Towards north (m)"),
        ([1.0, 0.0, 0.0], [-5.0, 0.0, 0.0], [0.0, 1.0, 0.0], "Towards east (m)"),
    ],
)
def test_a_plane_that_stands_is_drawn_as_its_viewer_sees_it(normal, viewer, right, label):
    view = plane_view(Plane(np.zeros(3), np.array(normal)), np.array(viewer))
    np.testing.assert_allclose(view.rightwards, right, atol=1e-12)
    np.testing.assert_allclose(view.upwards, [0.0, 0.0, -1.0], atol=1e-12)
    assert view.labels == (label, "Up (m)")

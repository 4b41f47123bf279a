"""The documentation's picture of frames and signs: the drawn arrows agree with the library's rotations."""

import numpy as np
from matplotlib.patches import FancyArrowPatch

from linepose.geometry.rotations import matrix_from_euler
from linepose.output.figures.conventions import conventions


def arrow_to(panel, name):
    """Direction of the arrow whose tip the label stands at."""
    label = next(text for text in panel.texts if text.get_text() == name)
    place = np.array(label.xy)
    tips = [np.array(patch._posA_posB[1]) for patch in panel.patches if isinstance(patch, FancyArrowPatch)]
    tip = min(tips, key=lambda one: np.linalg.norm(one - place))
    return tip / np.linalg.norm(tip)


def test_drawn_axes_turn_as_the_library_turns_them():
    """Seen from above east is to the right and north up; from behind right is right, from the right forward is."""
    above, behind, side, _ = conventions().axes
    yawed = matrix_from_euler([0, 0, np.deg2rad(35)])
    np.testing.assert_allclose(arrow_to(above, "x forward"), yawed[[1, 0], 0], atol=1e-12)
    np.testing.assert_allclose(arrow_to(above, "y right"), yawed[[1, 0], 1], atol=1e-12)
    rolled = matrix_from_euler([np.deg2rad(15), 0, 0])
    np.testing.assert_allclose(arrow_to(behind, "y right"), rolled[[1, 2], 1] * [1, -1], atol=1e-12)
    pitched = matrix_from_euler([0, np.deg2rad(15), 0])
    np.testing.assert_allclose(arrow_to(side, "x forward"), pitched[[0, 2], 0] * [1, -1], atol=1e-12)

"""Mean angles of whole observations."""

import numpy as np
import pytest

from linepose.survey.body_angles import body_angles_rad
from unit.experiments.conftest import make_survey


def test_body_angles_average_on_the_circle():
    """Headings of 179 and -179 deg average to 180, not to 0."""
    survey = make_survey(12)
    survey.euler_rad[0, :, 2] = np.radians(np.resize([179.0, -179.0], survey.n_points))
    survey.euler_rad[1, 0] = np.nan
    angles = body_angles_rad(survey)
    assert abs(angles[0, 2]) == pytest.approx(np.pi, abs=1e-12)
    np.testing.assert_allclose(angles[1], survey.euler_rad[1, 1], atol=1e-12)

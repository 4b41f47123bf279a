"""Whether the camera's numbers can be those of one, told by the keys that a person wrote."""

import numpy as np
import pytest

from linepose.check.camera import camera_findings
from linepose.check.finding import Level
from linepose.geometry.camera import Camera

SIZE = {"n_pixels": 648, "principal_point_px": 323.5}
PIXELS = np.arange(648.0)
ANGLES = np.linspace(-17, 17, 648)


def told(**values):
    """What is wrong with a camera."""
    return [one for one in camera_findings(Camera(**values), set(values)) if one.level > Level.OK]


def table(angles):
    return {"n_pixels": 648, "view_angles": {"pixel": PIXELS.tolist(), "across_deg": angles.tolist()}}


def test_a_lens_as_they_are_is_well():
    for values in (SIZE | {"field_of_view_deg": 34}, table(ANGLES), table(70 * np.sin(np.linspace(-1.5, 1.5, 648)))):
        assert not told(**values)
    straight = np.degrees(np.arctan(np.linspace(-2.7, 2.7, 648)))  # 140 deg without distortion
    assert not told(**table(straight))


@pytest.mark.parametrize("values", [SIZE | {"field_of_view_deg": 0.6}, table(np.deg2rad(ANGLES))])
def test_radians_are_asked_for_by_the_key_that_was_written(values):
    (finding,) = told(**values)
    key = "field_of_view_deg" if "field_of_view_deg" in values else "view_angles"
    assert finding.found.startswith(f"by camera.{key} the line sees 0.")
    assert finding.advice.startswith("if these are radians, give degrees (3")


@pytest.mark.parametrize("field_deg", [0.01, 179])
def test_a_field_of_view_that_none_has_is_told_by_its_key(field_deg):
    (finding,) = told(**SIZE, field_of_view_deg=field_deg)
    assert "field_of_view_deg" in finding.found
    assert "focal_length_m" not in finding.found + finding.advice


def test_a_wrong_unit_of_a_length_is_an_error():
    (finding,) = told(**SIZE, focal_length_m=8.2, pixel_pitch_m=8e-6)
    assert (finding.level, finding.found) == (Level.ERROR, "camera.focal_length_m is 8.2 m")


def test_a_step_in_the_table_is_told():
    stepped = np.where(PIXELS < 324, ANGLES, ANGLES + 20)
    (finding,) = [one for one in told(**table(stepped)) if "steps" in one.found]
    assert "across_deg steps by 20.1 deg from pixel 323 to 324" in finding.found


@pytest.mark.parametrize("bent", [{"tilt": 10.0}, {"smile": 1e6}])
def test_a_line_off_by_more_than_its_length_is_an_error(bent):
    findings = told(**SIZE, field_of_view_deg=34, **bent)
    assert [(one.level, "camera.tilt" in one.advice) for one in findings] == [(Level.ERROR, True)]
    (finding,) = told(**SIZE, field_of_view_deg=34, tilt=0.2)
    assert finding.level == Level.WARNING

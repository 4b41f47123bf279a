"""massipipe's equations, as its orthorectification.py (0.3.2) has them, lead to the ground points of our rays."""

import re
from dataclasses import replace

import numpy as np
import pytest
import yaml

from linepose.errors import InputError
from linepose.geometry.camera import Camera, rays
from linepose.geometry.pose import POSE_COLUMNS
from linepose.geometry.rotations import matrix_from_euler, rotation_vector_from_euler
from linepose.output.exports.massipipe import centred_fan
from linepose.pipeline.calibration import Calibration
from linepose.pipeline.results import Results
from unit import made_up

CENTRED = {"principal_point_px": 323.5}
PIXELS = np.array([0, 17, 323, 420, 647])
ALTITUDE_M = 2.0
BODIES_DEG = [(0.0, 0.0, 0.0), (6.0, 0.0, 40.0), (0.0, -7.0, 200.0), (-8.0, 5.0, -75.0), (12.0, 11.0, 310.0)]
LEVEL_DEG = [(0.0, 0.0, 0.0), (0.0, 0.0, 125.0)]
CAMERAS_DEG = [(1.5, -2.0, 90.0), (-3.0, 4.0, -88.0), (20.0, -15.0, 70.0)]
MILLIMETRE = 1e-3


@pytest.fixture
def exported(results, tmp_path):
    """What massipipe reads, the calibration, and the file's text: of a pose and a camera with these keys."""

    def export(euler_deg, position_m, **camera):
        given = Calibration.from_results(results / "made-up", made_up.platform())
        pose = [*position_m, *rotation_vector_from_euler(np.deg2rad(euler_deg))]
        poses = given.tables()["pose"].assign(**dict(zip(POSE_COLUMNS, pose, strict=True)))
        moved = Results("made-up", None, given.tables() | {"pose": poses})
        calibration = replace(given, results=moved, camera=given.camera.model_copy(update=camera))
        text = calibration.export("massipipe", tmp_path / "arguments.yaml").read_text()
        return yaml.safe_load(text), calibration, text

    return export


def turned(roll, pitch, yaw):
    """Rz(yaw) Ry(pitch) Rx(roll), as its guide writes the three."""
    x = np.array([[1, 0, 0], [0, np.cos(roll), -np.sin(roll)], [0, np.sin(roll), np.cos(roll)]])
    y = np.array([[np.cos(pitch), 0, np.sin(pitch)], [0, 1, 0], [-np.sin(pitch), 0, np.cos(pitch)]])
    z = np.array([[np.cos(yaw), -np.sin(yaw), 0], [np.sin(yaw), np.cos(yaw), 0], [0, 0, 1]])
    return z @ y @ x


def its_places(read, body_deg):
    """North and east (P, 2) of the pixels, of a body over the origin, by `CameraModel` and `orthorectify_image`."""
    right_wing_down, pitch, yaw = np.deg2rad(body_deg)
    log_roll = -right_wing_down  # Resonon's
    roll = log_roll if read["imu_roll_direction_is_right_wing_down"] else -log_roll
    edge = np.tan(read["camera_cross_track_fov"] / 2)
    assert 0 < read["camera_cross_track_fov"] < np.pi
    angles = np.arctan(np.linspace(-edge, edge, read["camera_cross_track_n_pixels"]))
    if not read["image_columns_increase_with_positive_y"]:
        angles = angles[::-1]
    camera = turned(roll, pitch, yaw) @ turned(*read["euler_imu_from_camera"])
    down = np.array([camera @ turned(angle, 0.0, 0.0) @ [0.0, 0.0, 1.0] for angle in angles[PIXELS]])
    assert np.all(down[:, 2] > 0)
    altitude = ALTITUDE_M + read["camera_altitude_correction"]
    return down[:, :2] * (altitude / down[:, 2])[:, None]


def our_places(calibration, body_deg):
    body = matrix_from_euler(np.deg2rad(body_deg))
    mounted = calibration.estimate.matrix
    centre, direction = rays(calibration.own_camera, mounted[:3, :3], mounted[:3, 3], body, np.zeros(3), PIXELS)
    return (centre + direction * ((ALTITUDE_M - centre[2]) / direction[:, 2])[:, None])[:, :2]


@pytest.mark.parametrize("euler_deg", CAMERAS_DEG)
@pytest.mark.parametrize("lens", [{}, {"tilt": 0.01}])
def test_places_are_ours_at_any_attitude(exported, euler_deg, lens):
    read, calibration, _ = exported(euler_deg, (0.0, 0.0, 0.0), **CENTRED, **lens)
    for body_deg in BODIES_DEG:
        np.testing.assert_allclose(its_places(read, body_deg), our_places(calibration, body_deg), atol=MILLIMETRE)


def test_what_it_has_no_place_for_is_told_in_metres(exported):
    """Level, altitude takes the arm's downward part; the rest is the shift that the file tells."""
    read, calibration, text = exported(CAMERAS_DEG[0], (0.3, -0.4, -0.8), **CENTRED)
    assert "places are 0.500 m off (0.3000 m forward, -0.4000 m right) where the vehicle is level" in text
    assert "euler_imu_from_camera" in text
    for body_deg in LEVEL_DEG:
        shift = (matrix_from_euler(np.deg2rad(body_deg)) @ [0.3, -0.4, 0.0])[:2]
        ours = our_places(calibration, body_deg)
        np.testing.assert_allclose(its_places(read, body_deg) + shift, ours, atol=MILLIMETRE)


@pytest.mark.parametrize("position_m", [(0.0, 0.0, -0.8), (0.3, -0.4, 0.5), (-0.3, 0.4, 0.5)])
def test_an_arm_of_a_vehicle_that_is_not_level_is_as_far_off_as_the_file_tells(exported, position_m):
    read, calibration, text = exported(CAMERAS_DEG[0], position_m, **CENTRED)
    (told,) = re.findall(r"level, and up to (\d\.\d{3}) m at a roll or pitch of 10 deg", text)
    off_m = [
        np.linalg.norm(our_places(calibration, body_deg) - its_places(read, body_deg), axis=1).max()
        for body_deg in [(10.0, 0.0, 0.0), (-10.0, 0.0, 50.0), (0.0, 10.0, 0.0), (0.0, -10.0, 170.0)]
    ]
    assert max(off_m) == pytest.approx(float(told), abs=MILLIMETRE)
    if position_m[:2] == (0.0, 0.0):
        assert float(told) == pytest.approx(0.8 * np.sin(np.deg2rad(10)), abs=0.01)  # 0.012 m of height at 27 deg


def test_a_lens_off_the_middle_is_as_far_off_as_the_file_tells(exported):
    read, calibration, text = exported(CAMERAS_DEG[0], (0.0, 0.0, 0.0), principal_point_px=328.5)
    assert "look within 0.27 px of where ours do" in text
    off_m = np.linalg.norm(its_places(read, BODIES_DEG[0]) - our_places(calibration, BODIES_DEG[0]), axis=1)
    pixel_m = ALTITUDE_M / calibration.own_camera.focal_length_px
    assert 0.2 * pixel_m < off_m.max() < 0.275 * pixel_m * 1.2  # a ray 19 deg off the vertical: 1 / cos^2 is 1.12


def test_it_refuses_what_massipipe_cannot_have(made, tmp_path):
    with pytest.raises(InputError, match="frd, which massipipe reads"):
        made.export("massipipe", tmp_path / "x.yaml", body_axes="flu")
    camera = Camera(focal_length_m=8.2e-3, pixel_pitch_m=7.4e-6, n_pixels=648, principal_point_px=323.5, smile=0.01)
    with pytest.raises(InputError, match=r"misses by .* px, expected 0\.5 px or less for massipipe"):
        centred_fan(camera, "made-up")

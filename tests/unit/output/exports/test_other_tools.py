"""Exports in other tools' words: each tool's documented equations take a pixel to the same ground point."""

import json
from xml.etree import ElementTree

import cv2
import numpy as np
import pytest
import yaml
from scipy.spatial.transform import Rotation

from linepose.errors import InputError
from linepose.geometry.camera import pixel_directions, rays
from linepose.output.exports.gref4hsi import line_camera
from linepose.pipeline.calibration import Calibration
from unit import made_up

BODY = Rotation.from_euler("ZYX", [40.0, -3.0, 5.0], degrees=True).as_matrix()
BODY_POSITION_M = np.array([10.0, -4.0, -1.5])
PIXELS = np.array([0, 100, 323, 647])
MILLIMETRE = 1e-3


def ground(centre, direction):
    """Where rays meet the plane two metres below the world's origin."""
    return centre + direction * ((2.0 - centre[2]) / direction[:, 2])[:, None]


def platform(**distortion):
    model = "adjustment" if {"tilt", "smile"} & set(distortion) else "published"
    return made_up.platform(camera=made_up.PLATFORM["camera"] | distortion, noise_model=model)


def own_camera(results, chosen):
    return Calibration.from_results(results / "made-up", chosen).own_camera


def ours(camera, matrix):
    centre, direction = rays(camera, matrix[:3, :3], matrix[:3, 3], BODY, BODY_POSITION_M, PIXELS)
    return ground(centre, direction)


def exported(results, chosen, name, folder):
    return Calibration.from_results(results / "made-up", chosen).export(name, folder / name)


@pytest.mark.parametrize("distortion", [{}, {"k1": -0.08, "k2": 0.02}])
def test_gref4hsi_lands_on_the_same_ground(made, results, tmp_path, distortion):
    chosen = platform(**distortion)
    root = ElementTree.parse(exported(results, chosen, "gref4hsi", tmp_path)).getroot()
    read = {element.tag: float(element.text) for element in root if isinstance(element.tag, str)}
    assert read["width"] == 648
    distance = np.arange(0, read["width"])[PIXELS] + 0.5 - read["cx"]
    polynomial = read["k1"] * distance**5 + read["k2"] * distance**3 + read["k3"] * distance**2
    x = distance / read["f"] - polynomial / read["f"]
    turn = Rotation.from_euler("ZYX", [read["rz"], read["ry"], read["rx"]]).as_matrix()
    direction = np.stack([x, 0 * x, 0 * x + 1], axis=1) @ turn.T @ BODY.T
    centre = BODY_POSITION_M + BODY @ [read["tx"], read["ty"], read["tz"]]
    np.testing.assert_allclose(
        ground(centre, direction), ours(own_camera(results, chosen), made.matrix), atol=MILLIMETRE
    )


def test_gref4hsi_refuses_what_its_reader_cannot_have(made, tmp_path):
    with pytest.raises(InputError, match="frd"):
        made.export("gref4hsi", tmp_path / "x.xml", body_axes="flu")
    for lens, said in (
        ({"k3": 300.0}, "miss by"),
        ({"k1": 40.0, "k2": -900.0}, "turns back on itself"),
        ({"smile": 0.01}, "lies .* px off a straight one, expected 0.1 px or less for gref4hsi"),
    ):
        with pytest.raises(InputError, match=said):
            line_camera(platform(**lens).camera, "made-up")


BENT = {"k1": -0.08, "k2": 0.02, "k3": 0.1, "p2": 0.003, "smile": 0.004}


def test_kalibr_has_brown_s_distortion_or_is_refused(results, tmp_path):
    """Radtan has no k3: one that the others make good is fitted, another refused, as is a tilted line."""
    few = {name: BENT[name] for name in ("k1", "k2", "p2", "smile")}
    for lens in (few, BENT):
        camera = own_camera(results, platform(**lens))
        read = yaml.safe_load(exported(results, platform(**lens), "kalibr", tmp_path).read_text())["cam0"]
        focal, _, centre, _ = read["intrinsics"]
        k1, k2, p1, p2 = read["distortion_coeffs"]
        x, y, _ = pixel_directions(camera, PIXELS).T
        radial = 1 + k1 * (x**2 + y**2) + k2 * (x**2 + y**2) ** 2
        u = focal * (x * radial + 2 * p1 * x * y + p2 * (3 * x**2 + y**2)) + centre
        v = focal * (y * radial + p1 * (x**2 + 3 * y**2) + 2 * p2 * x * y)
        np.testing.assert_allclose(u, PIXELS, atol=0.1)
        np.testing.assert_allclose(v, 0, atol=0.1)
    for lens in ({"k3": 300.0}, {"tilt": 0.01}):
        with pytest.raises(InputError, match="a lens that k1, k2, p1, p2 miss by"):
            exported(results, platform(**lens), "kalibr", tmp_path)


@pytest.mark.parametrize("distortion", [{}, {"k1": -0.08, "k2": 0.02}, BENT])
def test_camera_info_lands_on_the_same_ground(made, results, tmp_path, distortion):
    chosen = platform(**distortion)
    read = yaml.safe_load(exported(results, chosen, "camera_info", tmp_path).read_text())

    def array(key):
        return np.array(read[key]["data"]).reshape(read[key]["rows"], read[key]["cols"])

    assert (read["image_width"], read["image_height"]) == (648, 1)
    assert read["distortion_model"] == "plumb_bob"
    seen = np.stack([PIXELS, 0 * PIXELS], axis=1).astype(float)[:, None]
    criteria = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 50, 1e-12)
    ideal = cv2.undistortPoints(
        seen,
        array("camera_matrix"),
        array("distortion_coefficients"),
        R=array("rectification_matrix"),
        P=array("projection_matrix"),
        criteria=criteria,
    )[:, 0]
    in_camera = np.column_stack([ideal, np.ones(len(ideal))]) @ np.linalg.inv(array("projection_matrix")[:, :3]).T
    direction = in_camera @ made.matrix[:3, :3].T @ BODY.T
    centre = BODY_POSITION_M + BODY @ made.matrix[:3, 3]
    np.testing.assert_allclose(
        ground(centre, direction), ours(own_camera(results, chosen), made.matrix), atol=MILLIMETRE
    )


def test_exports_of_an_adjustment_have_the_camera_that_belongs_to_the_pose(tmp_path):
    """And not the file's, four pixels off: the pose was found with the adjusted one."""
    made_up.write_adjusted_results(tmp_path / "made-up")
    calibration = Calibration.from_results(tmp_path / "made-up", made_up.adjusted_platform())
    info = yaml.safe_load(calibration.export("camera_info", tmp_path / "info").read_text())
    np.testing.assert_allclose(info["camera_matrix"]["data"][:3], [8.25e-3 / 7.4e-6, 0, 327.0])
    camchain = yaml.safe_load(calibration.export("kalibr", tmp_path / "kalibr").read_text())
    np.testing.assert_allclose(camchain["cam0"]["intrinsics"][::2], [8.25e-3 / 7.4e-6, 327.0])
    gref = ElementTree.parse(calibration.export("gref4hsi", tmp_path / "gref")).getroot()
    assert float(gref.findtext("cx")) == 327.5
    told = json.loads(calibration.export("json", tmp_path / "json").read_text())["camera"]
    assert (told["principal_point_px"], told["is_adjusted"]) == (327.0, True)
    assert "principal point 327.000 px" in calibration.export("urdf", tmp_path / "urdf").read_text()

"""Each format of the pose read back by a program that is not ours."""

import argparse
import json
import shlex

import numpy as np
import pandas as pd
import pytest
import yaml
from pytransform3d.urdf import UrdfTransformManager
from scipy.spatial.transform import Rotation

from linepose.geometry.pose import POSE_COLUMNS
from linepose.pipeline.calibration import HAND_MEASURED, Calibration
from linepose.pipeline.results import Results
from unit import made_up

FLU = np.diag([1.0, -1.0, -1.0, 1.0])
CLOSE = {"rtol": 0, "atol": 1e-9}


def test_urdf_joint_is_the_pose_in_the_axes_of_ros(made, tmp_path):
    robot = UrdfTransformManager()
    robot.load_urdf(made.export("urdf", tmp_path / "camera.urdf").read_text())
    transform = robot.get_transform("line_camera_optical", "base_link")
    np.testing.assert_allclose(transform, FLU @ made.matrix, **CLOSE)


def test_urdf_in_our_axes_and_with_other_names(made, tmp_path):
    names = {"parent_frame": "imu/body", "child_frame": "scanner", "body_axes": "frd"}
    text = made.export("urdf", tmp_path / "camera.urdf", **names).read_text()
    robot = UrdfTransformManager()
    robot.load_urdf(text)
    np.testing.assert_allclose(robot.get_transform("scanner", "imu/body"), made.matrix, **CLOSE)
    assert "x forward, y right, z down" in text
    assert "Converted" not in text


@pytest.mark.parametrize("pitch_deg", [90.0, -90.0, 105.0])
def test_urdf_holds_the_rotation_where_roll_and_yaw_are_one(tmp_path, pitch_deg):
    expected = np.eye(4)
    expected[:3, :3] = Rotation.from_euler("ZYX", [-90.0, pitch_deg, 10.0], degrees=True).as_matrix()
    pose = np.concatenate([np.zeros(3), Rotation.from_matrix(expected[:3, :3]).as_rotvec()])
    poses = made_up.pose().query("stage == @HAND_MEASURED").copy()
    poses[list(POSE_COLUMNS)] = pose
    by_hand, camera = made_up.platform().hand_measured, made_up.platform().camera
    results = Results("x", in_memory={"pose": poses})
    Calibration(results, by_hand, camera, 5.0, "published", HAND_MEASURED).export("urdf", tmp_path, body_axes="frd")
    robot = UrdfTransformManager()
    robot.load_urdf((tmp_path / "x.urdf").read_text())
    np.testing.assert_allclose(robot.get_transform("line_camera_optical", "base_link"), expected, **CLOSE)


def test_ros2_parameters_and_launch_line_are_the_same_pose(made, tmp_path):
    text = made.export("ros2", tmp_path / "transform.yaml").read_text()
    parameters = yaml.safe_load(text)["/**"]["ros__parameters"]
    assert (parameters["frame_id"], parameters["child_frame_id"]) == ("base_link", "line_camera_optical")
    transform = np.eye(4)
    transform[:3, 3] = [parameters["translation"][axis] for axis in "xyz"]
    transform[:3, :3] = Rotation.from_quat([parameters["rotation"][axis] for axis in "xyzw"]).as_matrix()
    np.testing.assert_allclose(transform, FLU @ made.matrix, **CLOSE)

    (line,) = [line for line in text.splitlines() if "static_transform_publisher" in line]
    words = shlex.split(line.removeprefix("# "))
    assert words[:4] == ["ros2", "run", "tf2_ros", "static_transform_publisher"]
    parser = argparse.ArgumentParser()
    for name in ("x", "y", "z", "qx", "qy", "qz", "qw"):
        parser.add_argument(f"--{name}", type=float)
    parser.add_argument("--frame-id")
    parser.add_argument("--child-frame-id")
    read = parser.parse_args(words[4:])
    np.testing.assert_allclose([read.x, read.y, read.z], transform[:3, 3], **CLOSE)
    launched = Rotation.from_quat([read.qx, read.qy, read.qz, read.qw]).as_matrix()
    np.testing.assert_allclose(launched, transform[:3, :3], **CLOSE)
    assert (read.frame_id, read.child_frame_id) == ("base_link", "line_camera_optical")


def test_kalibr_takes_the_body_to_the_camera(made, tmp_path):
    camera = yaml.safe_load(made.export("kalibr", tmp_path / "chain.yaml").read_text())["cam0"]
    np.testing.assert_allclose(np.array(camera["T_cam_imu"]) @ made.matrix, np.eye(4), **CLOSE)
    # a point one metre ahead on the optical axis, in the body frame, lands on the principal point
    in_body = made.matrix @ [0.0, 0.0, 1.0, 1.0]
    x, _, z, _ = np.array(camera["T_cam_imu"]) @ in_body
    focal, _, principal, _ = camera["intrinsics"]
    assert focal * x / z + principal == pytest.approx(323.0, abs=1e-9)
    assert camera["resolution"] == [648, 1]
    assert camera["intrinsics"][0] == pytest.approx(8.2e-3 / 7.4e-6, rel=1e-12)


def test_json_says_the_same_rotation_in_four_ways(made, tmp_path):
    read = json.loads(made.export("json", tmp_path / "pose.json").read_text())
    np.testing.assert_allclose(read["matrix"], made.matrix, **CLOSE)
    rotation = made.matrix[:3, :3]
    turned = Rotation.from_quat(read["quaternion_wxyz"], scalar_first=True)
    np.testing.assert_allclose(turned.as_matrix(), rotation, **CLOSE)
    np.testing.assert_allclose(Rotation.from_rotvec(read["rotation_vector_rad"]).as_matrix(), rotation, **CLOSE)
    np.testing.assert_allclose(Rotation.from_euler("xyz", read["euler_rad"]).as_matrix(), rotation, **CLOSE)
    np.testing.assert_allclose(read["covariance"], made.covariance, rtol=1e-12, atol=1e-18)
    assert read["parameters"] == list(POSE_COLUMNS)
    assert read["stage"] == "inliers"
    assert read["n_observations"] == 4


def test_covariance_in_the_axes_of_ros_is_that_of_samples_there(made, tmp_path):
    """Against samples that are converted one by one; first order is off by the spread squared, 2e-4."""
    read = json.loads(made.export("json", tmp_path / "pose.json", body_axes="flu").read_text())
    samples = np.array(made_up.samples()[list(POSE_COLUMNS)])
    vectors = Rotation.from_matrix(FLU[:3, :3] @ Rotation.from_rotvec(samples[:, 3:]).as_matrix()).as_rotvec()
    # near pi the vector may flip its sign: taken on the side of the exported one
    turn = np.linalg.norm(vectors, axis=1)
    flipped = vectors @ read["rotation_vector_rad"] < 0
    vectors[flipped] *= (1 - 2 * np.pi / turn[flipped])[:, None]
    expected = np.cov(np.hstack([samples[:, :3] * [1, -1, -1], vectors]).T)
    sigma = np.sqrt(np.diag(expected))
    np.testing.assert_allclose(
        read["covariance"] / np.outer(sigma, sigma), expected / np.outer(sigma, sigma), atol=0.01
    )


def test_csv_has_a_row_for_each_parameter(made, tmp_path):
    table = pd.read_csv(made.export("csv", tmp_path / "pose.csv"))
    assert table["parameter"].tolist() == list(POSE_COLUMNS)
    np.testing.assert_allclose(table["value"], made_up.OPTIMUM, **CLOSE)
    covariance = table[[f"covariance_{name}" for name in POSE_COLUMNS]].to_numpy()
    np.testing.assert_allclose(covariance, made.covariance, rtol=1e-12)
    np.testing.assert_allclose(table["sigma"], np.sqrt(np.diag(made.covariance)), rtol=1e-12)


def test_hand_measured_pose_brings_its_own_covariance(made, tmp_path):
    read = json.loads(made.export("json", tmp_path / "pose.json", stage="hand_measured").read_text())
    np.testing.assert_allclose(read["covariance"], made.platform.start_covariance(), rtol=1e-12, atol=1e-18)
    pose = [*read["position_m"], *read["rotation_vector_rad"]]
    np.testing.assert_allclose(pose, made.platform.start_pose(), **CLOSE)

import re

import numpy as np
import pandas as pd
import pytest
from scipy.spatial.transform import Rotation

from linepose.errors import InputError
from linepose.inputs import axes
from linepose.inputs.navigation import read_navigation
from linepose.inputs.navigation.novatel import NovatelSection
from linepose.inputs.navigation.rosbag import RosbagSection
from linepose.survey.navigation_log import POSE_AT, associate_poses
from unit.inputs import writers
from unit.inputs.drive import ORIGIN

IDENTITY = [0.0, 0.0, 0.0, 1.0]
COVARIANCE = np.eye(6) * 1e-4
SMALL = np.diag([1e-4, 2e-4, 3e-4])


def section(**keys):
    return RosbagSection(format="rosbag", **({"file": "run.bag"} | keys))


def write_fixes(path, drive, *, quaternion=IDENTITY, orientation=SMALL, step=5, status=0, kind=3, ros=1):
    with writers.Bag(path, ros) as bag:
        for row, time in enumerate(drive.time_us):
            bag.imu("/imu", time, quaternion, orientation)
            if row % step == 0:
                bag.fix("/fix", time, drive.geodetic[row], SMALL, status, kind)


def write_odometry(path, drive, topics=("/odometry",), quaternion=IDENTITY, covariance=COVARIANCE, rows=20):
    with writers.Bag(path, 1) as bag:
        for time in drive.time_us[:rows]:
            for topic in topics:
                bag.odometry(topic, time, [1.0, 2.0, 3.0], quaternion, covariance)


def test_odometry_of_one_topic_among_several(tmp_path, drive):
    write_odometry(tmp_path / "run.bag", drive, ("/wheels", "/fused"))
    record = read_navigation(section(odometry_topic="/fused"), tmp_path)
    np.testing.assert_allclose(record.log.position_m[0], [2.0, 1.0, -3.0])
    np.testing.assert_allclose(record.log.euler_rad[0], [0, 0, np.pi / 2], atol=1e-15)


def test_unknown_covariances_are_none(tmp_path, drive):
    write_odometry(tmp_path / "run.bag", drive, covariance=np.zeros((6, 6)))
    assert read_navigation(section(), tmp_path).covariances is None
    write_fixes(tmp_path / "fixes.bag", drive, kind=0)
    assert read_navigation(section(file="fixes.bag"), tmp_path).covariances is None


def test_covariance_of_roll_pitch_yaw_is_taken_as_it_is(tmp_path, drive):
    write_fixes(tmp_path / "run.bag", drive, quaternion=[0.0, 0.0, 0.6, 0.8])
    keys = {"origin": (*drive.geodetic[0],)}
    taken = read_navigation(section(orientation_covariance="roll_pitch_yaw", **keys), tmp_path).covariances
    np.testing.assert_allclose(taken.covariance[0, 3:, 3:], SMALL, atol=1e-9)
    turned = read_navigation(section(**keys), tmp_path).covariances  # level, facing 73.7 deg left of east
    assert turned.covariance[0, 3, 3] == pytest.approx(1e-4 * 0.28**2 + 2e-4 * 0.96**2, rel=1e-5)


def test_position_is_not_interpolated_over_a_gap(tmp_path, drive):
    write_fixes(tmp_path / "run.bag", drive, step=20)
    with pytest.raises(
        InputError, match=r"run.bag, sensor_msgs/msg/Imu: found no message between two fixes at most 1.5 s apart"
    ):
        read_navigation(section(), tmp_path)
    assert len(read_navigation(section(maximum_fix_gap_s=2.0), tmp_path).log.time_us) == 101


def test_folder_of_ros_2_is_watched_file_by_file(tmp_path, drive):
    write_fixes(tmp_path / "run", drive, ros=2)
    files = section(file="run").files(tmp_path)
    assert {path.suffix for path in files} == {".db3", ".yaml"}
    by_file = read_navigation(section(file="run/*.db3", origin=ORIGIN), tmp_path)
    by_folder = read_navigation(section(file="run", origin=ORIGIN), tmp_path)
    np.testing.assert_array_equal(by_file.log.position_m, by_folder.log.position_m)


def no_fix(path, drive):
    write_fixes(path, drive, status=-1)


def no_orientation(path, drive):
    write_fixes(path, drive, orientation=np.diag([-1.0, 0, 0]))


def zero_quaternion(path, drive):
    write_odometry(path, drive, quaternion=[0.0, 0.0, 0.0, 0.0])


def two_topics(path, drive):
    write_odometry(path, drive, ("/a", "/b"))


def repeated_times(path, drive):
    with writers.Bag(path, 1) as bag:
        for row in range(3):
            bag.odometry("/odometry", drive.time_us[0], [row, 0, 0], IDENTITY, np.eye(6))


def cut(path, drive):
    write_odometry(path, drive, rows=100)
    path.write_bytes(path.read_bytes()[:-700])


def text(path, _):
    path.write_text("time,north\n" * 40)


@pytest.mark.parametrize(
    ("write", "told"),
    [
        (no_fix, r"run.bag, sensor_msgs/msg/NavSatFix: found 0 messages with a fix, expected two or more"),
        (no_orientation, r"found messages without orientation \(orientation_covariance\[0\] is -1\)"),
        (zero_quaternion, r"nav_msgs/msg/Odometry, message 1: found orientation 0, 0, 0, 0, expected a quaternion of"),
        (two_topics, r"found 2 topics of nav_msgs/msg/Odometry \(/a, /b\).*set source.navigation.odometry_topic"),
        (repeated_times, r"record 2: found time .*, expected a time after the record before it"),
        (cut, r"run.bag: found .*, expected a whole ROS 1 or ROS 2 bag; restore the bag, or repair its index"),
        (text, r"run.bag: found bytes that begin no .bag, expected a whole ROS 1 or ROS 2 bag; restore the bag"),
    ],
)
def test_broken_bag_is_one_line(tmp_path, drive, write, told):
    write(tmp_path / "run.bag", drive)
    with pytest.raises(InputError, match=told) as error:
        read_navigation(section(), tmp_path)
    assert "\n" not in str(error.value)


def test_topic_that_is_not_there_is_told(tmp_path, drive):
    write_odometry(tmp_path / "run.bag", drive)
    with pytest.raises(InputError, match=r"found no topic /odom of nav_msgs/msg/Odometry, expected one of /odometry"):
        read_navigation(section(odometry_topic="/odom"), tmp_path)


def write_with_a_lost_fix(path, drive):
    """Fixes once a second, of which one is missing."""
    with writers.Bag(path, 1) as bag:
        for row, time in enumerate(drive.time_us[:61]):
            bag.imu("/imu", time, IDENTITY, SMALL)
            if row % 10 == 0 and row != 30:
                bag.fix("/fix", time, drive.geodetic[row], SMALL, 0, 3)


def test_poses_around_a_lost_fix_are_counted_and_the_advice_helps(tmp_path, drive, caplog):
    write_with_a_lost_fix(tmp_path / "run.bag", drive)
    log = read_navigation(section(), tmp_path).log
    assert len(log.time_us) == 61 - 19
    assert re.search(
        r"19 of 61 poses .* fixes around them are 2.000 s apart, more than 1.5 s; .* raise source", caplog.text
    )
    points = pd.DataFrame({"time_us": [drive.time_us[30]], "observation": [1], "point": [0]})
    with pytest.raises(InputError, match=r"a gap of 2.* s .* or raise source.navigation.maximum_fix_gap_s"):
        associate_poses(points, log, POSE_AT["interpolate"], 0.15)
    log = read_navigation(section(maximum_fix_gap_s=2.5), tmp_path).log
    assert len(log.time_us) == 61
    associate_poses(points, log, POSE_AT["interpolate"], 0.15)


@pytest.mark.parametrize("shift_us", [0, 20_000, -20_000])
def test_position_goes_on_for_a_moment_at_the_ends(tmp_path, drive, shift_us):
    with writers.Bag(tmp_path / "run.bag", 1) as bag:
        for row, time in enumerate(drive.time_us[:11]):
            bag.imu("/imu", time + shift_us, IDENTITY, SMALL)
            bag.fix("/fix", time, (-33.9, 151.2, 40.0 + row), SMALL, 0, 3)
    log = read_navigation(section(), tmp_path).log
    assert len(log.time_us) == 11
    np.testing.assert_allclose(-np.diff(log.position_m[:, 2]), 1.0, atol=1e-6)


def test_faulty_records_are_left_out_and_counted(tmp_path, drive, caplog):
    with writers.Bag(tmp_path / "run.bag", 1) as bag:
        for row, time in enumerate(drive.time_us[:20]):
            for _ in range(1 + (row == 7)):
                bag.imu("/imu", time, {3: [0.0] * 4, 4: [np.nan] * 4}.get(row, IDENTITY), SMALL)
            for _ in range(1 + (row == 5)):
                bag.fix("/fix", time, drive.geodetic[row] if row else [np.nan] * 3, SMALL, 0, 3)
    log = read_navigation(section(), tmp_path).log
    np.testing.assert_array_equal(log.time_us, drive.time_us[[1, 2, *range(5, 20)]])
    assert "NavSatFix: 1 records without a value are left out; 1 records that repeat" in caplog.text
    assert "Imu: 2 of 21 messages with an orientation of zeros or no numbers are left out" in caplog.text
    assert "Imu: 1 records that repeat the one before are passed over" in caplog.text


@pytest.mark.parametrize("covariance", [None, COVARIANCE])
def test_poses_with_a_stamp(tmp_path, drive, covariance):
    with writers.Bag(tmp_path / "run.bag", 1) as bag:
        for time in drive.time_us[:5]:
            bag.pose("/pose", time, [1.0, 2.0, 3.0], [0.0, 0.0, 0.0, 1.0], covariance)
    record = read_navigation(section(), tmp_path)
    np.testing.assert_allclose(record.log.position_m[0], [2.0, 1.0, -3.0])
    np.testing.assert_allclose(record.log.euler_rad[0], [0, 0, np.pi / 2], atol=1e-15)
    assert (record.covariances is None) == (covariance is None)
    ned = read_navigation(section(pose_topic="/pose", attitude_axes="ned"), tmp_path)
    np.testing.assert_allclose(ned.log.position_m[0], [1.0, 2.0, 3.0])
    np.testing.assert_allclose(ned.log.euler_rad[0], 0, atol=1e-15)


def test_orientation_in_north_east_down(tmp_path, drive):
    """Roll 2, pitch 5, heading 40 deg; its covariance is of small turns about north, east, down."""
    quaternion = Rotation.from_euler("ZYX", [40, 5, 2], degrees=True).as_quat()
    write_fixes(tmp_path / "run.bag", drive, quaternion=quaternion)
    keys = {"attitude_axes": "ned", "origin": (*drive.geodetic[0],)}
    record = read_navigation(section(**keys), tmp_path)
    np.testing.assert_allclose(np.rad2deg(record.log.euler_rad[0]), [2, 5, 40], atol=1e-9)
    by_turns = axes.euler_by_small_rotation(record.log.euler_rad[0])
    np.testing.assert_allclose(record.covariances.covariance[0, 3:, 3:], by_turns @ SMALL @ by_turns.T, rtol=1e-6)
    taken = read_navigation(section(orientation_covariance="roll_pitch_yaw", **keys), tmp_path).covariances
    np.testing.assert_allclose(taken.covariance[0, 3:, 3:], SMALL, atol=1e-9)


@pytest.mark.devices
def test_bag_of_the_novatel_driver_says_what_the_receiver_logged(samples):
    """Times are the headers' of the replay, a year later; the poses are the log's."""
    keys = {"format": "rosbag", "file": "novatel/ins2.bag", "frame": "projected"}
    bag = read_navigation(RosbagSection(**keys), samples)
    log = read_navigation(
        NovatelSection(format="novatel", file="novatel/ins2.gps", poses="INSPVAX", frame="projected"), samples
    )
    np.testing.assert_array_equal(bag.log.position_m, log.log.position_m[: len(bag.log.time_us)])
    np.testing.assert_allclose(bag.log.euler_rad, log.log.euler_rad[: len(bag.log.time_us)], atol=1e-15)
    assert bag.covariances is not None

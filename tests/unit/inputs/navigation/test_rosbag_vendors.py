"""Messages of vendors' drivers and tf, written with made-up values."""

import numpy as np
import pytest
from rosbags.typesys import get_types_from_msg
from scipy.spatial.transform import Rotation

from linepose.errors import InputError
from linepose.inputs.navigation import read_navigation
from linepose.inputs.navigation.rosbag import RosbagSection
from linepose.settings import validated
from unit.inputs import writers
from unit.inputs.drive import ORIGIN

STATUS = "bool attitude_valid\nbool heading_valid\nbool position_valid"
HEADER = "std_msgs/Header header\n"
SBG_NAV = HEADER + (
    "float64 latitude\nfloat64 longitude\nfloat64 altitude\nfloat32 undulation\n"
    "geometry_msgs/Vector3 position_accuracy\nsbg_driver/SbgEkfStatus status"
)
OLD_SBG_NAV = HEADER + (
    "geometry_msgs/Vector3 position\nfloat32 undulation\ngeometry_msgs/Vector3 position_accuracy\n"
    "sbg_driver/SbgEkfStatus status"
)
DEFINITIONS = {
    "sbg_driver/msg/SbgEkfStatus": STATUS,
    "sbg_driver/msg/SbgEkfEuler": HEADER
    + "geometry_msgs/Vector3 angle\ngeometry_msgs/Vector3 accuracy\nsbg_driver/SbgEkfStatus status",
    "gps_common/msg/GPSStatus": "int16 status",
    "gps_common/msg/GPSFix": HEADER
    + "gps_common/GPSStatus status\nfloat64 latitude\nfloat64 longitude\nfloat64 altitude\n"
    "float64[9] position_covariance\nuint8 position_covariance_type",
    "applanix_msgs/msg/LLA": "float64 latitude\nfloat64 longitude\nfloat64 altitude",
    "applanix_msgs/msg/NavigationSolutionGsof49": HEADER
    + "applanix_msgs/LLA lla\nfloat64 roll\nfloat64 pitch\nfloat64 heading",
    "tf2_msgs/msg/TFMessage": "geometry_msgs/TransformStamped[] transforms",
}
SMALL = np.diag([1e-4, 4e-4, 9e-4])


class VendorBag(writers.Bag):
    def __init__(self, path, definitions=DEFINITIONS):
        super().__init__(path, 1)
        for name, text in definitions.items():
            if name not in self.store.types:
                self.store.register(get_types_from_msg(text, name))

    def vector(self, *values):
        return self.type("geometry_msgs/msg/Vector3")(*(float(one) for one in values))

    def gps_fix(self, topic, time_us, geodetic, status=0):
        kind = "gps_common/msg/GPSFix"
        told = self.type("gps_common/msg/GPSStatus")(status)
        place = (float(one) for one in geodetic)
        self.write(topic, kind, time_us, self.type(kind)(self.header(time_us), told, *place, SMALL.ravel(), 3))

    def sbg_nav(self, time_us, geodetic, is_old, valid=True):
        kind, status = "sbg_driver/msg/SbgEkfNav", self.type("sbg_driver/msg/SbgEkfStatus")(True, True, valid)
        latitude, longitude, height = geodetic
        place = [self.vector(latitude, longitude, height - 22)] if is_old else [latitude, longitude, height - 22.0]
        message = self.type(kind)(self.header(time_us), *place, 22.0, self.vector(0.01, 0.02, 0.03), status)
        self.write("/sbg/ekf_nav", kind, time_us, message)

    def sbg_euler(self, time_us, euler_rad, valid=True):
        kind, status = "sbg_driver/msg/SbgEkfEuler", self.type("sbg_driver/msg/SbgEkfStatus")(True, valid, True)
        message = self.type(kind)(self.header(time_us), self.vector(*euler_rad), self.vector(1e-3, 2e-3, 3e-3), status)
        self.write("/sbg/ekf_euler", kind, time_us, message)

    def gsof49(self, time_us, geodetic, angles_deg):
        kind = "applanix_msgs/msg/NavigationSolutionGsof49"
        place = self.type("applanix_msgs/msg/LLA")(*(float(one) for one in geodetic))
        message = self.type(kind)(self.header(time_us), place, *(float(one) for one in angles_deg))
        self.write("/lvx_client/gsof/ins_solution_49", kind, time_us, message)

    def transform(self, time_us, parent, child, position, quaternion, topic="/tf"):
        kind, header = "tf2_msgs/msg/TFMessage", self.header(time_us)
        header.frame_id = parent
        turn = self.type("geometry_msgs/msg/Quaternion")(*(float(one) for one in quaternion))
        one = self.type("geometry_msgs/msg/Transform")(self.vector(*position), turn)
        stamped = self.type("geometry_msgs/msg/TransformStamped")(header, child, one)
        self.write(topic, kind, time_us, self.type(kind)([stamped]))


def read(folder, **keys):
    section = validated(RosbagSection, {"format": "rosbag", "file": "run.bag"} | keys, "source.navigation")
    return read_navigation(section, folder)


def quaternion(roll, pitch, yaw):
    return Rotation.from_euler("ZYX", [yaw, pitch, roll], degrees=True).as_quat()


def test_gps_fix_stands_for_a_nav_sat_fix(tmp_path, drive, caplog):
    with VendorBag(tmp_path / "run.bag") as bag:
        for row, time in enumerate(drive.time_us[:11]):
            bag.imu("/imu", time, quaternion(0, 0, 0), SMALL)
            bag.gps_fix("/gps", time, drive.geodetic[row], status=-1 if row == 4 else 0)
    record = read(tmp_path, origin=ORIGIN)
    np.testing.assert_allclose(record.log.euler_rad[:, 2], np.pi / 2, atol=1e-4)
    np.testing.assert_allclose(record.covariances.covariance[0, :3, :3], np.diag([4e-4, 1e-4, 9e-4]), atol=1e-8)
    assert len(record.covariances.time_us) == 10
    assert "GPSFix: 1 messages without a fix are left out" in caplog.text


def test_nav_sat_fix_comes_before_gps_fix_and_each_may_be_named(tmp_path, drive):
    with VendorBag(tmp_path / "run.bag") as bag:
        for row, time in enumerate(drive.time_us[:11]):
            bag.imu("/imu", time, quaternion(0, 0, 0), SMALL)
            bag.fix("/fix", time, drive.geodetic[row], SMALL)
            bag.gps_fix("/gps", time, drive.geodetic[row] + [0, 0, 5])
    heights = [read(tmp_path, origin=ORIGIN, **keys).log.position_m[0, 2] for keys in ({}, {"fix_topic": "/gps"})]
    assert heights[0] - heights[1] == pytest.approx(5, abs=1e-6)


@pytest.mark.parametrize("is_old", [False, True])
@pytest.mark.parametrize("axes", [None, "ned", "enu"])
def test_sbg_messages(tmp_path, drive, is_old, axes, caplog):
    """Roll 2, pitch 5, heading 40 deg, in NED, which is the driver's default, or as the driver turns them to ENU."""
    euler = np.deg2rad([2, -5, 50] if axes == "enu" else [2, 5, 40])
    with VendorBag(
        tmp_path / "run.bag", DEFINITIONS | {"sbg_driver/msg/SbgEkfNav": OLD_SBG_NAV if is_old else SBG_NAV}
    ) as bag:
        for row, time in enumerate(drive.time_us[:11]):
            bag.sbg_euler(time, euler, valid=row != 3)
            bag.sbg_nav(time, ORIGIN, is_old, valid=row != 5)
    record = read(tmp_path, origin=ORIGIN, **({"attitude_axes": axes} if axes else {}))
    np.testing.assert_allclose(np.rad2deg(record.log.euler_rad), [[2, 5, 40]] * 10, atol=1e-9)
    np.testing.assert_allclose(record.log.position_m, 0, atol=1e-6)
    sigma = np.sqrt(np.diag(record.covariances.covariance[0]))
    first = [0.02, 0.01, 0.03] if axes == "enu" else [0.01, 0.02, 0.03]
    np.testing.assert_allclose(sigma, [*first, 1e-3, 2e-3, 3e-3], rtol=1e-5)
    assert "SbgEkfNav: 1 messages without a fix are left out" in caplog.text
    assert "SbgEkfEuler: 1 messages without a valid attitude are left out" in caplog.text


def test_applanix(tmp_path, drive):
    with VendorBag(tmp_path / "run.bag") as bag:
        for time in drive.time_us[:5]:
            bag.gsof49(time, ORIGIN, [2, 5, 40])
    record = read(tmp_path, origin=ORIGIN)
    np.testing.assert_allclose(np.rad2deg(record.log.euler_rad), [[2, 5, 40]] * 5, atol=1e-9)
    np.testing.assert_allclose(record.log.position_m, 0, atol=1e-6)
    assert record.covariances is None


def write_transforms(path, drive):
    """A map that moves slowly, odometry ten times as often, and an INS that stands sideways on the body."""
    with VendorBag(path) as bag:
        bag.transform(drive.time_us[0], "/base_link", "/ins", [0, 0, 1], quaternion(0, 0, -90), "/tf_static")
        for row, time in enumerate(drive.time_us[:21]):
            bag.transform(time, "odom", "base_link", [row, 0, 0], quaternion(0, 0, row))
            if row % 10 == 0:
                bag.transform(time, "map", "odom", [0, row / 10, 0], quaternion(0, 0, 90))


def test_chain_of_transforms(tmp_path, drive):
    write_transforms(tmp_path / "run.bag", drive)
    log = read(tmp_path, tf_frames=["map", "odom", "base_link", "ins"]).log
    row = np.arange(21)
    np.testing.assert_array_equal(log.time_us, drive.time_us[:21])
    np.testing.assert_allclose(log.position_m, np.stack([row / 10 + row, 0 * row, 0 * row - 1], axis=-1), atol=1e-9)
    np.testing.assert_allclose(np.rad2deg(log.euler_rad[:, 2]), 90 - row, atol=1e-6)  # north, east of the turn
    direct = read(tmp_path, tf_frames=["odom", "base_link"]).log
    np.testing.assert_allclose(direct.position_m[:, 1], row, atol=1e-9)


def test_link_that_is_not_there_is_told_with_those_that_are(tmp_path, drive):
    write_transforms(tmp_path / "run.bag", drive)
    told = r"tf: found transforms base_link to ins, map to odom, odom to base_link, expected map to base_link; correct"
    with pytest.raises(InputError, match=told):
        read(tmp_path, tf_frames=["map", "base_link"])

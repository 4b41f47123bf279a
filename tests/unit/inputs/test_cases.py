"""Files of the kinds that devices and people write and that once failed: each gives its right value."""

import re
import shutil
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from linepose.inputs.labels.reading import read_point_labels
from linepose.inputs.navigation import read_navigation
from linepose.inputs.navigation.registry import FORMATS
from linepose.inputs.scans.line_times import line_times_of
from linepose.inputs.scans.scan_files import read_intensity
from linepose.inputs.source import ScansSection
from linepose.settings import validated
from unit.inputs import writers

CASES = Path(__file__).parent / "cases"


def navigation(case, **keys):
    """The log of a case, of keys as they stand in a platform file."""
    section = validated(FORMATS.member(keys["format"]).section, keys, "source.navigation")
    return read_navigation(section, CASES / case)


def first_angles(record):
    return np.rad2deg(record.log.euler_rad[0])


def labels(case, pattern):
    found = read_point_labels(CASES / case, pattern, {1: Path("run-01.hdr")}, 640)
    return [tuple(row) for row in found[["point", "u_px", "line"]].itertuples(index=False)]


@pytest.mark.parametrize(
    ("case", "file"),
    [
        ("envi_interleave_case", "scan.hdr"),
        ("envi_interleave_case_one_band", "scan.hdr"),
        ("envi_no_byte_order", "scan.hdr"),
        ("envi_specim_file_type", "scan.hdr"),
        ("image_rgb_16_bit", "scan.png"),
        ("image_rgb_16_bit", "scan.tif"),
    ],
)
def test_scan_is_the_mean_of_its_bands(case, file):
    cube = np.load(CASES / case / "cube.npy").astype(float)
    mean = cube.mean(axis=-1) if cube.ndim == 3 else cube
    np.testing.assert_allclose(read_intensity(CASES / case / file), mean, rtol=1e-6)


def test_labelme_group_id():
    assert labels("labelme_group_id", "*.json") == [(3, 10.0, 20.0), (4, 50.0, 20.0)]


def test_cvat_attribute_of_another_name():
    assert labels("cvat_attribute_of_another_name", "annotations.xml") == [(7, 10.0, 20.0)]


def test_cvat_skeleton_outside():
    assert labels("cvat_skeleton_outside", "annotations.xml") == [(0, 10.0, 20.0)]


def test_headwall_number_in_name():
    source = ScansSection(kind="scans", dataset="x", time_stamps="headwall")
    times = line_times_of(source)(CASES / "headwall_number_in_name" / "flight2_raw_0.hdr", 5)
    assert times[0] == 1_600_000_000_000_000


@pytest.mark.parametrize("file", ["lf.gps", "crlf.gps"])
def test_novatel_line_ends(file):
    record = navigation("novatel_line_ends", format="novatel", file=file)
    assert len(record.log.time_us) == 5
    np.testing.assert_allclose(first_angles(record), [1, 2, 40], atol=1e-9)


def test_resonon_gps_week_rollover(caplog):
    record = navigation("resonon_gps_week_rollover", format="resonon", file="run.lcf")
    assert len(record.log.time_us) == 20
    assert re.search(r"run.lcf: times of 1996-07-14.*may have lost 1024 GPS weeks \(2016-02-28\)", caplog.text)


def test_table_repeated_row(caplog):
    columns = {"time": "time", "position": ["lat", "lon", "h"], "attitude": ["r", "p", "y"]}
    keys = {"columns": columns, "time_unit": "s", "coordinates": "geodetic", "angle_unit": "degrees"}
    record = navigation("table_repeated_row", format="table", file="log.txt", **keys)
    np.testing.assert_array_equal(record.log.time_us - 1_600_000_000_000_000, 10_000 * np.arange(5))
    assert "log.txt: 1 records that repeat the one before are passed over" in caplog.text


def test_table_fixed_width():
    record = navigation("table_fixed_width", format="table", file="log.txt", preset="hyspex", gps_week=2122)
    assert len(record.log.time_us) == 5
    np.testing.assert_allclose(first_angles(record), [-1.3, -1.95, 164.27])
    np.testing.assert_allclose(record.origin, (59.9, 10.5, 899.84))


def test_table_fixed_width_without_a_preset():
    columns = {"time": "8", "position": ["3", "2", "4"], "attitude": ["5", "6", "7"]}
    keys = {"heading": False, "delimiter": " ", "time_unit": "s", "time_scale": "gps_week", "gps_week": 2122}
    keys |= {"coordinates": "geodetic", "angle_unit": "degrees", "columns": columns}
    record = navigation("table_fixed_width", format="table", file="log.txt", **keys)
    np.testing.assert_allclose(first_angles(record), [-1.3, -1.95, 164.27])


def test_table_inertial_explorer():
    record = navigation("table_inertial_explorer", format="table", file="log.txt", preset="inertial_explorer")
    # GPS week 2122 begins on 2020-09-06; 43218 s later is 18 s behind midday in UTC, by the 18 leap seconds
    np.testing.assert_array_equal(record.log.time_us, 1_599_393_600_000_000 + 1_000_000 * np.arange(5))
    np.testing.assert_allclose(first_angles(record), [-1.74, 0.44, -132.53])
    place = (22 + 18 / 60 + 4.31949 / 3600, 114 + 10 / 60 + 44.60559 / 3600, 3.472)
    np.testing.assert_allclose(record.origin, place, rtol=0, atol=1e-12)


START_US = 1_600_000_000_000_000
SMALL = np.eye(3) * 1e-6


def bag(path, fix_us, quaternion):
    """Twenty seconds of an Imu at 100 Hz, and fixes."""
    with writers.Bag(path, 1) as written:
        for time_us in START_US + 10_000 * np.arange(2001):
            written.imu("/imu/data", time_us, quaternion, SMALL)
        for time_us in fix_us:
            written.fix("/gps/fix", time_us, (50.0, 8.0, 100.0), SMALL)


def test_rosbag_fix_at_1_hz(tmp_path, caplog):
    """Stamps that jitter by a millisecond."""
    jitter_us = np.random.default_rng(1).normal(0, 1000, 21).round().astype(int)
    bag(tmp_path / "made.bag", START_US + 1_000_000 * np.arange(21) + jitter_us, [0.0, 0.0, 0.0, 1.0])
    record = navigation(tmp_path, format="rosbag", file="made.bag")
    assert 1999 <= len(record.log.time_us) <= 2001
    assert np.diff(record.log.time_us).max() == 10_000
    assert not caplog.text


def test_rosbag_imu_in_ned(tmp_path):
    quaternion = Rotation.from_euler("ZYX", [40, 5, 2], degrees=True).as_quat()
    bag(tmp_path / "made.bag", START_US + 100_000 * np.arange(201), quaternion)
    record = navigation(tmp_path, format="rosbag", file="made.bag", attitude_axes="ned")
    np.testing.assert_allclose(first_angles(record), [2, 5, 40], atol=1e-9)


def test_specim_nav_nmea():
    record = navigation("specim_nav_nmea", format="nmea", file="scan.nav", date="2024-05-01")
    first_us = 1_714_557_600_020_000  # 2024-05-01 10:00:00.02 UTC
    np.testing.assert_array_equal(record.log.time_us, first_us + 1_000_000 * np.arange(3))
    np.testing.assert_allclose(first_angles(record), [2, 5, 40])
    np.testing.assert_allclose(record.origin, (50.0, 8.0, 100.0))


def test_specim_line_times(tmp_path):
    """The header is that of the recorder's other case, with as many frames a second as the sentences say."""
    shutil.copy(CASES / "specim_nav_nmea" / "scan.nav", tmp_path)
    shutil.copy(CASES / "envi_specim_file_type" / "scan.raw", tmp_path)
    header = (CASES / "envi_specim_file_type" / "scan.hdr").read_text().replace("fps = 100.00", "fps = 50.00")
    (tmp_path / "scan.hdr").write_text(header)
    times = line_times_of(ScansSection(kind="scans", dataset="x", time_stamps="specim"))(tmp_path / "scan.hdr", 7)
    np.testing.assert_array_equal(times, 1_714_557_600_020_000 + 20_000 * np.arange(7))

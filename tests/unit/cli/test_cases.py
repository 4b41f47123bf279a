"""Files of the kinds that devices and people write and that once failed: the commands tell the right value of each."""

import json
import shutil
from pathlib import Path

import geopandas
import numpy as np
import pandas as pd
import pytest
import yaml
from scipy.spatial.transform import Rotation
from typer.testing import CliRunner

from linepose.cli.app import app
from linepose.inputs.local_frame import MAP_FRAME
from linepose.tables import write_table
from unit import made_up
from unit.inputs import writers
from unit.output.exports.test_place_on_earth import write_points

CASES = Path(__file__).parents[1] / "inputs" / "cases"
START_US = 1_600_000_000_000_000  # 2020-09-13 12:26:40 UTC
SMALL = np.eye(3) * 1e-6


class Project:
    """A project in an empty folder, whose platform `mine` has the files of a case."""

    def __init__(self, root):
        self.root, self.data = root, root / "data" / "mine"
        self.data.mkdir(parents=True)

    def given(self, *arguments):
        return CliRunner().invoke(app, [*map(str, arguments), "--project", str(self.root)])

    def write(self, n_pixels=11, **source):
        """The platform's file; scans are of another case where none are named."""
        size = {"focal_length_m": 0.01, "pixel_pitch_m": 1e-5}
        camera = size | {"n_pixels": n_pixels, "principal_point_px": n_pixels / 2}
        hand = {"position_m": [0, 0, -1], "euler_deg": [0, 0, 0]}
        source = {"kind": "scans", "dataset": "mine", "scans": "*.hdr", "points": "detection"} | source
        folder = self.root / "config" / "platforms"
        folder.mkdir(parents=True)
        (folder / "mine.yaml").write_text(yaml.safe_dump({"camera": camera, "hand_measured": hand, "source": source}))
        (self.root / "config" / "config.yaml").write_text("platforms: [mine]\n")

    def copy(self, case):
        """The files of a case."""
        for path in (CASES / case).iterdir():
            shutil.copy(path, self.data)

    def told(self):
        """What `linepose check` prints, line by line."""
        result = self.given("check", "mine")
        assert "Traceback" not in result.output
        return result.stdout.splitlines()

    def line(self, subject, words):
        """The one line of a check about a subject that has these words."""
        lines = self.told()
        (found,) = [line for line in lines if line[8:].startswith(f"{subject}: ") and words in line] or [lines]
        return found


@pytest.fixture
def project(tmp_path):
    return Project(tmp_path)


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
def test_scan_is_the_mean_of_its_bands(project, case, file):
    cube = np.load(CASES / case / "cube.npy").astype(float)
    mean = cube.mean(axis=-1) if cube.ndim == 3 else cube
    project.copy(case)
    starts = {"scan": "2026-05-01T12:00:00Z"}
    project.write(mean.shape[1], scans=file, time_stamps="rate", line_rate_hz=100, start_times=starts)
    told = f"intensities {mean.min():.6g} to {mean.max():.6g}, on average {mean.mean():.6g}"
    assert f"{file}: {len(mean)} lines from 2026-05-01T12:00:00" in project.line("scans", told)


@pytest.mark.parametrize(
    ("case", "labels", "told"),
    [
        ("labelme_group_id", "run-01.json", "points 3, 4; the first, 3, at pixel 10, line 20 of scan 1"),
        ("cvat_attribute_of_another_name", "annotations.xml", "points 7; the first, 7, at pixel 10, line 20 of scan 1"),
        ("cvat_skeleton_outside", "annotations.xml", "points 0; the first, 0, at pixel 10, line 20 of scan 1"),
    ],
)
def test_labels(project, case, labels, told):
    project.copy(case)
    header = "ENVI\nsamples = 640\nlines = 400\nbands = 1\ndata type = 1\ninterleave = bil\nheader offset = 0\n"
    (project.data / "run-01.hdr").write_text(header)
    (project.data / "run-01.raw").write_bytes(bytes(640 * 400))
    times = {"time_stamps": "rate", "line_rate_hz": 100, "start_times": {"run-01": "2026-05-01T12:00:00Z"}}
    project.write(640, points="labels", labels=labels, refinement="none", **times)
    assert project.line("labels", "the first").endswith(told)


def test_headwall_number_in_name(project):
    project.copy("headwall_number_in_name")
    header = "ENVI\nsamples = 11\nlines = 5\nbands = 1\ndata type = 1\ninterleave = bil\nheader offset = 0\n"
    (project.data / "flight2_raw_0.hdr").write_text(header)
    (project.data / "flight2_raw_0.raw").write_bytes(bytes(55))
    project.write(time_stamps="headwall")
    assert "5 lines from 2020-09-13T12:26:40.000000 UTC" in project.line("scans", "flight2_raw_0.hdr")


def test_specim_nav_nmea(project):
    """The log, and the lines of a scan whose header is that of the recorder's other case, with its .nav's rate."""
    project.copy("specim_nav_nmea")
    project.copy("envi_specim_file_type")
    header = (project.data / "scan.hdr").read_text().replace("fps = 100.00", "fps = 50.00")
    (project.data / "scan.hdr").write_text(header)
    project.write(time_stamps="specim", navigation={"format": "nmea", "file": "scan.nav"})
    times = "7 lines from 2024-05-01T10:00:00.020000 UTC to 2024-05-01T10:00:00.140000 UTC"
    assert times in project.line("scans", "scan.hdr: 7 lines")
    assert project.line("navigation log", "poses").endswith(
        "3 poses from 2024-05-01T10:00:00.020000 UTC to 2024-05-01T10:00:02.020000 UTC; the first: "
        "latitude 50.0000000, longitude 8.0000000 deg, height 100.000 m, roll 2.000, pitch 5.000, yaw 40.000 deg"
    )


TABLE = {"format": "table", "file": "log.txt"}
COLUMNS = {"time": "time", "position": ["lat", "lon", "h"], "attitude": ["r", "p", "y"]}
IN_DEGREES = {"time_unit": "s", "coordinates": "geodetic", "angle_unit": "degrees"}
BY_NUMBER = {"time": "8", "position": ["3", "2", "4"], "attitude": ["5", "6", "7"]}
HYSPEX = "5 poses from 2020-09-10T15:52:31.990000 UTC to 2020-09-10T15:52:32.006000 UTC; the first: "
HYSPEX += "latitude 59.9000000, longitude 10.5000000 deg, height 899.840 m, roll -1.300, pitch -1.950, yaw 164.270 deg"
# GPS week 2122 begins on 2020-09-06; 43218 s later is 18 s behind midday in UTC, by the 18 leap seconds
EXPLORER = "5 poses from 2020-09-06T12:00:00.000000 UTC to 2020-09-06T12:00:04.000000 UTC; the first: "
EXPLORER += "latitude 22.3011999, longitude 114.1790571 deg, height 3.472 m, roll -1.740, pitch 0.440, yaw -132.530 deg"
REPEATED = "5 poses from 2020-09-13T12:26:40.000000 UTC to 2020-09-13T12:26:40.040000 UTC; the first: "
REPEATED += "latitude -33.8800000, longitude 151.1900000 deg, height 42.500 m, roll 1.000, pitch 2.000, yaw 90.000 deg"
NOVATEL = "5 poses from 2022-03-09T11:59:42.000000 UTC to 2022-03-09T11:59:42.040000 UTC; the first: "
NOVATEL += "latitude 50.0000000, longitude 8.0000000 deg, height 100.000 m, roll 1.000, pitch 2.000, yaw 40.000 deg"


@pytest.mark.parametrize(
    ("case", "keys", "told"),
    [
        ("table_fixed_width", TABLE | {"preset": "hyspex", "gps_week": 2122}, HYSPEX),
        (
            "table_fixed_width",
            TABLE
            | IN_DEGREES
            | {"heading": False, "delimiter": " ", "time_scale": "gps_week", "gps_week": 2122, "columns": BY_NUMBER},
            HYSPEX,
        ),
        ("table_inertial_explorer", TABLE | {"preset": "inertial_explorer"}, EXPLORER),
        ("table_repeated_row", TABLE | IN_DEGREES | {"columns": COLUMNS}, REPEATED),
        ("novatel_line_ends", {"format": "novatel", "file": "lf.gps"}, NOVATEL),
        ("novatel_line_ends", {"format": "novatel", "file": "crlf.gps"}, NOVATEL),
    ],
)
def test_logs(project, case, keys, told):
    project.copy(case)
    project.write(navigation=keys)
    assert project.line("navigation log", "poses from").endswith(told)


def test_a_repeated_row_is_told(project):
    project.copy("table_repeated_row")
    project.write(navigation=TABLE | IN_DEGREES | {"columns": COLUMNS})
    assert project.line("navigation log", "repeat").startswith("warning ")


def test_resonon_gps_week_rollover(project):
    project.copy("resonon_gps_week_rollover")
    (project.data / "run.bil").write_bytes(bytes(2 * 55))
    project.write(time_stamps="resonon", navigation={"format": "resonon", "file": "run.lcf"})
    lost = "run.lcf: times of 1996-07-14: the receiver may have lost 1024 GPS weeks (2016-02-28)"
    assert lost in project.line("files", "1996-07-14")


def bag(path, fix_us, quaternion, step_us=10_000):
    """Twenty seconds of an Imu, and fixes."""
    with writers.Bag(path, 1) as written:
        for time_us in range(START_US, START_US + 20_000_001, step_us):
            written.imu("/imu/data", time_us, quaternion, SMALL)
        for time_us in fix_us:
            written.fix("/gps/fix", time_us, (50.0, 8.0, 100.0), SMALL)


def test_rosbag_fix_at_1_hz(project):
    """Stamps that jitter by a millisecond."""
    jitter_us = np.random.default_rng(1).normal(0, 1000, 21).round().astype(int)
    bag(project.data / "made.bag", START_US + 1_000_000 * np.arange(21) + jitter_us, [0.0, 0.0, 0.0, 1.0])
    project.write(navigation={"format": "rosbag", "file": "made.bag"})
    told = project.told()
    (poses,) = [line for line in told if "navigation log: " in line and "poses from" in line]
    assert 1999 <= int(poses.split()[3]) <= 2001
    assert any(line.endswith("a pose every 0.01 s in the navigation log, at most 0.01 s apart") for line in told)
    assert not any(line.startswith("warning navigation") for line in told)


def test_rosbag_imu_in_ned(project):
    quaternion = Rotation.from_euler("ZYX", [40, 5, 2], degrees=True).as_quat()
    bag(project.data / "made.bag", START_US + 100_000 * np.arange(201), quaternion, 100_000)
    project.write(navigation={"format": "rosbag", "file": "made.bag", "attitude_axes": "ned"})
    assert "roll 2.000, pitch 5.000, yaw 40.000 deg" in project.line("navigation log", "poses from")


def test_export_points_at_null_island(project):
    """Points at the origin of a log in Sydney, whose place the results hold as numbers of numpy."""
    results = project.root / "results" / "mine"
    made_up.write_results(results)
    frame = pd.DataFrame([["EPSG:4979", -33.9, 151.2, 40.0]], columns=MAP_FRAME.names)
    write_table(frame, results / "map_frame.parquet", MAP_FRAME)
    write_points(results, np.zeros((1, 3)))
    project.write(navigation=TABLE | IN_DEGREES | {"columns": COLUMNS})
    for format in ("geojson", "geopackage"):
        result = project.given("export", "mine", "--format", format)
        assert result.exit_code == 0, result.output
    (one, *_) = json.loads((results / "exports" / "mine.geojson").read_text())["features"]
    np.testing.assert_allclose(one["geometry"]["coordinates"], [151.2, -33.9, 40.0], rtol=0, atol=1e-7)
    table = geopandas.read_file(results / "exports" / "mine.gpkg", layer="estimated_points")
    assert table.crs.to_epsg() == 32756
    # the grid of zone 56 by the Transverse Mercator series of Snyder (1987), equations 8-9 to 8-13
    np.testing.assert_allclose([table.geometry[0].x, table.geometry[0].y], [333_540, 6_247_520], rtol=0, atol=500)

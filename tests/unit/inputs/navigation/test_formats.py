"""The simulated drive, written in every format and read back."""

import numpy as np
import pytest

from linepose.inputs.navigation import read_navigation
from linepose.inputs.navigation.novatel import NovatelSection
from linepose.inputs.navigation.resonon import ResononSection
from linepose.inputs.navigation.rosbag import RosbagSection
from linepose.inputs.navigation.sbet import SbetSection
from linepose.inputs.navigation.table import TableSection
from unit.inputs import novatel_writer, writers
from unit.inputs.drive import ORIGIN

DOUBLE_M = 2e-8  # Earth-fixed coordinates of 6.4e6 m in double precision, a few operations
DOUBLE_RAD = 1e-12
# sigmas are about true north at each place, some metres from the origin: seen from there, the axes are turned by up to
# 1e-6 rad, which mixes quantities whose sigmas differ threefold
TURNED = 3e-6
SINGLE = 2**-23
ASCII_M = 0.5e-4 + 1e-6  # four decimals of the height; eleven of a degree are a micrometre
ASCII_RAD = np.deg2rad(0.5e-9) + DOUBLE_RAD


def assert_log(record, drive, metres, radians):
    np.testing.assert_array_equal(record.log.time_us, drive.time_us)
    np.testing.assert_allclose(record.log.position_m, drive.position_m, rtol=0, atol=metres)
    turned = (record.log.euler_rad - drive.euler_rad + np.pi) % (2 * np.pi) - np.pi
    np.testing.assert_allclose(turned, 0, atol=radians)


def assert_covariances(record, drive, relative, every=1):
    """`relative` is that of a standard deviation."""
    np.testing.assert_array_equal(record.covariances.time_us, drive.time_us[::every])
    sigma = np.sqrt(np.diagonal(drive.covariance[::every], axis1=1, axis2=2))
    unit = sigma[:, :, None] * sigma[:, None, :]
    np.testing.assert_allclose(
        record.covariances.covariance / unit, drive.covariance[::every] / unit, atol=2 * relative
    )


def rows(drive, message, every=1):
    return b"".join(message(row) for row in range(0, len(drive.time_us), every))


@pytest.mark.parametrize("name", ["INSPVA", "INSPVAS"])
def test_novatel_binary(tmp_path, drive, name):
    messages = [
        novatel_writer.pva(name, drive, row, True) + (novatel_writer.stdev(drive, row, True) if row % 10 == 0 else b"")
        for row in range(len(drive.time_us))
    ]
    (tmp_path / "run.gps").write_bytes(b"".join(messages))
    record = read_navigation(NovatelSection(format="novatel", file="run.gps", origin=ORIGIN), tmp_path)
    assert_log(record, drive, DOUBLE_M, DOUBLE_RAD)
    assert_covariances(record, drive, SINGLE + TURNED, every=10)
    assert record.crs == "EPSG:4979"
    assert record.origin == ORIGIN


@pytest.mark.parametrize("name", ["INSPVA", "INSPVAS"])
def test_novatel_ascii(tmp_path, drive, name):
    messages = [
        novatel_writer.pva(name, drive, row, False) + novatel_writer.stdev(drive, row, False)
        for row in range(len(drive.time_us))
    ]
    (tmp_path / "run.txt").write_bytes(b"".join(messages))
    record = read_navigation(NovatelSection(format="novatel", file="run.txt", origin=ORIGIN), tmp_path)
    assert_log(record, drive, ASCII_M, ASCII_RAD)
    assert_covariances(record, drive, 0.5e-4 / 0.021)  # four decimals of the smallest sigma, a position's


@pytest.mark.parametrize("binary", [True, False])
def test_novatel_pvax_alone(tmp_path, drive, binary):
    (tmp_path / "run.gps").write_bytes(rows(drive, lambda row: novatel_writer.pvax(drive, row, binary)))
    record = read_navigation(NovatelSection(format="novatel", file="run.gps", origin=ORIGIN), tmp_path)
    assert_log(record, drive, DOUBLE_M if binary else ASCII_M, DOUBLE_RAD if binary else ASCII_RAD)
    assert_covariances(record, drive, SINGLE + TURNED if binary else 0.5e-4 / 0.021)


@pytest.mark.parametrize("binary", [True, False])
@pytest.mark.parametrize("name", ["INSCOV", "INSCOVS"])
def test_novatel_full_covariances(tmp_path, correlated, name, binary):
    drive = block_diagonal(correlated)
    local = drive.turn @ drive.covariance[:, :3, :3] @ np.swapaxes(drive.turn, -1, -2)
    enu = writers.NED_FROM_ENU.T @ local @ writers.NED_FROM_ENU
    at_origin = writers.fixed_axes_covariance(drive.euler_rad, drive.covariance, drive_matrix(drive))[:, 3:, 3:]
    turn_enu = writers.NED_FROM_ENU.T @ drive.turn @ writers.NED_FROM_ENU
    turns = turn_enu @ at_origin @ np.swapaxes(turn_enu, -1, -2) * (180 / np.pi) ** 2
    messages = [
        novatel_writer.pva("INSPVAS", drive, row, binary)
        + novatel_writer.cov(name, drive, row, enu[row], turns[row], binary)
        + novatel_writer.stdev(drive, row, binary)
        for row in range(len(drive.time_us))
    ]
    (tmp_path / "run.gps").write_bytes(b"".join(messages))
    record = read_navigation(NovatelSection(format="novatel", file="run.gps", origin=ORIGIN), tmp_path)
    assert_covariances(record, drive, 1e-9)  # of the differences in `fixed_axes_covariance`


def test_sbet_with_rms_takes_the_week_and_the_wander_angle(tmp_path, drive):
    writers.write_sbet(tmp_path / "a.sbet", drive)
    writers.write_rms(tmp_path / "a.rms", drive)
    section = SbetSection(format="sbet", file="a.sbet", rms="a.rms", gps_week=int(drive.week[0]), origin=ORIGIN)
    record = read_navigation(section, tmp_path)
    assert_log(record, drive, DOUBLE_M, DOUBLE_RAD)
    assert_covariances(record, drive, TURNED)


@pytest.mark.parametrize("ros", [1, 2])
def test_odometry(tmp_path, correlated, ros):
    drive, name = correlated, "run.bag" if ros == 1 else "run"
    covariance = writers.fixed_axes_covariance(drive.euler_rad, drive.covariance, drive_matrix(drive))
    quaternion = writers.enu_flu_quaternion(drive_matrix(drive))
    with writers.Bag(tmp_path / name, ros) as bag:
        for row, time in enumerate(drive.time_us):
            enu = writers.NED_FROM_ENU.T @ drive.position_m[row]
            bag.odometry("/odometry", time, enu, quaternion[row], covariance[row])
    record = read_navigation(RosbagSection(format="rosbag", file=name), tmp_path)
    assert_log(record, drive, 1e-12, DOUBLE_RAD)
    assert_covariances(record, drive, 1e-9)
    assert record.crs is None


@pytest.mark.parametrize("ros", [1, 2])
def test_fixes_and_imu(tmp_path, correlated, ros):
    drive, name = block_diagonal(correlated), "run.bag" if ros == 1 else "run"
    quaternion = writers.enu_flu_quaternion(drive.true_matrix)
    turn_enu = writers.NED_FROM_ENU.T @ drive.turn @ writers.NED_FROM_ENU
    at_origin = writers.fixed_axes_covariance(drive.euler_rad, drive.covariance, drive_matrix(drive))
    blocks = [turn_enu @ at_origin[:, s, s] @ np.swapaxes(turn_enu, -1, -2) for s in (slice(0, 3), slice(3, 6))]
    with writers.Bag(tmp_path / name, ros) as bag:
        for row, time in enumerate(drive.time_us):
            bag.imu("/imu", time, quaternion[row], blocks[1][row])
            if row % 5 == 0:
                bag.fix("/fix", time, drive.geodetic[row], blocks[0][row])
    record = read_navigation(RosbagSection(format="rosbag", file=name, origin=ORIGIN), tmp_path)
    n = len(record.log.time_us)
    assert n == len(drive.time_us) - 4  # those after the last fix are left out
    np.testing.assert_allclose(record.log.position_m[::5], drive.position_m[:n:5], rtol=0, atol=DOUBLE_M)
    # between fixes 0.5 s apart a straight line: at 0.2 m/s and the hill's slopes it is off by a few millimetres
    np.testing.assert_allclose(record.log.position_m, drive.position_m[:n], rtol=0, atol=0.03)
    turned = (record.log.euler_rad - drive.euler_rad[:n] + np.pi) % (2 * np.pi) - np.pi
    np.testing.assert_allclose(turned, 0, atol=1e-7)  # the interpolated place turns true north by metres of a radius
    sigma = np.sqrt(np.diagonal(drive.covariance, axis1=1, axis2=2))[0]
    unit = np.outer(sigma, sigma)
    np.testing.assert_allclose(record.covariances.covariance / unit, drive.covariance[:n:5] / unit, atol=1e-7)


@pytest.mark.parametrize("suffix", [".csv", ".parquet"])
def test_table_of_latitude_and_longitude(tmp_path, drive, suffix):
    table = writers.geodetic_table(drive)
    path = tmp_path / f"log{suffix}"
    table.to_csv(path, index=False, float_format="%.17g") if suffix == ".csv" else table.to_parquet(path)
    section = TableSection(
        format="table",
        file=path.name,
        columns={
            "time": "t",
            "position": ("lat", "lon", "h"),
            "attitude": ("roll", "pitch", "heading"),
            "sigma_position": ("sn", "se", "sd"),
            "sigma_attitude": ("sr", "sp", "sh"),
        },
        time_unit="s",
        coordinates="geodetic",
        angle_unit="degrees",
        origin=ORIGIN,
    )
    record = read_navigation(section, tmp_path)
    assert_log(record, drive, DOUBLE_M, DOUBLE_RAD)
    assert_covariances(record, drive, TURNED)


def test_resonon_location_files_follow_each_other(tmp_path, drive):
    half = len(drive.time_us) // 2
    for name, part in (("b", slice(None, half)), ("a", slice(half, None))):  # in time, whatever their names
        writers.write_location(tmp_path / f"{name}.lcf", sliced(drive, part))
    record = read_navigation(ResononSection(format="resonon", file="*.lcf", origin=ORIGIN), tmp_path)
    # latitude to 15 digits is 1e-13 deg; the height has nine decimals
    assert_log(record, drive, 1e-7, DOUBLE_RAD)
    assert record.covariances is None


def drive_matrix(drive):
    return np.swapaxes(drive.turn, -1, -2) @ drive.true_matrix


def block_diagonal(drive):
    covariance = drive.covariance.copy()
    covariance[:, :3, 3:] = covariance[:, 3:, :3] = 0
    return type(drive)(drive.time_us, drive.position_m, drive.euler_rad, covariance)


def sliced(drive, part):
    return type(drive)(drive.time_us[part], drive.position_m[part], drive.euler_rad[part], drive.covariance[part])

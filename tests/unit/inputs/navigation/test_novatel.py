import logging

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from linepose.errors import InputError
from linepose.geometry import rotations
from linepose.inputs import novatel_file
from linepose.inputs.axes import matrix_from_enu_flu
from linepose.inputs.navigation import read_navigation
from linepose.inputs.navigation.novatel import NovatelSection, read_messages
from linepose.inputs.navigation.rosbag import RosbagSection
from unit.inputs import novatel_writer

NED_FROM_ENU = np.array([[0, 1, 0], [1, 0, 0], [0, 0, -1]])


def section(file, **keys):
    return NovatelSection(format="novatel", file=file, **keys)


def test_novatel_angles_are_ours():
    """NovAtel: x right, y forward, z up; azimuth about down, then pitch about right, then roll about forward."""
    roll, pitch, azimuth = np.deg2rad([4.0, -7.0, 250.0])
    enu_rfu = (
        Rotation.from_euler("z", -azimuth) * Rotation.from_euler("x", pitch) * Rotation.from_euler("y", roll)
    ).as_matrix()
    rfu_from_frd = np.array([[0, 1, 0], [1, 0, 0], [0, 0, -1]])
    np.testing.assert_allclose(
        NED_FROM_ENU @ enu_rfu @ rfu_from_frd, rotations.matrix_from_euler([roll, pitch, azimuth]), atol=1e-15
    )


@pytest.mark.devices
def test_no_message_of_the_real_log_is_lost(samples):
    log = read_messages(samples / "novatel" / "ins1.gps")
    assert {name: len(rows) for name, rows in log.rows.items()} == {"INSPVA": 243, "INSSTDEV": 29}
    assert log.unusable == log.unknown_bytes == 0
    record = read_navigation(section("novatel/ins1.gps"), samples)
    assert len(record.log.time_us) == 243
    assert len(record.covariances.time_us) == 29
    other = read_messages(samples / "novatel" / "ins2.gps")
    assert {name: len(rows) for name, rows in other.rows.items()} == {"INSPVA": 62, "INSPVAX": 6}


@pytest.mark.devices
def test_real_log_says_what_the_vendors_driver_made_of_it(samples):
    """The driver's bag: orientation after REP-103 from the last pose before each IMU message, and its sigmas."""
    from rosbags.highlevel import AnyReader

    record = read_navigation(section("novatel/ins1.gps"), samples)
    with AnyReader([samples / "novatel" / "ins1.bag"]) as bag:
        messages = [
            (one.topic, bag.deserialize(raw, one.msgtype))
            for one, _, raw in bag.messages()
            if one.topic in ("/gps/imu", "/novatel/oem7/insstdev")
        ]
    imu = [message for topic, message in messages if topic == "/gps/imu"]
    assert len(imu) == 10
    for message in imu:
        turn = message.orientation
        matrix = matrix_from_enu_flu(Rotation.from_quat([turn.x, turn.y, turn.z, turn.w]).as_matrix())
        apart = rotations.rotation_angle_rad(rotations.matrix_from_euler(record.log.euler_rad), matrix)
        assert apart.min() < 2e-8  # the place is centimetres from the origin, whose north counts
        assert np.sort(apart)[1] > 1e-6  # it is one pose's, not any
    stdev = [message for topic, message in messages if topic.endswith("insstdev")]
    sigma = np.sqrt(np.diagonal(record.covariances.covariance, axis1=1, axis2=2))
    theirs = [
        (
            m.latitude_stdev,
            m.longitude_stdev,
            m.height_stdev,
            *np.deg2rad([m.roll_stdev, m.pitch_stdev, m.azimuth_stdev]),
        )
        for m in stdev
    ]
    np.testing.assert_allclose(sigma, theirs, rtol=1e-5)  # azimuth 200 times less sure than roll
    week_ms = np.array(
        [(m.nov_header.gps_week_number, m.nov_header.gps_week_milliseconds) for m in stdev], dtype=np.int64
    )
    gps_us = (week_ms[:, 0] * 604_800_000 + week_ms[:, 1]) * 1000
    np.testing.assert_array_equal(record.covariances.time_us, gps_us + (315_964_800 - 18) * 1_000_000)


@pytest.mark.devices
def test_undulation_brings_both_kinds_to_one_height(samples):
    origin = (51.15044, -114.03066, 1080.0)
    heights = [
        -read_navigation(section("novatel/ins2.gps", poses=kind, origin=origin), samples).log.position_m[:, 2]
        for kind in ("INSPVA", "INSPVAX")
    ]
    assert abs(np.mean(heights[0]) - np.mean(heights[1])) < 0.02
    assert np.ptp(np.concatenate(heights)) < 0.05


def test_short_and_long_form_of_one_pose_count_once(tmp_path, drive):
    forms = [novatel_writer.pva(name, drive, row, True) for row in range(5) for name in ("INSPVA", "INSPVAS")]
    (tmp_path / "a.gps").write_bytes(b"".join(forms))
    assert len(read_navigation(section("a.gps"), tmp_path).log.time_us) == 5


def test_poses_before_alignment_are_left_out(tmp_path, drive, caplog):
    messages = [novatel_writer.pva("INSPVAS", drive, row, True, status=1 if row < 3 else 3) for row in range(10)]
    (tmp_path / "a.gps").write_bytes(b"".join(messages))
    with caplog.at_level(logging.WARNING, logger="linepose"):
        record = read_navigation(section("a.gps"), tmp_path)
    np.testing.assert_array_equal(record.log.time_us, drive.time_us[3:10])
    assert "3 poses without an INS solution are left out" in caplog.text


@pytest.mark.parametrize("is_binary", [True, False])
def test_nmea_between_messages_alarms_nobody(tmp_path, drive, caplog, is_binary):
    nmea = b"$GPGGA,100000.00,3353.352,S,15111.622,E,4,12,0.8,20.000,M,22.500,M,01,0000*5F\r\n"
    messages = [nmea + novatel_writer.pva("INSPVA", drive, row, is_binary) for row in range(10)]
    (tmp_path / "a.gps").write_bytes(b"".join(messages))
    assert len(read_navigation(section("a.gps"), tmp_path).log.time_us) == 10
    assert not caplog.text


def test_what_is_no_message_is_told(tmp_path, drive, caplog):
    messages = [novatel_writer.pva("INSPVAS", drive, row, True) for row in range(10)]
    broken = bytearray(messages[4])
    broken[40] ^= 1  # its CRC no longer fits
    content = b"".join([*messages[:4], bytes(broken), *messages[5:], messages[0][:50]])
    (tmp_path / "a.gps").write_bytes(content)
    with caplog.at_level(logging.WARNING, logger="linepose"):
        record = read_navigation(section("a.gps"), tmp_path)
    assert len(record.log.time_us) == 9
    assert f"{len(broken) + 50} bytes are no whole message" in caplog.text


@pytest.mark.parametrize(
    ("content", "told"),
    [
        (b"", "found no NovAtel message"),
        (b"time,north\n1,2\n" * 50, "found no NovAtel message"),
        (
            bytes(1_000_000),
            "a.gps, byte 1: found 1000000 bytes without a message, expected .*; give the log itself, or",
        ),
        (b"\n" * 20 + bytes(1_000_020), "a.gps, byte 21: found 1000000 bytes without a message"),
        ("aligning", "found 4 INSPVA messages without an INS solution"),
        ("stdev", "found no INSPVA, expected INSPVA, INSPVAS or INSPVAX messages"),
    ],
)
def test_log_without_poses_is_one_line(tmp_path, drive, content, told):
    made = {
        "aligning": lambda: [novatel_writer.pva("INSPVA", drive, row, False, status=1) for row in range(4)],
        "stdev": lambda: [novatel_writer.stdev(drive, row, False) for row in range(4)],
    }
    (tmp_path / "a.gps").write_bytes(content if isinstance(content, bytes) else b"".join(made[content]()))
    with pytest.raises(InputError, match=told) as error:
        read_navigation(section("a.gps"), tmp_path)
    assert str(error.value).startswith(f"{tmp_path}/a.gps")
    assert "\n" not in str(error.value)


@pytest.mark.devices
def test_a_bag_of_the_driver_without_fixes_is_told(samples):
    with pytest.raises(InputError, match=r"found 0 topics of sensor_msgs/msg/NavSatFix.*the bag holds /gps/imu"):
        read_navigation(RosbagSection(format="rosbag", file="novatel/ins1.bag"), samples)


def test_logs_that_overlap_are_told(tmp_path, drive):
    for name, rows in (("a", range(6)), ("b", range(5, 9))):
        messages = [novatel_writer.pva("INSPVAS", drive, row, True) for row in rows]
        (tmp_path / f"{name}.gps").write_bytes(b"".join(messages))
    with pytest.raises(
        InputError, match=r"b.gps: found a log that begins at .*, expected one that begins after the end of"
    ):
        read_navigation(section("*.gps"), tmp_path)


LINE = (
    b"%INSPVASA,2200,302400.0{n}0;2200,302400.0{n}0000000,50.00000000000,8.00000000000,100.0000,"
    b"0.1000,0.2000,0.3000,1.000000000,2.000000000,40.000000000,INS_SOLUTION_GOOD*{crc}"
)
CHECK_SUMS = (b"5975c36e", b"2c437dd7", b"b318be1c", b"c62e00a5", b"56de3fcb")


@pytest.mark.parametrize("end", [b"\r\n", b"\n", b"\r\r\n", b"\r", b"\r\n\r\n", b"\n\n", b"\n  "])
def test_line_ends_of_ascii_messages_do_not_matter(tmp_path, monkeypatch, end):
    lines = [LINE.replace(b"{n}", b"%d" % n).replace(b"{crc}", crc) for n, crc in enumerate(CHECK_SUMS)]
    (tmp_path / "run.gps").write_bytes(end.join([*lines, b""]))
    messages = read_messages(tmp_path / "run.gps")
    assert messages.unknown_bytes == 0
    assert messages.path == tmp_path / "run.gps"
    record = read_navigation(section("run.gps"), tmp_path)
    assert np.diff(record.log.time_us).tolist() == [10_000] * 4
    monkeypatch.setattr(novatel_file, "LONGEST_LINE", len(lines[0]) + 10)  # as of a log of more than that
    assert len(read_messages(tmp_path / "run.gps").rows["INSPVA"]) == 5
    np.testing.assert_allclose(record.log.euler_rad[0], np.deg2rad([1, 2, 40]), atol=1e-9)


@pytest.mark.parametrize("end", [b"\r\n", b"\n"])
def test_messages_of_a_second_antenna_do_not_lose_those_beside_them(tmp_path, end):
    """Whose names end in _1."""
    lines = []
    for n, crc in enumerate(CHECK_SUMS):
        line = LINE.replace(b"{n}", b"%d" % n)
        body = line[1:].partition(b"*")[0].replace(b"INSPVASA", b"INSPVASA_1")
        lines += [b"%%%b*%08x" % (body, novatel_writer.crc(body)), line.replace(b"{crc}", crc)]
    (tmp_path / "run.gps").write_bytes(end.join([*lines, b""]))
    messages = read_messages(tmp_path / "run.gps")
    assert messages.unknown_bytes == 0
    assert len(messages.rows["INSPVA"]) == 10
    assert len(read_navigation(section("run.gps"), tmp_path).log.time_us) == 5

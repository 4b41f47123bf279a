"""Logs of autopilots, written by their formats' descriptions with made-up values."""

import struct
import sys

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from linepose.errors import InputError
from linepose.inputs.navigation import read_navigation
from linepose.inputs.navigation.ardupilot import ArdupilotSection
from linepose.inputs.navigation.px4 import Px4Section
from linepose.inputs.navigation.registry import recognised

ORIGIN = (-33.8892, 151.1937, 42.5)
STARTED_US = 1_700_000_000_000_000
WEEK, OF_WEEK_MS = 2288, 252_818_000  # the same in GPS time
NORTH_DEG = 1 / 110_920.0
N_SECONDS = 4


def ulog(path, parts=("attitude", "position", "gps")):
    """Attitudes ten times and positions once a second, a metre further north each."""
    types = {
        "attitude": ("vehicle_attitude", "uint64_t timestamp;uint64_t timestamp_sample;float[4] q;", "<QQ4f"),
        "position": (
            "vehicle_global_position",
            "uint64_t timestamp;uint64_t timestamp_sample;double lat;double lon;float alt;float alt_ellipsoid;",
            "<QQddff",
        ),
        "gps": (
            "vehicle_gps_position",
            "uint64_t timestamp;uint64_t time_utc_usec;uint8_t fix_type;",
            "<QQB",
        ),
    }
    packed = b"ULog\x01\x12\x35\x01" + struct.pack("<Q", 0)
    packed += message("B", bytes(40))

    def data(name, *values):
        return message("D", struct.pack("<H", list(types).index(name)) + struct.pack(types[name][2], *values))

    for name, (kind, fields, _) in types.items():
        packed += message("F", f"{kind}:{fields}".encode()) if name in parts else b""
    for number, (name, (kind, _, _)) in enumerate(types.items()):
        packed += message("A", struct.pack("<BH", 0, number) + kind.encode()) if name in parts else b""
    x, y, z, w = Rotation.from_euler("ZYX", [30, -10, 5], degrees=True).as_quat()
    for tenth in range(10 * N_SECONDS):
        time = 5_000_000 + tenth * 100_000
        if "attitude" in parts:
            packed += data("attitude", time + 700, time, w, x, y, z)
        if tenth % 10 == 0 and "position" in parts:
            place = ORIGIN[0] + tenth / 10 * NORTH_DEG, ORIGIN[1], ORIGIN[2] - 20, ORIGIN[2]
            packed += data("position", time + 900, time, *place)
        if tenth % 10 == 0 and "gps" in parts:
            packed += data("gps", time, STARTED_US + time, 3 if tenth else 0)
    path.write_bytes(packed)


def message(kind, body):
    return struct.pack("<HB", len(body), ord(kind)) + body


def dataflash(path, names=("ATT", "POS", "GPS")):
    kinds = {
        "FMT": (128, "BBnNZ", "Type,Length,Name,Format,Columns", "<BB4s16s64s"),
        "ATT": (10, "Qccc", "TimeUS,Roll,Pitch,Yaw", "<Qhhh"),
        "POS": (11, "QLLf", "TimeUS,Lat,Lng,Alt", "<Qiif"),
        "GPS": (12, "QBBIH", "TimeUS,I,Status,GMS,GWk", "<QBBIH"),
    }

    def row(name, *values):
        return b"\xa3\x95" + bytes([kinds[name][0]]) + struct.pack(kinds[name][3], *values)

    packed = b""
    for name, (number, layout, columns, form) in kinds.items():
        size = 3 + struct.calcsize(form)
        packed += row("FMT", number, size, name.encode(), layout.encode(), columns.encode())
    for tenth in range(10 * N_SECONDS):
        time = 5_000_000 + tenth * 100_000
        if "ATT" in names:
            packed += row("ATT", time, 500, -1000, 3000)
        if tenth % 10 == 0 and "POS" in names:
            place = round((ORIGIN[0] + tenth / 10 * NORTH_DEG) * 1e7), round(ORIGIN[1] * 1e7)
            packed += row("POS", time, *place, ORIGIN[2])
        if tenth % 10 == 0 and "GPS" in names:
            packed += row("GPS", time, 0, 3 if tenth else 1, OF_WEEK_MS + time // 1000, WEEK)
            packed += row("GPS", time, 1, 3, OF_WEEK_MS + time // 1000 + 500, WEEK)
    path.write_bytes(packed)


FORMATS = {
    "px4": (Px4Section, ulog, ("attitude", "position", "gps"), "pyulog"),
    "ardupilot": (ArdupilotSection, dataflash, ("ATT", "POS", "GPS"), "pymavlink"),
}


def read(name, folder, **keys):
    return read_navigation(FORMATS[name][0](format=name, file="flight.*", **keys), folder)


@pytest.mark.parametrize("name", FORMATS)
def test_flight(tmp_path, name, caplog):
    pytest.importorskip(FORMATS[name][3])
    FORMATS[name][1](tmp_path / "flight.log")
    assert recognised(tmp_path / "flight.log") == (name, {})
    record = read(name, tmp_path, origin=ORIGIN)
    seconds = np.arange(10 * N_SECONDS - 9) / 10
    np.testing.assert_array_equal(record.log.time_us, STARTED_US + 5_000_000 + np.rint(seconds * 1e6))
    np.testing.assert_allclose(record.log.position_m[:, 0], seconds, atol=0.02)
    np.testing.assert_allclose(record.log.position_m[:, 1:], 0, atol=0.02)
    np.testing.assert_allclose(np.rad2deg(record.log.euler_rad), [[5, -10, 30]] * len(seconds), atol=1e-3)
    assert record.covariances is None
    assert "which come late by up to 0.2 s" in caplog.text


@pytest.mark.parametrize(("name", "at"), [(name, at) for name in FORMATS for at in range(3)])
def test_message_that_is_missing_is_one_line(tmp_path, name, at):
    _, write, parts, package = FORMATS[name]
    pytest.importorskip(package)
    write(tmp_path / "flight.log", [part for part in parts if part != parts[at]])
    with pytest.raises(InputError, match=r"flight.log: found 0 messages \w+, expected two or more; log \w+ throughout"):
        read(name, tmp_path)


@pytest.mark.parametrize("name", FORMATS)
@pytest.mark.parametrize("content", [b"", b"ULog\x01\x12\x35\x01", b"\xa3\x95\x80", b"text\n"])
def test_file_of_another_kind_is_one_line(tmp_path, name, content):
    pytest.importorskip(FORMATS[name][3])
    (tmp_path / "flight.log").write_bytes(content)
    with pytest.raises(InputError) as error:
        read(name, tmp_path)
    assert "\n" not in str(error.value)


def test_zeros_are_no_log_of_ardupilot_without_a_search_byte_by_byte(tmp_path, monkeypatch):
    monkeypatch.setattr("linepose.inputs.navigation.ardupilot.package", lambda name, path: None)
    (tmp_path / "flight.log").write_bytes(bytes(100))
    with pytest.raises(InputError, match=r"flight.log: found no description of messages, expected a whole ArduPilot"):
        read("ardupilot", tmp_path)


@pytest.mark.parametrize(("name", "share", "noise"), [("px4", 0.8, b"\xff"), ("ardupilot", 0.5, b"\0\1\2")])
def test_broken_parts_are_told_in_one_line_and_nothing_is_printed(tmp_path, name, share, noise, caplog, capfd):
    _, write, _, package = FORMATS[name]
    pytest.importorskip(package)
    write(tmp_path / "flight.log")
    whole = (tmp_path / "flight.log").read_bytes()
    middle = int(share * len(whole))
    (tmp_path / "flight.log").write_bytes(whole[:middle] + noise * 20 + whole[middle:])
    read(name, tmp_path)
    told = [one for one in caplog.messages if "parts of the log are broken and left out" in one]
    assert len(told) == 1
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("name", FORMATS)
def test_extra_that_is_not_installed_is_named(tmp_path, name, monkeypatch):
    _, write, _, package = FORMATS[name]
    write(tmp_path / "flight.log")
    for module in (package, f"{package}.DFReader"):
        monkeypatch.setitem(sys.modules, module, None)
    told = rf"flight.log: found no package {package}, .*; pip install 'linepose\[autopilot\]'"
    with pytest.raises(InputError, match=told):
        read(name, tmp_path)


def test_attitudes_before_the_estimator_has_one_are_left_out(tmp_path, caplog):
    """Zeros and NaN, which are no rotation."""
    pytest.importorskip("pyulog")
    ulog(tmp_path / "a.ulg")
    content = (tmp_path / "a.ulg").read_bytes()
    x, y, z, w = Rotation.from_euler("ZYX", [30, -10, 5], degrees=True).as_quat()
    for values in ([0.0] * 4, [np.nan] * 4):
        content = content.replace(struct.pack("<4f", w, x, y, z), struct.pack("<4f", *values), 1)
    (tmp_path / "a.ulg").write_bytes(content)
    record = read_navigation(Px4Section(format="px4", file="a.ulg"), tmp_path)
    assert len(record.log.time_us) == 10 * (N_SECONDS - 1) + 1 - 2
    assert f"2 of {10 * N_SECONDS} messages with an orientation of zeros or no numbers are left out" in caplog.text


@pytest.mark.parametrize("kind", ["vehicle_attitude", "vehicle_global_position", "vehicle_gps_position"])
def test_messages_without_their_time_are_told(tmp_path, kind):
    pytest.importorskip("pyulog")
    ulog(tmp_path / "a.ulg")
    content = (tmp_path / "a.ulg").read_bytes()
    named = f"{kind}:uint64_t timestamp;".encode()
    (tmp_path / "a.ulg").write_bytes(content.replace(named, named.replace(b"timestamp", b"timestomp")))
    with pytest.raises(InputError, match=rf"a.ulg: found {kind} without timestamp, expected"):
        read_navigation(Px4Section(format="px4", file="a.ulg"), tmp_path)

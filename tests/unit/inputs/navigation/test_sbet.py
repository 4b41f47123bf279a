import errno

import numpy as np
import pytest

from linepose.errors import InputError
from linepose.inputs import gps_time
from linepose.inputs.navigation import read_navigation
from linepose.inputs.navigation.sbet import SbetSection
from linepose.inputs.source import ScansSection
from unit.inputs import writers
from unit.inputs.drive import ORIGIN


def section(**keys):
    return SbetSection(format="sbet", **({"file": "a.sbet"} | keys))


@pytest.mark.devices
def test_real_trajectory(samples):
    """PDAL's two records: their numbers, as another program prints them."""
    record = read_navigation(section(file="sbet/2-points.sbet", gps_week=1774), samples)
    assert record.origin == pytest.approx(
        (np.rad2deg(0.5680211852972264), np.rad2deg(-2.04165439230394), 107.71529532965604)
    )
    of_week = gps_time.gps_from_unix(record.log.time_us) - 1774 * gps_time.WEEK_US
    np.testing.assert_array_equal(of_week, [151_631_002_836, 151_631_007_832])
    heading = 3.0467732302786623 + 0.021984147369226575  # minus a wander angle that is negative
    np.testing.assert_allclose(
        record.log.euler_rad[0], [-0.028134071493213387, -0.024299053938891393, heading], atol=1e-12
    )


@pytest.mark.devices
def test_real_trajectory_of_two_records_cut_by_a_byte_is_refused(samples, caplog):
    with pytest.raises(InputError, match=r"badfile.sbet: found 1 poses, expected two or more"):
        read_navigation(section(file="sbet/badfile.sbet", gps_week=1774), samples)
    assert "badfile.sbet: the file is cut: 135 bytes after its 1 whole records are passed over" in caplog.text


def test_heading_is_true_whatever_the_wander_angle(tmp_path, drive):
    records = []
    for wander in (-0.7, 0.0, 2.9):
        writers.write_sbet(tmp_path / "a.sbet", drive, wander)
        records.append(read_navigation(section(gps_week=int(drive.week[0])), tmp_path))
    np.testing.assert_allclose(records[0].log.euler_rad, records[1].log.euler_rad, atol=1e-12)
    np.testing.assert_allclose(records[2].log.euler_rad, records[1].log.euler_rad, atol=1e-12)


def test_week_is_that_of_the_scans(tmp_path, drive):
    writers.write_sbet(tmp_path / "a.sbet", drive)
    (tmp_path / "scans").mkdir()
    (tmp_path / "scans" / "one.hdr").touch()
    (tmp_path / "scans" / "one-times.csv").write_text(f"time_us\n{drive.time_us[3]}\n{drive.time_us[4]}\n")
    source = ScansSection(kind="scans", dataset="x", navigation={"format": "sbet", "file": "a.sbet"})
    np.testing.assert_array_equal(read_navigation(source, tmp_path).log.time_us, drive.time_us)
    with pytest.raises(InputError, match=r"seconds of the GPS week without the week.*set source.navigation.gps_week"):
        read_navigation(source.navigation, tmp_path)


@pytest.mark.parametrize(
    ("file", "keys", "told"),
    [
        ("a.sbet", {"file": "b.sbet"}, r"b.sbet: found no such file"),
        (
            "other",
            {},
            r"a.sbet: found 9591 bytes, 70 whole records and 71 bytes more.*a multiple of 136 .*another format",
        ),
        ("a.sbet", {}, r"record 1: found nan as its time"),
        ("degrees", {}, r"a.sbet, record 1: found latitude -1941.71, longitude 8662.76 deg"),
        (
            "turned",
            {},
            r"a.sbet, record 2: found roll, pitch, yaw 9, .* rad, expected at most a full turn; restore the log$",
        ),
        (
            "week",
            {"gps_week": 9999},
            r"a.sbet, record 1: found time .*, expected .*; correct source.navigation.gps_week$",
        ),
        ("sigma", {"rms": "a.rms"}, r"a.rms, covariance 1: found .* or no number, expected .*; remove the record$"),
        ("empty", {}, r"a.sbet: found 0 bytes"),
        (
            "zeros",
            {},
            r"a.sbet, record 1: found zeros alone, expected an SBET trajectory: .*; restore the file: it was",
        ),
    ],
)
def test_broken_file_is_one_line(tmp_path, drive, file, keys, told):
    writers.write_sbet(tmp_path / "a.sbet", drive)
    writers.write_rms(tmp_path / "a.rms", drive)
    table = np.fromfile(tmp_path / "a.sbet").reshape(-1, 17)
    if file == "other":
        (tmp_path / "a.sbet").write_bytes((tmp_path / "a.rms").read_bytes()[:-9])
    elif file == "a.sbet" and not keys:
        table[0, 0] = np.nan
        table.tofile(tmp_path / file)
    elif file == "zeros":
        (tmp_path / "a.sbet").write_bytes(bytes(136 * 3))
    elif file == "degrees":
        table[:, 1:3] = np.rad2deg(table[:, 1:3])
        table.tofile(tmp_path / "a.sbet")
    elif file == "turned":
        table[1, 7] = 9.0
        table.tofile(tmp_path / "a.sbet")
    elif file == "sigma":
        rms = np.fromfile(tmp_path / "a.rms").reshape(-1, 10)
        rms[0, 1] = np.nan
        rms.tofile(tmp_path / "a.rms")
    elif file == "empty":
        (tmp_path / "a.sbet").write_bytes(b"")
    with pytest.raises(InputError, match=told) as error:
        read_navigation(section(**{"gps_week": int(drive.week[0]), "origin": ORIGIN} | keys), tmp_path)
    assert "\n" not in str(error.value)


def test_a_file_that_memory_cannot_map_is_told(tmp_path, drive, monkeypatch):
    def full(*_, **__):
        raise OSError(errno.ENOMEM, "Cannot allocate memory")

    writers.write_sbet(tmp_path / "a.sbet", drive)
    size = (tmp_path / "a.sbet").stat().st_size
    monkeypatch.setattr(np, "memmap", full)
    with pytest.raises(InputError, match=rf"a.sbet: found {size} bytes, expected an SBET trajectory that .*ulimit -v"):
        read_navigation(section(), tmp_path)


def test_what_was_cut_within_a_record_is_read_up_to_it(tmp_path, drive, caplog):
    writers.write_sbet(tmp_path / "a.sbet", drive)
    writers.write_rms(tmp_path / "a.rms", drive)
    (tmp_path / "a.sbet").write_bytes((tmp_path / "a.sbet").read_bytes()[:-9])
    (tmp_path / "a.rms").write_bytes((tmp_path / "a.rms").read_bytes()[:-81])
    record = read_navigation(section(gps_week=int(drive.week[0]), origin=ORIGIN, rms="a.rms"), tmp_path)
    np.testing.assert_array_equal(record.log.time_us, drive.time_us[:-1])
    np.testing.assert_array_equal(record.covariances.time_us, drive.time_us[:-2])
    count = len(drive.time_us)
    for told in (
        f"a.sbet: the file is cut: 127 bytes after its {count - 1}",
        "a.rms: the file is cut: 79 bytes after",
    ):
        assert told in caplog.text


def test_every_file_is_one_that_the_workflow_watches(tmp_path, drive):
    writers.write_sbet(tmp_path / "a.sbet", drive)
    writers.write_rms(tmp_path / "a.rms", drive)
    assert section(rms="*.rms").files(tmp_path) == {tmp_path / "a.sbet", tmp_path / "a.rms"}


def test_records_without_numbers_are_left_out(tmp_path, drive, caplog):
    """As before the first solution; a place or an angle that is none does not refuse the file."""
    writers.write_sbet(tmp_path / "a.sbet", drive)
    table = np.fromfile(tmp_path / "a.sbet").reshape(-1, 17)
    table[0, 1], table[3, 8] = np.nan, np.inf
    table.tofile(tmp_path / "a.sbet")
    record = read_navigation(section(gps_week=int(drive.week[0]), origin=ORIGIN), tmp_path)
    np.testing.assert_array_equal(record.log.time_us, np.delete(drive.time_us, [0, 3]))
    assert "a.sbet: 2 records without a value are left out" in caplog.text

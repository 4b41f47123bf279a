import numpy as np
import pytest

from linepose.errors import InputError
from linepose.inputs.navigation import read_navigation
from linepose.inputs.navigation.resonon import ResononSection
from unit.inputs import writers
from unit.inputs.drive import ORIGIN

SECTION = ResononSection(format="resonon", file="a.lcf", origin=ORIGIN)


def test_right_wing_up_is_a_negative_roll(tmp_path):
    row = "1150035200.{} 0.1 0.02 1.5 151.1937 -33.8892 42.5 0 0 5\n"
    (tmp_path / "a.lcf").write_text(row.format(0) + row.format(1))
    record = read_navigation(SECTION, tmp_path)
    np.testing.assert_allclose(record.log.euler_rad[0], [-0.1, 0.02, 1.5], atol=1e-12)
    np.testing.assert_allclose(record.log.position_m[0], 0, atol=1e-8)
    assert record.log.time_us[0] == (1_150_035_200 + 315_964_800 - 17) * 1_000_000


def test_unix_time(tmp_path, drive):
    writers.write_location(tmp_path / "a.lcf", drive)
    section = SECTION.model_copy(update={"time_scale": "unix"})
    np.testing.assert_array_equal(read_navigation(section, tmp_path).log.time_us, drive.gps_us)


def test_rows_not_to_be_used_are_left_out(tmp_path, drive):
    writers.write_location(tmp_path / "a.lcf", drive)
    lines = (tmp_path / "a.lcf").read_text().splitlines()
    lines[1] = lines[1].replace(" 0 0 5 ", " 0 0 0 ")
    (tmp_path / "a.lcf").write_text("\n".join(lines))
    times = read_navigation(SECTION, tmp_path).log.time_us
    np.testing.assert_array_equal(times, np.delete(drive.time_us, 1))


def test_a_last_row_that_was_cut_is_passed_over(tmp_path, drive, caplog):
    writers.write_location(tmp_path / "a.lcf", drive)
    text = (tmp_path / "a.lcf").read_text().rstrip()
    (tmp_path / "a.lcf").write_text("\ufeff" + text[: -len(text.splitlines()[-1]) // 2])
    np.testing.assert_array_equal(read_navigation(SECTION, tmp_path).log.time_us, drive.time_us[:-1])
    assert "a.lcf: the last row was cut and is passed over" in caplog.text


@pytest.mark.parametrize(
    ("content", "told"),
    [
        ("", r"a.lcf: found an empty file"),
        ("1 2 3\n", r"a.lcf, row 1: found 3 columns, expected 7 columns: time, roll, pitch, heading, longitude"),
        ("1150035200.0 0 0 0 151 -33 42\n1 2 3 4 5 6\n" * 2, r"row 2: found 6 columns, expected 7 columns"),
        ("time roll\n", r"a.lcf, row 1: found 'time roll', expected numbers apart by spaces"),
        ("1150035200.0 0 0 0 -33 151 42\n" * 2, r"record 1: found latitude 151, longitude -33 deg"),
    ],
)
def test_broken_file_is_one_line(tmp_path, content, told):
    (tmp_path / "a.lcf").write_text(content)
    with pytest.raises(InputError, match=told):
        read_navigation(SECTION, tmp_path)


def test_bytes_that_are_no_text_are_told(tmp_path):
    (tmp_path / "a.lcf").write_bytes(b"\xaaD\x13\xff\x00")
    with pytest.raises(InputError, match=r"a.lcf: found bytes that are not text"):
        read_navigation(SECTION, tmp_path)


def test_times_before_such_devices_were_built_are_told(tmp_path, caplog):
    """A receiver that lost the rollover of the GPS week counts from 1996 in 2016."""
    rows = [
        f"{521_400_000 + 0.005 * row:.3f}\t0.0167\t-0.0368\t2.589\t8.0\t50.0\t424.0\t0\t0\t5\t4\n" for row in range(9)
    ]
    (tmp_path / "run.lcf").write_text("".join(rows))
    read_navigation(ResononSection(format="resonon", file="run.lcf"), tmp_path)
    assert "run.lcf: times of 1996-07-" in caplog.text
    assert "may have lost 1024 GPS weeks (2016-02-" in caplog.text

import numpy as np
import pytest
from PIL import Image

from linepose.errors import InputError
from linepose.inputs.scans.line_times import first_time_us, line_times_of
from linepose.inputs.scans.scan_files import read_scan
from linepose.inputs.source import ScansSection
from linepose.simulation import envi

START_US = 1_700_000_000_250_000
GPS_S = (START_US - 315_964_800_000_000 + 18_000_000) / 1e6
LINES = np.arange(5) * 7_500


def source(**keys):
    return ScansSection(kind="scans", dataset="x", **keys)


def times(scan, **keys):
    return line_times_of(source(**keys))(scan, 5)


def touched(path):
    path.touch()
    return path


def location(path, first_s=GPS_S):
    path.write_text("".join(f"{first_s + 0.02 * row:.6f} 0 0 0 151 -33 42 0 0 5\n" for row in range(9)))


def frames(path, rows=None, heading="Frame#\tTimestamp\n"):
    rows = [f"{2000 + row}\t{START_US + time}" for row, time in enumerate(LINES)] if rows is None else rows
    path.write_text(heading + "\n".join(rows) + "\n")


@pytest.mark.parametrize(
    ("scan", "stamps"),
    [
        ("run.hdr", "run.times"),
        ("run.bil.hdr", "run.bil.times"),
        ("run.bil.hdr", "run.times"),
        ("run-radiance.bil.hdr", "run.bil.times"),
        ("run.png", "run.bil.times"),
    ],
)
@pytest.mark.parametrize("epoch", [0.0, 1_234.5, GPS_S])
def test_resonon_counts_from_the_location_files_first_row(tmp_path, scan, stamps, epoch):
    location(tmp_path / "run.lcf")
    (tmp_path / stamps).write_text("".join(f"{epoch + time / 1e6:.6f}\n" for time in LINES))
    np.testing.assert_array_equal(times(touched(tmp_path / scan), time_stamps="resonon"), START_US + LINES)


@pytest.mark.parametrize("heading", ["Frame#\tTimestamp\n", "frame timestamp\n", ""])
@pytest.mark.parametrize("scan", ["raw_2000.hdr", "raw_2000_rd.hdr"])
def test_headwall_goes_by_the_number_in_the_name(tmp_path, scan, heading):
    frames(tmp_path / "frameIndex_2000.txt", heading=heading)
    np.testing.assert_array_equal(times(touched(tmp_path / scan), time_stamps="headwall"), START_US + LINES)


def test_clock_of_the_time_stamps(tmp_path):
    (tmp_path / "a-times.csv").write_text("\n".join(str(round(GPS_S * 1e6) + time) for time in LINES))
    np.testing.assert_array_equal(times(tmp_path / "a.png", time_scale="gps"), START_US + LINES)
    frames(tmp_path / "frameIndex_0.txt", [f"{row}\t{round(GPS_S * 1e6) + time}" for row, time in enumerate(LINES)])
    scan = touched(tmp_path / "raw_0.hdr")
    np.testing.assert_array_equal(times(scan, time_stamps="headwall", time_scale="gps"), START_US + LINES)
    location(tmp_path / "b.lcf", START_US / 1e6)
    (tmp_path / "b.times").write_text("\n".join(f"{time / 1e6}" for time in LINES))
    np.testing.assert_array_equal(times(tmp_path / "b.hdr", time_stamps="resonon", time_scale="unix"), START_US + LINES)


def test_scan_is_read_with_them(tmp_path):
    (tmp_path / "scans").mkdir()
    envi.write_scan(tmp_path / "scans" / "raw_0", iter([np.ones((5, 2, 8), np.uint16)]), np.array([500.0, 600.0]))
    frames(tmp_path / "scans" / "frameIndex_0.txt")
    mine = source(time_stamps="headwall")
    scan = read_scan(tmp_path / "scans" / "raw_0.hdr", line_times_of(mine))
    np.testing.assert_array_equal(scan.time_us, START_US + LINES)
    assert scan.intensity.shape == (5, 8)
    assert first_time_us(mine, tmp_path) == START_US
    assert {path.name for path in mine.files(tmp_path)} >= {"raw_0.hdr", "raw_0.bil", "frameIndex_0.txt"}


def test_resonons_names_of_cubes_are_read(tmp_path):
    """run.bil with run.bil.hdr, as Spectronon saves them."""
    envi.write_scan(tmp_path / "run", iter([np.full((5, 2, 8), 3, np.uint16)]), np.array([500.0, 600.0]))
    (tmp_path / "run.hdr").rename(tmp_path / "run.bil.hdr")
    location(tmp_path / "run.lcf")
    (tmp_path / "run.bil.times").write_text("\n".join(f"{time / 1e6}" for time in LINES))
    (tmp_path / "run.lcf").rename(tmp_path / "run.LCF")
    mine = source(scans="*.hdr", time_stamps="resonon")
    scan = read_scan(tmp_path / "run.bil.hdr", line_times_of(mine))
    assert np.all(scan.intensity == 3)
    assert {path.name for path in mine.files(tmp_path)} >= {"run.bil", "run.bil.hdr", "run.bil.times", "run.LCF"}


@pytest.mark.parametrize(
    ("kind", "write", "told"),
    [
        ("csv", lambda d: None, r"raw_7-times.csv: found no such file"),
        (
            "headwall",
            lambda d: None,
            r"raw_7.png: found no frameIndex_7.txt beside it, expected what its time stamps are made of; put",
        ),
        (
            "headwall",
            lambda d: frames(d / "frameIndex_7.txt", ["1\t2\t3"]),
            r"frameIndex_7.txt, row 2: found '1\\t2\\t3'",
        ),
        (
            "headwall",
            lambda d: frames(d / "frameIndex_7.txt", ["1\tnoon"]),
            r"row 2: found '1\\tnoon', expected a frame",
        ),
        (
            "headwall",
            lambda d: frames(d / "frameIndex_7.txt", ["1\t5"]),
            r"found 1 time stamps, expected 5, one for each",
        ),
        ("headwall", lambda d: (d / "frameIndex_7.txt").touch(), r"frameIndex_7.txt: found an empty file"),
        (
            "headwall",
            lambda d: frames(d / "frameIndex_7.txt", [f"{row}\t{START_US - row}" for row in range(5)]),
            r"frameIndex_7.txt, row 3: found time .*, expected a time after the line before it",
        ),
        (
            "headwall",
            lambda d: frames(d / "frameIndex_7.txt", [f"{row}\t{START_US // 1000 + row}" for row in range(5)]),
            r"they look like milliseconds: multiply by 1000",
        ),
        ("resonon", lambda d: location(d / "raw_7.lcf"), r"raw_7.png: found no raw_7.times or .* beside it"),
        ("resonon", lambda d: (d / "raw_7.times").write_text("0\n1\n"), r"raw_7.png: found no raw_7.lcf beside it"),
        (
            "resonon",
            lambda d: (location(d / "raw_7.lcf"), (d / "raw_7.times").write_text("0\nx\n")),
            r"raw_7.times, row 2: found 'x', expected a time in seconds",
        ),
        (
            "resonon",
            lambda d: (location(d / "raw_7.lcf"), (d / "raw_7.times").write_text("0\n1\n2\n")),
            r"raw_7.times: found 3 time stamps, expected 5",
        ),
    ],
)
def test_broken_time_stamps_are_one_line(tmp_path, kind, write, told):
    Image.new("L", (8, 5)).save(tmp_path / "raw_7.png")
    write(tmp_path)
    with pytest.raises(InputError, match=told) as error:
        read_scan(tmp_path / "raw_7.png", line_times_of(source(time_stamps=kind)))
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("name", ["flight2_raw_2000.hdr", "2_RAW_2000-rd7.hdr"])
def test_other_numbers_in_headwalls_name_do_not_count(tmp_path, name):
    frames(tmp_path / "frameIndex_2000.txt")
    frames(tmp_path / "frameIndex_2.txt", [f"{row}\t{START_US + 60_000_000 + time}" for row, time in enumerate(LINES)])
    np.testing.assert_array_equal(times(touched(tmp_path / name), time_stamps="headwall"), START_US + LINES)


@pytest.mark.parametrize("name", ["board.hdr", "flight2.hdr", "draw_2.hdr"])
def test_headwalls_scan_needs_its_number(tmp_path, name):
    frames(tmp_path / "frameIndex_2.txt")
    with pytest.raises(InputError, match=r"found a name without raw_N, expected raw_N.hdr"):
        times(tmp_path / name, time_stamps="headwall")


def test_headwalls_scan_of_two_numbers_is_told(tmp_path):
    with pytest.raises(InputError, match=r"found a name with several raw_N"):
        times(tmp_path / "raw_0_raw_2.hdr", time_stamps="headwall")

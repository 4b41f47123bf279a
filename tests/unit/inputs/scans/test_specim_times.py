import numpy as np
import pytest

from linepose.errors import InputError
from linepose.inputs.scans.specim_times import specim_times

START_US = 1_714_557_600_020_000  # 2024-05-01 10:00:00.02 UTC
HEADER = {
    "samples": "4",
    "bands": "1",
    "lines": "200",
    "interleave": "bil",
    "data type": "12",
    "byte order": "0",
    "header offset": "0",
    "fps": "50.00",
    "acquisition date": "DATE(yyyy-mm-dd): 2024-05-01",
    "Start Time": "UTC TIME: 10:00:00",
}


def scan(folder, synchronised=None, **header):
    """Stamps `synchronised` of seconds and frames, counted from 1."""
    words = {key: value for key, value in {**HEADER, **header}.items() if value}
    (folder / "scan.hdr").write_text("ENVI\n" + "".join(f"{key} = {value}\n" for key, value in words.items()))
    (folder / "scan.raw").write_bytes(bytes(2 * 4 * 200))
    if synchronised is not None:
        rows = [f"$PASHR,1000{second:05.2f},40,T,2,5,0,,,,2,1\n$SPTSMP,1,{frame},0\n" for second, frame in synchronised]
        (folder / "scan.nav").write_text("".join(rows))
    return folder / "scan.hdr"


@pytest.mark.parametrize("frames", [[(0.02, 1), (1.02, 51), (2.02, 101)], [(1.02, 51)], [(0.52, 26), (2.02, 101)]])
def test_lines_between_and_beyond_the_frames_with_a_time(tmp_path, frames):
    times, path = specim_times(scan(tmp_path, frames))
    np.testing.assert_array_equal(times, START_US + 20_000 * np.arange(200))
    assert path.name == "scan.nav"


def test_rate_of_the_frames_where_the_header_has_none(tmp_path):
    times, _ = specim_times(scan(tmp_path, [(0.02, 1), (1.02, 51)], fps=""))
    np.testing.assert_array_equal(times, START_US + 20_000 * np.arange(200))


def test_a_repeated_frame_is_passed_over_and_endings_are_of_any_case(tmp_path, caplog):
    path = scan(tmp_path, [(0.02, 1), (1.02, 51), (1.02, 51)])
    (tmp_path / "scan.nav").rename(tmp_path / "scan.NAV")
    np.testing.assert_array_equal(specim_times(path)[0], START_US + 20_000 * np.arange(200))
    assert "1 $SPTSMP that repeat the one before" in caplog.text


def test_frames_that_miss_the_rate_are_told(tmp_path, caplog):
    times, _ = specim_times(scan(tmp_path, [(0.02, 1), (1.12, 51)]))
    assert times[50] - times[0] == 1_100_000
    assert "times of $SPTSMP miss the rate of 50.000 lines a second by up to 5.0 lines" in caplog.text


@pytest.mark.parametrize("navigation", [None, []])
def test_start_and_rate_of_the_header(tmp_path, caplog, navigation):
    path = scan(tmp_path, navigation)
    if navigation is not None:
        (tmp_path / "scan.nav").write_text("$GPHDT,40.0,T\n")
    times, found = specim_times(path)
    np.testing.assert_array_equal(times, START_US - 20_000 + 20_000 * np.arange(200))
    assert found == path
    assert "may be off by a second" in caplog.text


@pytest.mark.parametrize(
    ("frames", "header", "told"),
    [
        (None, {"fps": ""}, r"scan.hdr: found no scan.nav with \$SPTSMP beside it, and no Start Time and fps"),
        ([(0.02, 1), (1.02, 1)], {}, r"scan.nav: found frame 1 at .* after frame 1 .*remove the \$SPTSMP"),
        ([(0.02, 1)], {"fps": ""}, r"scan.nav: found one \$SPTSMP and no frame rate.*restore the header"),
        ([(0.02, 1)], {"acquisition date": ""}, r"found no sentence with a date .*set acquisition date in the scan's"),
        ([(0.02, "x")], {}, r"scan.nav, line 2: found 'SPTSMP,1,x,0', expected the number of a frame"),
    ],
)
def test_broken_times_are_one_line(tmp_path, frames, header, told):
    with pytest.raises(InputError, match=told) as error:
        specim_times(scan(tmp_path, frames, **header))
    assert "\n" not in str(error.value)

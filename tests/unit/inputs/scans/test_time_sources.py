"""Line times of HySpex, of a receiver's events, of a start and a rate, and of files under other names."""

import datetime

import numpy as np
import pytest

from linepose.errors import InputError
from linepose.inputs.scans.line_times import first_time_us, line_times_of
from linepose.inputs.source import ScansSection
from linepose.settings import validated
from unit.inputs import novatel_writer

WEEK, OF_WEEK_S = 2290, 280_800.0  # 2023-11-29 06:00:00 GPS time
START_US = 315_964_800_000_000 + WEEK * 604_800_000_000 + 280_800_000_000 - 18_000_000
LINES = np.arange(5) * 10_000
HEADER = """ENVI
samples = 8
lines = 5
bands = 1
data type = 12
interleave = bil
byte order = 0
header offset = 0
"""


def scan_of(folder, name="run-01", more=""):
    (folder / f"{name}.raw").write_bytes(bytes(5 * 8 * 2))
    path = folder / f"{name}.hdr"
    path.write_text(HEADER + more)
    return path


def times(scan, **keys):
    source = validated(ScansSection, {"kind": "scans", "dataset": "x", "scans": "*.hdr"} | keys, "source")
    return line_times_of(source)(scan, 5)


def nav_text(path, first_s=OF_WEEK_S, rows=5, above=""):
    lines = [f"{row} 10.5 60.25 250.5 0.1 0.2 30.0 {first_s + row * 0.01:.3f}" for row in range(rows)]
    path.write_text(above + "\n".join(lines) + "\n")


@pytest.mark.parametrize(
    ("more", "keys"), [("", {"gps_week": WEEK}), ("acquisition date = DATE(yyyy-mm-dd): 2023-11-29\n", {})]
)
@pytest.mark.parametrize("above", ["", "frame lon lat alt roll pitch heading time\n", "\ufefffra;lon\n"])
def test_hyspex_times_are_the_last_column(tmp_path, more, keys, above):
    scan = scan_of(tmp_path, more=more)
    nav_text(tmp_path / "run-01.txt", above=above)
    np.testing.assert_array_equal(times(scan, time_stamps="hyspex", **keys), START_US + LINES)
    (tmp_path / "run-01.txt").rename(tmp_path / "run-01_nav.txt")
    found = times(scan, time_stamps="hyspex", time_file="{name}_nav.txt", **keys)
    np.testing.assert_array_equal(found, START_US + LINES)


@pytest.mark.parametrize("decimal", [".", ","])
@pytest.mark.parametrize(
    ("between", "end"),
    [("\t", ""), (" ", ""), ("   ", "  "), (";", ""), ("; ", ";"), ("\t", "\t"), (",", ","), (", ", "")],
)
def test_hyspex_rows_have_one_sign_between_their_cells(tmp_path, between, end, decimal):
    scan, path = scan_of(tmp_path), tmp_path / "run-01.txt"
    nav_text(path)
    rows = path.read_text().replace(".", decimal).replace(" ", between).splitlines()
    path.write_text("".join(f"{row}{end}\n" for row in rows))
    if decimal == between.strip():
        with pytest.raises(InputError, match=r"run-01.txt, row 1: found .*, expected 8 numbers"):
            times(scan, time_stamps="hyspex", gps_week=WEEK)
    else:
        np.testing.assert_array_equal(times(scan, time_stamps="hyspex", gps_week=WEEK), START_US + LINES)


def test_hyspex_whole_seconds_beside_decimal_commas(tmp_path):
    """Taken apart at commas, the eighth cell would be the whole part of the roll."""
    scan = scan_of(tmp_path)
    rows = [f"{row}\t10,51\t59,91\t899,84\t0,1\t0,2\t30,0\t{OF_WEEK_S + row:.0f}\n" for row in range(5)]
    (tmp_path / "run-01.txt").write_text("".join(rows))
    found = times(scan, time_stamps="hyspex", gps_week=WEEK)
    np.testing.assert_array_equal(found, START_US + LINES * 100)


def event(name, second, status="VALID"):
    fields = [f"{WEEK}", f"{second:.6f}", "0.0", "0.0", "-18.0", status]
    if name.endswith("PVA"):
        place = ["60.25", "10.5", "250.5", "0.1", "0.2", "0.3", "0.1", "0.2", "30.0"]
        fields = [f"{WEEK}", f"{second:.6f}", *place, "INS_SOLUTION_GOOD"]
    return novatel_writer.ascii_(name, WEEK, second, fields)


def events(path, starts_s, name="MARK2TIME"):
    path.write_bytes(b"".join(event(name, start_s + row * 0.01) for start_s in starts_s for row in range(5)))


@pytest.mark.parametrize("name", ["MARKTIME", "MARK1TIME", "MARK2TIME", "MARK1PVA", "MARK2PVA"])
def test_events_of_a_receiver_are_lines(tmp_path, name):
    scan = scan_of(tmp_path)
    events(tmp_path / "run-01.gps", [OF_WEEK_S], name)
    np.testing.assert_array_equal(times(scan, time_stamps="novatel"), START_US + LINES)
    np.testing.assert_array_equal(times(scan, time_stamps="novatel", event=name), START_US + LINES)


def test_one_log_of_a_scan_whose_name_has_the_signs_of_a_pattern(tmp_path):
    scan = scan_of(tmp_path, "run[1]")
    events(tmp_path / "drive.gps", [OF_WEEK_S])
    found = times(scan, time_stamps="novatel", time_file="drive.gps", scans="run[1].hdr")
    np.testing.assert_array_equal(found, START_US + LINES)


def test_events_that_were_logged_twice_or_without_a_valid_clock_are_told(tmp_path, caplog):
    scan = scan_of(tmp_path)
    events(tmp_path / "run-01.gps", [OF_WEEK_S], "MARKTIME")
    log = (tmp_path / "run-01.gps").read_bytes()
    (tmp_path / "run-01.gps").write_bytes(log + log)
    np.testing.assert_array_equal(times(scan, time_stamps="novatel", event="marktimea"), START_US + LINES)
    assert "run-01.gps: 5 events at the time of another are passed over" in caplog.text
    later = event("MARKTIME", OF_WEEK_S + 1, "INVALID")
    (tmp_path / "run-01.gps").write_bytes(log + later + later)
    with pytest.raises(InputError, match="6 time stamps"):  # nothing tells which is of no line
        times(scan, time_stamps="novatel")
    assert "1 events while the receiver's clock was not valid" in caplog.text


def test_events_without_a_valid_clock_that_are_not_used_are_not_told(tmp_path, caplog):
    """Those of another kind, and those that were logged again when the clock was valid."""
    scan = scan_of(tmp_path)
    events(tmp_path / "run-01.gps", [OF_WEEK_S], "MARKTIME")
    log = (tmp_path / "run-01.gps").read_bytes()
    unused = event("MARK2TIME", OF_WEEK_S, "INVALID") + event("MARKTIME", OF_WEEK_S, "INVALID")
    (tmp_path / "run-01.gps").write_bytes(unused + log)
    np.testing.assert_array_equal(times(scan, time_stamps="novatel", event="MARKTIME"), START_US + LINES)
    assert "1 events at the time of another" in caplog.text
    assert "not valid" not in caplog.text


def test_one_log_of_events_holds_a_burst_a_scan(tmp_path):
    first, second = scan_of(tmp_path), scan_of(tmp_path, "run-02")
    events(tmp_path / "drive.gps", [OF_WEEK_S, OF_WEEK_S + 60])
    keys = {"time_stamps": "novatel", "time_file": "drive.gps"}
    np.testing.assert_array_equal(times(first, **keys), START_US + LINES)
    np.testing.assert_array_equal(times(second, **keys), START_US + 60_000_000 + LINES)
    scan_of(tmp_path, "run-03")
    with pytest.raises(InputError, match=r"drive.gps: found 2 bursts of events, expected 3, one a scan"):
        times(first, **keys)


@pytest.mark.parametrize("start", ["2026-05-01T12:00:00.25Z", "2026-05-01T14:00:00.25+02:00", "2026-05-01 12:00:00.25"])
def test_start_and_rate_of_keys(tmp_path, start):
    keys = {"time_stamps": "rate", "line_rate_hz": 100.0, "start_times": {"run-01": start}}
    first_us = 1_777_636_800_250_000
    assert (
        datetime.datetime.fromtimestamp(first_us / 1e6, datetime.UTC).isoformat() == "2026-05-01T12:00:00.250000+00:00"
    )
    np.testing.assert_array_equal(times(scan_of(tmp_path), **keys), first_us + LINES)
    np.testing.assert_array_equal(times(scan_of(tmp_path), time_scale="gps", **keys), first_us - 18_000_000 + LINES)


@pytest.mark.parametrize(
    "more",
    [
        "fps = 100\nacquisition date = DATE(yyyy-mm-dd): 2026-05-01\nStart Time = UTC TIME: 12:00:00.25\n",
        "framerate = 100.000\nacquisition time = 2026-05-01T12:00:00.25Z\n",
        "fps = 100,0\nacquisition time = 2026-05-01T14:00:00.25+02:00\n",
        "frame rate = 1e2 Hz\nacquisition time = {2026-05-01T12:00:00.25Z}\n",
        "fps = {100}\nacquisition date = DATE(dd-mm-yyyy): 01-05-2026\nStart Time = UTC TIME: 12:00:00.25\n",
        "fps = 100\nacquisition date = DATE(yyyy-mm-dd): 2026-05-01\nStart Time = UTC TIME: 12:00:00\n"
        "GPS Start Time = UTC TIME: 12:00:00.25\n",
        "fps = 100.0 Hz (internal)\nacquisition date = Date: 2026-05-01\nStart Time = 12:00:00.25\n",
        "fps = 100 (nominal)\nacquisition date = DATE(yyyy-mm-dd) : 2026-05-01\nStart Time = 12:00:00.25\n"
        "GPS Start Time = UTC TIME: 00:00:00\n",
    ],
)
def test_start_and_rate_of_the_header(tmp_path, more):
    source = ScansSection(kind="scans", dataset="x", scans="*.hdr", time_stamps="rate")
    scan = scan_of(tmp_path, more=more)
    np.testing.assert_array_equal(times(scan, time_stamps="rate"), 1_777_636_800_250_000 + LINES)
    assert first_time_us(source, tmp_path) == 1_777_636_800_250_000


def test_start_of_a_receiver_without_time_and_a_rate_of_other_words_are_told(tmp_path, caplog):
    more = "fps = 1,000\nframerate = 100\nacquisition date = DATE(yyyy-mm-dd): 2026-05-01\n"
    scan = scan_of(tmp_path, more=f"{more}Start Time = 12:00:00.25\nGPS Start Time = 00:00:00\n")
    np.testing.assert_array_equal(times(scan, time_stamps="rate"), 1_777_636_800_250_000 + LINES)
    assert f"{scan}: fps = 1,000 is no rate such as 100.0" in caplog.text
    assert f"{scan}: GPS Start Time (00:00:00) is not that of Start Time (12:00:00.25), which is taken" in caplog.text


def test_start_by_the_gps_is_of_the_next_day_past_midnight(tmp_path):
    more = "fps = 100\nacquisition date = DATE(yyyy-mm-dd): 2026-05-01\nStart Time = 23:59:59\n"
    scan = scan_of(tmp_path, more=f"{more}GPS Start Time = 00:00:00.25\n")
    midnight_us = 1_777_680_000_000_000
    np.testing.assert_array_equal(times(scan, time_stamps="rate"), midnight_us + 250_000 + LINES)


def test_headwalls_frames_under_another_name(tmp_path):
    scan = scan_of(tmp_path, "cube_A")
    rows = "".join(f"{row}\t{START_US + time}\n" for row, time in enumerate(LINES))
    (tmp_path / "cube_A-frames.txt").write_text("Frame#\tTimestamp\n" + rows)
    keys = {"time_stamps": "headwall", "time_file": "{name}-frames.txt"}
    np.testing.assert_array_equal(times(scan, **keys), START_US + LINES)
    source = ScansSection(kind="scans", dataset="x", scans="*.hdr", **keys)
    assert tmp_path / "cube_A-frames.txt" in source.files(tmp_path)


@pytest.mark.parametrize(
    ("write", "keys", "told"),
    [
        (lambda d: None, {"time_stamps": "hyspex"}, r"run-01.hdr: found no such file, expected run-01.txt beside it"),
        (lambda d: nav_text(d / "run-01.txt"), {"time_stamps": "hyspex"}, r"without the week, .*; set source.gps_week"),
        (
            lambda d: (d / "run-01.txt").write_text("1 2 3\n"),
            {"time_stamps": "hyspex", "gps_week": WEEK},
            r"run-01.txt, row 1: found '1 2 3', expected 8 numbers",
        ),
        (
            lambda d: (d / "run-01.txt").write_text("1 2 3 4 5 6 7 280800\n2 2 3 4 5 6 7 2_8\n"),
            {"time_stamps": "hyspex", "gps_week": WEEK},
            r"run-01.txt, row 2: found '2 2 3 4 5 6 7 2_8', expected 8 numbers",
        ),
        (
            lambda d: (d / "run-01.txt").write_text("1;2;3;4;5;6;7;280800\n1;2;3;4;5;6;7;;280801\n"),
            {"time_stamps": "hyspex", "gps_week": WEEK},
            r"run-01.txt, row 2: found '1;2;3;4;5;6;7;;280801', expected 8 numbers",
        ),
        (
            lambda d: nav_text(d / "run-01.txt", -1.0),
            {"time_stamps": "hyspex", "gps_week": WEEK},
            r"record 1: found -1.000 s of the GPS week, .*; restore the file, or remove the record$",
        ),
        (
            lambda d: nav_text(d / "run-01.txt", 1.7e18),
            {"time_stamps": "hyspex", "gps_week": WEEK},
            r"found the time 1.7e\+18 s, .*; it looks like ns: write the times in s$",
        ),
        (
            lambda d: (d / "run-01.txt").write_text("frame lon lat\n"),
            {"time_stamps": "hyspex", "gps_week": WEEK},
            r"run-01.txt: found no row of numbers, expected rows of a frame each",
        ),
        (
            lambda d: None,
            {"time_stamps": "rate", "line_rate_hz": 9.0, "start_times": {"run-01": datetime.date(2026, 5, 1)}},
            r"expected a date and time, not the day alone, for run-01",
        ),
        (lambda d: None, {"time_stamps": "rate"}, r"found no rate of the lines, .*; set source.line_rate_hz"),
        (lambda d: None, {"time_stamps": "rate", "line_rate_hz": 9.0}, r"; add run-01 to source.start_times"),
        (
            lambda d: events(d / "run-01.gps", [OF_WEEK_S]),
            {"time_stamps": "novatel", "event": "MARK1TIME"},
            r"run-01.gps: found events MARK2TIME, expected MARK1TIME",
        ),
        (
            lambda d: None,
            {"time_file": "{number}.txt"},
            r"time_file: found '\{number\}.txt', expected a file's name in",
        ),
    ],
)
def test_what_is_missing_is_one_line(tmp_path, write, keys, told):
    scan = scan_of(tmp_path)
    write(tmp_path)
    with pytest.raises(InputError, match=told) as error:
        times(scan, **keys)
    assert "\n" not in str(error.value)


def test_two_kinds_of_events_are_told(tmp_path):
    scan = scan_of(tmp_path)
    events(tmp_path / "run-01.gps", [OF_WEEK_S])
    with (tmp_path / "run-01.gps").open("ab") as file:
        file.write(event("MARK1TIME", OF_WEEK_S))
    with pytest.raises(InputError, match=r"found 5 MARK2TIME, 1 MARK1TIME, .*; set source.event to one of"):
        times(scan, time_stamps="novatel")


@pytest.mark.parametrize("name", ["SCAN.NAV", "SCAN.TXT", "SCAN.GPS", "Scan-Times.csv", "SCAN.BIL", "SCAN", "scan.nav"])
def test_files_of_a_scan_in_another_case_are_watched(tmp_path, name):
    """As they are read: a changed file makes the workflow run again."""
    scan = scan_of(tmp_path, "scan")
    (tmp_path / name).write_text("")
    (tmp_path / "scanner.nav").write_text("")
    source = ScansSection(kind="scans", dataset="x", scans="*.hdr")
    watched = {path.name for path in source.files(tmp_path) if path.is_file()}
    assert watched == {scan.name, "scan.raw", name}

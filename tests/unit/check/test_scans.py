"""Scans, their time stamps and labels, checked without a look at any picture."""

import os
import re
import shutil
import time
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml

from linepose.check.clock import overlap_findings
from linepose.check.finding import Level
from linepose.check.platform import check_platform
from linepose.check.scans import scan_findings
from linepose.config.new_platform import NewPlatform, write_platform
from linepose.config.new_project import make_project
from linepose.config.platform import load_platform
from linepose.inputs.gps_time import gps_from_unix
from linepose.inputs.observed_points import SCAN_POINTS
from linepose.tables import write_table
from unit.check.conftest import CONFIG
from unit.recorded_files import write_scan_files

N_SCANS = 10


@pytest.fixture(scope="module")
def clean_scans(tmp_path_factory) -> Path:
    root = tmp_path_factory.mktemp("scans")
    make_project(root, "mine")
    hand = (0.2, 0.0, -0.8), (-56.0, 0.0, -90.0), 323.0
    new = NewPlatform("mine", 8.2e-3, 7.407407407e-6, 648, *hand, source="scans", navigation="navigation.parquet")
    write_platform(root / "config" / "platforms", new)
    write_scan_files(root / "data" / "mine", load_platform(CONFIG / "platforms", "ladybird-sim"), N_SCANS)
    return root


@pytest.fixture
def scans(clean_scans, tmp_path) -> Path:
    """A copy that may be spoilt."""
    return Path(shutil.copytree(clean_scans, tmp_path / "project"))


def settings(root, **changes):
    path = root / "config" / "platforms" / "mine.yaml"
    values = yaml.safe_load(path.read_text())
    for section, change in changes.items():
        values[section].update(change)
    path.write_text(yaml.safe_dump(values))


def test_missing_navigation_log_is_told_once(scans):
    (scans / "data" / "mine" / "navigation.parquet").unlink()
    told = [finding.found for finding in check_platform("mine", scans).of(Level.ERROR)]
    assert len(told) == 1
    assert "navigation.parquet" in told[0]
    (scans / "data" / "mine" / "covariances.csv").unlink()
    assert len(check_platform("mine", scans).of(Level.ERROR)) == 2


def in_gps_time(root):
    for path in (root / "data" / "mine" / "scans").glob("*-times.csv"):
        (pd.read_csv(path) + 18_000_000).to_csv(path, index=False)


def other_width(root):
    settings(root, camera={"n_pixels": 640, "principal_point_px": 319.0})


def cut_picture(root):
    with (root / "data" / "mine" / "scans" / "observation-03.bil").open("r+b") as data:
        data.truncate(1000)


def no_stamps(root):
    (root / "data" / "mine" / "scans" / "observation-02-times.csv").unlink()


def labels(root, change):
    path = root / "data" / "mine" / "labels.csv"
    change(pd.read_csv(path)).to_csv(path, index=False)


def beyond_the_end(root):
    labels(root, lambda table: table.assign(line=table["line"].where(table.index != 4, 1e6)))


def one_unlabelled(root):
    labels(root, lambda table: table[table["observation"] != 7])


def few_labels(root):
    labels(root, lambda table: table[(table["observation"] != 7) | (table["point"] < 2)])


def rare_log(root):
    path = root / "data" / "mine" / "navigation.parquet"
    pd.read_parquet(path)[::100].to_parquet(path, index=False)


def short_log(root):
    path = root / "data" / "mine" / "navigation.parquet"
    table = pd.read_parquet(path)
    table[: len(table) // 2].to_parquet(path, index=False)


PLANTED = {
    in_gps_time: (Level.ERROR, "conventions", "GPS", r"set source.time_offset_s: -18\.0$"),
    other_width: (Level.ERROR, "scans", "648 pixels a line, camera.n_pixels is 640", "n_pixels: 648"),
    cut_picture: (Level.ERROR, "scans", "observation-03.bil.*truncated", "restore"),
    no_stamps: (Level.ERROR, "scans", "observation-02-times.csv", "beside the scan"),
    beyond_the_end: (Level.ERROR, "labels", "observation 1, point 4, line 1e\\+06", "lines count from 0"),
    one_unlabelled: (Level.WARNING, "labels", "scan 7: no label", "left_out"),
    few_labels: (Level.WARNING, "labels", "observation 7: fewer than 4 points", "label more"),
    rare_log: (Level.ERROR, "time", "a pose every 1 s", "maximum_pose_gap_s"),
    short_log: (Level.ERROR, "time", "s outside the navigation log", "complete the navigation log"),
}


def test_clean_scans_pass(clean_scans):
    report = check_platform("mine", clean_scans)
    assert report.of(Level.ERROR) == ()
    told = " ".join(finding.found for finding in report.of(Level.OK))
    assert "10 scans of 648 pixels, a time stamp for each line" in told
    assert "150 points in 10 observations" in told
    assert "none explains the data better" in told
    assert len(report.predicted) == 6


@pytest.mark.parametrize("plant", PLANTED, ids=lambda plant: plant.__name__)
def test_planted_mistake_is_named(scans, plant):
    plant(scans)
    level, subject, found, advice = PLANTED[plant]
    mine = [f for f in check_platform("mine", scans).of(level) if f.subject == subject and re.search(found, f.found)]
    assert len(mine) == 1
    assert re.search(advice, mine[0].advice)


def test_points_to_be_detected_are_left_to_the_run(scans):
    settings(scans, source={"points": "detection"})
    report = check_platform("mine", scans)
    assert report.level == Level.OK
    assert report.predicted == ()
    assert any("without labels" in finding.found for finding in report.findings)
    path = scans / "config" / "platforms" / "mine.yaml"
    known = {"points": {"control_points": "control.csv"}, "map_frame": {"origin": [-33.9, 151.2, 0.0]}}
    path.write_text(yaml.safe_dump(yaml.safe_load(path.read_text()) | known))
    report = check_platform("mine", scans)
    assert ["control.csv: no such file" in one.found for one in report.of(Level.ERROR)] == [True]
    assert [one.subject for one in report.of(Level.WARNING)] == ["map frame"]  # the log is in northings


def test_points_that_the_last_run_detected_count(scans):
    settings(scans, source={"points": "detection"})
    platform = load_platform(scans / "config" / "platforms", "mine")
    source, folder = platform.source, scans / "data" / "mine"
    found = scans / "results" / "mine" / "points.parquet"
    found.parent.mkdir(parents=True)
    _, labelled = scan_findings(source.model_copy(update={"points": "labels"}), folder, 648)
    write_table(labelled, found, SCAN_POINTS)
    report = check_platform("mine", scans)
    assert report.of(Level.ERROR) == ()
    assert len(report.predicted) == 6
    path = folder / "navigation.parquet"
    log = pd.read_parquet(path)
    log.assign(roll_rad=-log["roll_rad"]).to_parquet(path, index=False)
    told = [one for one in check_platform("mine", scans).findings if one.subject == "conventions"]
    assert any("roll" in one.found and "roll_sign" in one.advice for one in told)
    for scan in (folder / "scans").glob("*.hdr"):  # scans that are newer than what was found in others
        os.utime(scan, ns=(time.time_ns() + 10**10,) * 2)
    assert check_platform("mine", scans).predicted == ()


def test_a_tape_in_millimetres_is_told_before_points_are_detected(scans):
    settings(scans, source={"points": "detection"}, hand_measured={"position_m": [200.0, 0.0, -800.0]})
    (told,) = check_platform("mine", scans).of(Level.ERROR)
    assert told.subject == "hand measurement"
    assert "in metres" in told.advice


def test_what_readers_pass_over_is_told_once(scans):
    path = scans / "data" / "mine" / "navigation.parquet"
    for header in (scans / "data" / "mine" / "scans").glob("*.hdr"):
        header.write_text(header.read_text().replace("byte order = 0", ""))
    settings(scans, source={"navigation": {"format": "table", "file": path.name}, "covariances": "covariances.csv"})
    table = pd.read_parquet(path)
    pd.concat([table[:3], table[2:]]).to_parquet(path, index=False)
    told = [
        one for one in check_platform("mine", scans).of(Level.WARNING) if one.subject in ("scans", "navigation log")
    ]
    assert [one.subject for one in told] == ["scans", "navigation log"]
    assert re.search(r"observation-01.hdr: no byte order: read as 0, .* \(and 9 more like it\)", told[0].found)
    assert re.search(r"navigation.parquet: 1 records that repeat the one before are passed over", told[1].found)


@pytest.mark.parametrize(
    ("late_s", "found"),
    [
        (7_200, r"begin 7200.* s after the time in its header, .* \(and 9 more scans\): a time zone of 2 h"),
        (18, r"begin 18.* s after .*: GPS time against UTC"),
        (-619_315_200, r"begin 619315200.* before .*: 1024 GPS weeks"),
        (100, r"begin 100.* s after the time in its header, read as UTC \(and 9 more scans\)$"),
        (2, None),
    ],
)
def test_time_of_the_header_beside_the_stamps(scans, late_s, found):
    for header in sorted((scans / "data" / "mine" / "scans").glob("*.hdr")):
        first_us = int(pd.read_csv(header.with_name(f"{header.stem}-times.csv")).iloc[0, 0])
        start = pd.Timestamp(first_us - late_s * 1_000_000, unit="us").isoformat()
        header.write_text(header.read_text() + f"acquisition time = {start}Z\n")
    told, _ = scan_findings(load_platform(scans / "config" / "platforms", "mine").source, scans / "data" / "mine", 648)
    mine = [one for one in told if one.subject == "time"]
    assert len(mine) == (found is not None)
    assert found is None or re.search(found, mine[0].found)
    if late_s == 100:  # of no name: how large it is to the second is not known
        assert mine[0].advice.endswith("measure the offset by the landmark, and set source.time_offset_s to it")
    elif found:
        assert float(re.search("set source.time_offset_s: (.*)", mine[0].advice)[1]) == pytest.approx(-late_s)


@pytest.mark.parametrize(
    ("shift_s", "advice"),
    [
        (3_600, r"set source.time_offset_s: -3600 \(a time zone of 1 h\)"),
        (18, r"set source.time_offset_s: -18 \(GPS time against UTC .*\)"),
        (619_315_200, r"^add 619315200 s to the times of the navigation, or correct its gps_week \(1024 GPS weeks"),
        (-619_315_200, r"set source.time_offset_s: 619315200 \(1024 GPS weeks"),
    ],
)
def test_shift_between_the_clocks_is_named_with_its_remedy(shift_s, advice):
    log_us = 1_700_000_000_000_000 + 100_000 * np.arange(100)
    times = log_us[20:30] + shift_s * 1_000_000
    (told,) = overlap_findings(times, log_us, "navigation log", 0.0)
    assert re.search(advice, told.advice)
    corrected = [float(one) for one in re.findall(r"time_offset_s: (-?[\d.]+)", told.advice)]
    for offset_s in corrected:  # to the letter
        (followed,) = overlap_findings(times + round(offset_s * 1e6), log_us, "navigation log", offset_s)
        assert followed.level == Level.OK


@pytest.mark.parametrize(
    ("shift_s", "key"), [(-315_964_782, "source.time_scale: gps"), (315_964_782, "source.navigation.time_scale: gps")]
)
def test_times_since_1980_read_as_since_1970_are_told_by_their_key(shift_s, key):
    log_us = 1_700_000_000_000_000 + 100_000 * np.arange(100)
    keys = "source.time_scale: gps", "source.navigation.time_scale: gps"
    (told,) = overlap_findings(log_us[20:30] + shift_s * 1_000_000, log_us, "navigation log", 0.0, keys)
    assert told.advice == f"set {key} (the GPS epoch and 18 leap seconds)"


def test_log_in_gps_seconds_read_as_unix_time_is_mended_by_the_key_alone(scans):
    """To the letter; and no other finding guesses that a receiver has lost weeks."""
    log = pd.read_parquet(scans / "data" / "mine" / "navigation.parquet")
    gps_s = gps_from_unix(log["time_us"].to_numpy()) / 1e6
    log.assign(t=gps_s).to_csv(scans / "data" / "mine" / "log.csv", index=False)
    columns = {
        "time": "t",
        "position": ["north_m", "east_m", "down_m"],
        "attitude": ["roll_rad", "pitch_rad", "yaw_rad"],
    }
    navigation = {"format": "table", "file": "log.csv", "columns": columns, "time_unit": "s"}
    settings(scans, source={"navigation": navigation, "covariances": "covariances.csv"})
    report = check_platform("mine", scans)
    (told,) = [one for one in report.of(Level.ERROR) if one.subject == "time" and "navigation log" in one.found]
    assert told.advice.startswith("set source.navigation.time_scale: gps (the GPS epoch")
    assert not [one for one in report.findings if "may have lost 1024" in one.found]
    settings(scans, source={"navigation": navigation | {"time_scale": "gps"}})
    assert check_platform("mine", scans).level < Level.ERROR


def test_lost_weeks_are_told_where_only_the_covariances_have_another_clock(scans):
    """An hour of the covariances' file explains nothing of the log and the scans, which agree."""
    data = scans / "data" / "mine"
    navigation = {"format": "table", "file": "navigation.parquet"}
    settings(scans, source={"navigation": navigation, "covariances": "covariances.csv"})
    log = pd.read_parquet(data / "navigation.parquet")
    lost_us = int(log["time_us"].iloc[0]) - 1_126_785_600_000_000  # 2005-09-15
    log.assign(time_us=log["time_us"] - lost_us).to_parquet(data / "navigation.parquet", index=False)
    for path in (data / "scans").glob("*-times.csv"):
        (pd.read_csv(path) - lost_us).to_csv(path, index=False)
    reported = pd.read_csv(data / "covariances.csv", header=None)
    reported[0] += 3_600_000_000 - lost_us
    reported.to_csv(data / "covariances.csv", index=False, header=False)
    report = check_platform("mine", scans)
    assert [one.advice for one in report.of(Level.ERROR)] == ["correct the times in source.covariances (column 1, us)"]
    assert any("may have lost 1024" in one.found for one in report.of(Level.WARNING))


def test_labelled_views_have_their_column_named_for_a_shift():
    log_us = 1_700_000_000_000_000 + 100_000 * np.arange(100)
    (told,) = overlap_findings(log_us[20:30] - 3_600_000_000, log_us, "covariances")
    assert "add 3600000000 us to column 1 of each view file (a time zone of 1 h)" in told.advice

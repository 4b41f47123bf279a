"""Presets of tables: a file as each program writes it, recognised and read."""

import re
from pathlib import Path

import numpy as np
import pytest

from linepose.errors import InputError
from linepose.inputs.navigation import read_navigation
from linepose.inputs.navigation.presets import NAMES, PRESETS, recognised
from linepose.inputs.navigation.table import TableSection
from linepose.inputs.source import ScansSection

PAGE = (Path(__file__).parents[4] / "docs" / "formats.md").read_text()
FIRST_US = 1_700_000_000_250_000  # 2023-11-14 22:13:20.25 UTC, week 2288, 252818.25 s
WEEK_S = 252_818.25
ORIGIN = (-33.8892, 151.1937, 42.5)

INERTIAL_EXPLORER = """Project:     made up
Program:     Inertial Explorer Version 8.90
Datum:       WGS84, (processing datum)

   Week    GPSTime         Latitude        Longitude        H-Ell           Roll          Pitch        Heading  Q
(weeks)      (sec)       (+/-D M S)       (+/-D M S)          (m)          (deg)          (deg)          (deg)
   2288  252818.25  -33 53 21.12000  151 11 37.32000       42.500   5.0000000000 -10.0000000000  30.0000000000  1
   2288  252818.35  -33 53 21.12000  151 11 37.32000       42.500   5.0000000000 -10.0000000000  30.0000000000  1
"""
IN_DEGREES = INERTIAL_EXPLORER.replace("-33 53 21.12000  151 11 37.32000", "-33.8892000000 151.1937000000")
POSPAC = """****************************************************************
 POS Export Utility
****************************************************************

 Mission Start Time:
   Date of Mission: 2023-11-14
 Lever arm values: lx =        0.0000 m, ly =        0.0000 m, lz =        0.0000 m.
 TIME, DISTANCE, EASTING, NORTHING, ELLIPSOID HEIGHT, LATITUDE, LONGITUDE, ELLIPSOID HEIGHT, ROLL, PITCH, HEADING, \
EAST SD, NORTH SD, HEIGHT SD, ROLL SD, PITCH SD, HEADING SD

  (time in Sec, distance in Meters, position in Meters, lat, long in Degrees, orientation angles and SD in Degrees)

252818.250 0.0 332962.0 6248551.0 42.5 -33.8892 151.1937 42.5 5.0 -10.0 30.0 0.02 0.01 0.03 0.1 0.2 0.3
252818.350 0.0 332962.0 6248551.0 42.5 -33.8892 151.1937 42.5 5.0 -10.0 30.0 0.02 0.01 0.03 0.1 0.2 0.3
"""
HYSPEX = """1  151.193700  -33.889200  42.500000  5.000000  -10.000000  30.000000  252818.250
2  151.193700  -33.889200  42.500000  5.000000  -10.000000  30.000000  252818.350
"""
HEADWALL = """Roll\tPitch\tYaw\tLat\tLon\tAlt\tTimestamp\tGps_UTC_Date&Time\tStatus\tHeading
5.0\t-10.0\t30.0\t-33.8892\t151.1937\t42.5\t1700000000250000\t2023/11/14 22:13:20\t0\t31.0
5.0\t-10.0\t30.0\t-33.8892\t151.1937\t42.5\t1700000000350000\t2023/11/14 22:13:20\t0\t31.0
"""
OXTS = """Time (GPS s),Latitude (deg),Longitude (deg),Altitude (m),Heading (deg),Pitch (deg),Roll (deg)
1384035218.25,-33.8892,151.1937,42.5,30,-10,5
1384035218.35,-33.8892,151.1937,42.5,30,-10,5
"""
TUM = """# timestamp tx ty tz qx qy qz qw
1700000000.25 20 10 5 0 0 0.5 0.8660254037844386
1700000000.35 20 10 5 0 0 0.5 0.8660254037844386
"""
RTKLIB = """% program   : RTKPOST ver.2.4.3
%
% (lat/lon/height=WGS84/ellipsoidal,Q=1:fix,2:float,3:sbas,4:dgps,5:single,6:ppp,ns=# of satellites)
%  GPST                  latitude(deg) longitude(deg)  height(m)   Q  ns
2023/11/14 22:13:38.250  -33.889200000  151.193700000    42.5000   1   9   5.0 -10.0 30.0
2023/11/14 22:13:38.350  -33.889200000  151.193700000    42.5000   1   9   5.0 -10.0 30.0
"""
TEXTS = {
    "rtklib": RTKLIB,
    "inertial_explorer": INERTIAL_EXPLORER,
    "pospac": POSPAC,
    "hyspex": HYSPEX,
    "headwall": HEADWALL,
    "oxts": OXTS,
    "tum": TUM,
}


def read(folder, text, preset, **keys):
    (folder / "log.txt").write_text(text)
    assert recognised(folder / "log.txt")["preset"] == preset
    return read_navigation(TableSection(format="table", file="log.txt", preset=preset, **keys), folder)


@pytest.mark.parametrize(
    ("preset", "text", "keys"),
    [
        ("inertial_explorer", INERTIAL_EXPLORER, {}),
        ("inertial_explorer", IN_DEGREES, {}),
        ("pospac", POSPAC, {"gps_week": 2288}),
        ("hyspex", HYSPEX, {"gps_week": 2288}),
        ("headwall", HEADWALL, {}),
        ("oxts", OXTS, {}),
        ("rtklib", RTKLIB, {"columns": {"attitude": ("8", "9", "10")}}),
    ],
)
def test_preset_of_latitude_and_longitude(tmp_path, preset, text, keys):
    record = read(tmp_path, text, preset, origin=ORIGIN, **keys)
    np.testing.assert_array_equal(record.log.time_us, [FIRST_US, FIRST_US + 100_000])
    np.testing.assert_allclose(record.log.position_m, 0, atol=1e-6)
    np.testing.assert_allclose(np.rad2deg(record.log.euler_rad), [[5, -10, 30]] * 2, atol=1e-9)


def test_pospac_has_covariances(tmp_path):
    record = read(tmp_path, POSPAC, "pospac", origin=ORIGIN, gps_week=2288)
    sigma = np.sqrt(np.diag(record.covariances.covariance[0]))
    np.testing.assert_allclose(sigma, [0.01, 0.02, 0.03, *np.deg2rad([0.1, 0.2, 0.3])])
    columns = {"sigma_position": None, "sigma_attitude": None}
    assert read(tmp_path, POSPAC, "pospac", gps_week=2288, columns=columns).covariances is None


def test_tum(tmp_path):
    record = read(tmp_path, TUM, "tum")
    np.testing.assert_array_equal(record.log.time_us, [FIRST_US, FIRST_US + 100_000])
    np.testing.assert_allclose(record.log.position_m[0], [10, 20, -5])
    np.testing.assert_allclose(np.rad2deg(record.log.euler_rad[0]), [0, 0, 30], atol=1e-9)


def test_signs_in_comments_and_headings_are_none_between_cells(tmp_path):
    """Two rows below many lines with commas, which no row has."""
    for text in ("# x, y, z\n" * 30 + TUM, "# x; y\n" * 30 + TUM.replace(" ", ",").replace("#,", "# ")):
        np.testing.assert_array_equal(read(tmp_path, text, "tum").log.time_us, [FIRST_US, FIRST_US + 100_000])
    units = POSPAC.replace("(time in Sec, distance", "(" + "time, " * 30 + "distance")
    text = units.replace(POSPAC[:60], "\n".join([POSPAC[:60], "*** a, b, c"] * 20), 1)
    assert len(read(tmp_path, text, "pospac", gps_week=2288).log.time_us) == 2


def test_kitti_takes_its_times_from_a_file(tmp_path):
    """Yaw is counted from east, counter-clockwise; one row a file."""
    folder = tmp_path / "oxts" / "data"
    folder.mkdir(parents=True)
    rest = " ".join(["0"] * 24)
    for number in range(3):
        (folder / f"{number:010d}.txt").write_text(f"-33.8892 151.1937 42.5 0.1 -0.2 {np.pi / 2} {rest}\n")
    assert recognised(folder / "0000000000.txt") == {"preset": "kitti"}
    section = TableSection(format="table", file="oxts/data/*.txt", preset="kitti", origin=ORIGIN)
    (tmp_path / "oxts" / "timestamps.txt").write_text("".join(f"2023-11-14 22:13:20.{n}50000000\n" for n in (2, 3, 4)))
    assert tmp_path / "oxts" / "timestamps.txt" in section.files(tmp_path)
    log = read_navigation(section, tmp_path).log
    np.testing.assert_array_equal(log.time_us, FIRST_US + 100_000 * np.arange(3))
    np.testing.assert_allclose(log.euler_rad[0], [0.1, 0.2, 0], atol=1e-9)
    (tmp_path / "oxts" / "timestamps.txt").write_bytes(b"2023-11-14 \x8f22:13:20.250000000\n")
    with pytest.raises(InputError, match=r"timestamps.txt: found bytes that are not utf-8, expected a time a row"):
        read_navigation(section, tmp_path)
    (tmp_path / "oxts" / "timestamps.txt").write_text("".join(f"2023-11-14 22:13:20.{n}50000000\n" for n in (2, 3, 4)))
    (folder / "0000000001.txt").write_text(f"-33.8892 151.1937 42.5 0.1 1e400 1.5 {rest}\n")
    with pytest.raises(InputError, match=r", row \d, 5: found inf, expected an angle; mend or remove the row"):
        read_navigation(section, tmp_path)
    (folder / "0000000001.txt").write_text(f"-33.8892 151.1937 42.5 0.1 -0.2 1.5 {rest}\n")
    (tmp_path / "oxts" / "timestamps.txt").write_text("2023-11-14 22:13:20.250000000\n")
    with pytest.raises(InputError, match=r"timestamps.txt: found 1 times, expected 3, one a row of the log"):
        read_navigation(section, tmp_path)


def test_keys_of_the_platform_file_stand_above_those_of_the_preset(tmp_path):
    text = INERTIAL_EXPLORER.replace("Heading", "Azimuth").replace("GPSTime", "CorrTime")
    keys = {"columns": {"time": "CorrTime", "attitude": ("Roll", "Pitch", "Azimuth")}}
    assert read(tmp_path, text, "inertial_explorer", **keys).log.time_us[0] == FIRST_US
    with pytest.raises(InputError, match=r"found columns Week, CorrTime, .* expected among them GPSTime, Heading"):
        read(tmp_path, text, "inertial_explorer")


def test_settings_of_a_preset_are_the_same_when_they_are_read_again():
    section = TableSection(format="table", file="log.txt", preset="pospac", columns={"time": "UTC"})
    assert TableSection.model_validate(section.model_dump(mode="json")) == section


def test_unknown_preset_is_one_line():
    with pytest.raises(InputError, match=r"source.navigation.preset: found 'hispex'.*did you mean hyspex\?"):
        TableSection(format="table", file="log.txt", preset="hispex")


def test_file_of_each_preset_is_recognised_as_no_other(tmp_path):
    assert {*TEXTS, "kitti"} == set(PRESETS)
    for text in TEXTS.values():
        (tmp_path / "log.txt").write_text(text)
        assert sum(one.recognises(text) for one in PRESETS.values()) == 1
    (tmp_path / "log.txt").write_text("time_us,north_m\n1,2\n")
    assert recognised(tmp_path / "log.txt") is None


@pytest.mark.parametrize("sign", [",", " ", ";"])
@pytest.mark.parametrize(
    "rows",
    [
        ["345600 52.1 13.4 100.0 0.1 0.2 90.0 1", "345601 52.1 13.4 100.0 0.1 0.2 90.0 1"],  # a status
        ["345600 52.1 13.4 100.0 0.1 0.2 90.0 1", "345601 52.1 13.4 100.0 0.1 0.2 90.0 2"],  # a count
        ["1 52.1 13.4 100.0 0.1 0.2 90.0 700000.0", "2 52.1 13.4 100.0 0.1 0.2 90.0 700000.1"],  # past the week
        ["1 52.1 13.4 100.0 0.1 0.2 90.0 345600.1", "2 52.1 13.4 100.0 0.1 0.2 90.0 345600.0"],
        ["1700000000.25 52.1 13.4 100.0 0.1 0.2 90.0 1", "1700000000.35 52.1 13.4 100.0 0.1 0.2 90.0 1"],
        ["1700000000.25 52.1 13.4 100.0 0 0 0 0", "1700000000.35 52.1 13.4 100.0 0 0 0 0"],
    ],
)
def test_eight_numbers_that_a_format_does_not_allow_are_not_of_it(tmp_path, rows, sign):
    """Neither frames of HySpex nor quaternions: latitude and longitude would change places without a word."""
    (tmp_path / "log.txt").write_text("\n".join(row.replace(" ", sign) for row in rows) + "\n")
    assert recognised(tmp_path / "log.txt") is None


def test_a_long_log_of_eight_numbers_is_recognised(tmp_path):
    """Whose head ends within a row, and whose first quaternions are zeros."""
    frames = (f"{n + 1} 151.1937 -33.8892 42.5 5 -10 30 {WEEK_S + n / 100:.3f}\n" for n in range(1000))
    turns = (f"{1.7e9 + n / 100:.2f} 20 10 5 0 0 {'0 0' if n < 9 else '0.5 0.866'}\n" for n in range(1000))
    for preset, rows in {"hyspex": frames, "tum": turns}.items():
        (tmp_path / "log.txt").write_text("".join(rows))
        assert recognised(tmp_path / "log.txt") == {"preset": preset}


def test_page_names_every_preset():
    assert set(re.findall(r"^\| `(\w+)` \|", PAGE, re.MULTILINE)) >= set(PRESETS)
    assert all(f"`{name}`" in NAMES for name in PRESETS)


def test_solution_without_an_attitude_is_told():
    told = r"preset: found rtklib, whose files hold positions alone.*name the log of the attitudes in .*attitude_log"
    with pytest.raises(InputError, match=told):
        TableSection(format="table", file="log.pos", preset="rtklib")


CSV = """Week,GPSTime,Latitude,Longitude,H-Ell,Roll,Pitch,Heading
(weeks),(sec),(deg),(deg),(m),(deg),(deg),(deg)
2288,252818.25,-33.8892,151.1937,42.5,5,-10,30
2288,252818.35,-33.8892,151.1937,42.5,5,-10,30
"""
WEEKLESS = "\n".join(line[7:] for line in IN_DEGREES.splitlines()[4:]) + "\n"


@pytest.mark.parametrize(
    ("preset", "text", "keys"),
    [
        ("inertial_explorer", CSV, {}),
        ("inertial_explorer", WEEKLESS, {"gps_week": 2288}),
        ("oxts", "\ufeff" + OXTS.replace(",", ";"), {}),
        ("oxts", OXTS.replace(",", "; ").replace(".", ","), {"decimal": ","}),
        ("hyspex", HYSPEX.replace("  ", ", "), {"gps_week": 2288}),
        ("inertial_explorer", INERTIAL_EXPLORER.replace(".", ","), {"decimal": ","}),
        ("pospac", re.sub(r", EAST SD.*", "", POSPAC).replace(" 0.02 0.01 0.03 0.1 0.2 0.3", ""), {"gps_week": 2288}),
    ],
)
def test_what_a_file_says_of_itself_counts(tmp_path, caplog, preset, text, keys):
    (tmp_path / "log.txt").write_text(text)
    section = TableSection(format="table", file="log.txt", preset=preset, origin=ORIGIN, **keys)
    record = read_navigation(section, tmp_path)
    np.testing.assert_array_equal(record.log.time_us, [FIRST_US, FIRST_US + 100_000])
    np.testing.assert_allclose(np.rad2deg(record.log.euler_rad), [[5, -10, 30]] * 2, atol=1e-9)
    np.testing.assert_allclose(record.log.position_m, 0, atol=1e-6)
    assert record.covariances is None
    assert recognised(tmp_path / "log.txt")["preset"] == preset
    assert ("has no standard deviations, which preset pospac has in NORTH SD" in caplog.text) == (preset == "pospac")


def test_week_of_the_scans_where_an_export_has_none(tmp_path):
    """Of Inertial Explorer, whose preset names a column of the week."""
    (tmp_path / "a-times.csv").write_text(f"{FIRST_US + 5}\n{FIRST_US + 6}\n")
    (tmp_path / "a.png").touch()
    navigation = {"format": "table", "file": "log.txt", "preset": "inertial_explorer"}
    source = ScansSection(kind="scans", dataset="x", scans="*.png", navigation=navigation)
    for text, lacking in ((WEEKLESS, "gps_week"), (INERTIAL_EXPLORER, None)):
        (tmp_path / "log.txt").write_text(text)
        assert source.navigation.lacking(tmp_path) == lacking
        np.testing.assert_array_equal(read_navigation(source, tmp_path).log.time_us, [FIRST_US, FIRST_US + 100_000])


@pytest.mark.parametrize(
    ("clock", "times"),
    [
        ("GPST", ["2023/11/14 22:13:38.25", "2023/11/14 22:13:38.35"]),
        ("UTC ", ["2023/11/14 22:13:20.25", "2023/11/14 22:13:20.35"]),
        ("GPST", ["2288 252818.25", "2288 252818.35"]),
    ],
)
def test_clock_of_rtklib_s_heading(tmp_path, caplog, clock, times):
    text = f"% (lat/lon/height=WGS84/geodetic,Q=1:fix)\n%  {clock}   latitude(deg) longitude(deg)  height(m)\n"
    (tmp_path / "log.pos").write_text(text + "".join(f"{time} -33.8892 151.1937 42.5 5 -10 30\n" for time in times))
    section = TableSection(format="table", file="log.pos", preset="rtklib", columns={"attitude": ["6", "7", "8"]})
    np.testing.assert_array_equal(read_navigation(section, tmp_path).log.time_us, [FIRST_US, FIRST_US + 100_000])
    assert caplog.text.count("log.pos: heights above the geoid") == 1


@pytest.mark.parametrize("sign", [",", ";", "\t"])
@pytest.mark.parametrize(
    ("clock", "times", "first"),
    [
        ("GPST", ["2023/11/14 22:13:38.250", "2023/11/14 22:13:38.350"], 5),
        ("UTC ", ["2023/11/14 22:13:20.250", "2023/11/14 22:13:20.350"], 5),
        ("GPST", ["2288{}252818.250", "2288{}252818.350"], 6),
        ("GPST", ["2023/11/14{}22:13:38.250", "2023/11/14{}22:13:38.350"], 6),
    ],
)
def test_rtklib_with_a_sign_between_cells(tmp_path, sign, clock, times, first):
    """RTKLIB keeps the blank between date and time, and puts the sign between week and seconds."""
    cells = ["  -33.889200000", " 151.193700000", "   42.5000", "  5.0", " -10.0", " 30.0"]
    text = f"%  {clock}{sign} latitude(deg){sign}longitude(deg){sign} height(m)\n"
    text += "".join(sign.join([time.format(sign), *cells]) + "\n" for time in times)
    first += sign == "\t" and first == 5  # a tab counts as a blank
    attitude = [str(number) for number in range(first, first + 3)]
    record = read(tmp_path, text, "rtklib", origin=ORIGIN, columns={"attitude": attitude})
    np.testing.assert_array_equal(record.log.time_us, [FIRST_US, FIRST_US + 100_000])
    np.testing.assert_allclose(record.log.position_m, 0, atol=1e-6)
    np.testing.assert_allclose(np.rad2deg(record.log.euler_rad), [[5, -10, 30]] * 2, atol=1e-9)


def test_time_of_japan_is_refused(tmp_path):
    (tmp_path / "log.pos").write_text(
        "%  JST  latitude(deg) longitude(deg) height(m)\n2023/11/14 22:13:38 1 2 3 4 5 6\n"
    )
    section = TableSection(format="table", file="log.pos", preset="rtklib", columns={"attitude": ["6", "7", "8"]})
    with pytest.raises(InputError, match=r"log.pos: found times in JST, expected GPST or UTC; export the solution"):
        read_navigation(section, tmp_path)


def test_signs_of_angles_between_0_and_minus_1_degree(tmp_path):
    text = INERTIAL_EXPLORER.replace("-33 53 21.12000  151 11 37.32000", " -0 53 21.12000   -0 11 37.32000")
    (tmp_path / "log.txt").write_text(text)
    record = read_navigation(TableSection(format="table", file="log.txt", preset="inertial_explorer"), tmp_path)
    np.testing.assert_allclose(record.origin, (-0.8892, -0.1937, 42.5), rtol=0, atol=1e-9)


def test_poses_at_0_0_are_left_out(tmp_path, caplog):
    heading, first, second = OXTS.splitlines()
    rows = [heading, first.replace("-33.8892,151.1937,42.5", "0.0,0.0,0.0").replace("218.25", "218.15"), first, second]
    (tmp_path / "log.txt").write_text("\n".join(rows) + "\n")
    record = read_navigation(TableSection(format="table", file="log.txt", preset="oxts"), tmp_path)
    np.testing.assert_allclose(record.origin, ORIGIN)
    assert len(record.log.time_us) == 2
    assert "log.txt: 1 of 3 records at latitude 0, longitude 0" in caplog.text


def test_quaternions_of_zeros_are_left_out(tmp_path, caplog):
    (tmp_path / "log.txt").write_text("1700000000.15 0 0 0 0 0 0 0\n" + TUM)
    record = read_navigation(TableSection(format="table", file="log.txt", preset="tum"), tmp_path)
    np.testing.assert_array_equal(record.log.time_us, [FIRST_US, FIRST_US + 100_000])
    assert "log.txt: 1 of 3 rows with a quaternion of zeros are left out" in caplog.text


@pytest.mark.parametrize(
    ("text", "keys", "told"),
    [
        (
            TUM.replace(".25 ", "250000000 ").replace(".35 ", "350000000 "),
            {"preset": "tum"},
            r"set .*\(time_unit: ns\)",
        ),
        (
            POSPAC.replace("-33.8892", "-33:53:21.12").replace("151.1937", "151:11:37.32"),
            {"preset": "pospac", "gps_week": 2288},
            r"LATITUDE: found '-33:53:21.12', expected a number; set source.navigation.latitude_unit: dms",
        ),
    ],
)
def test_remedy_names_the_key_that_mends(tmp_path, text, keys, told):
    (tmp_path / "log.txt").write_text(text)
    with pytest.raises(InputError, match=told):
        read_navigation(TableSection(format="table", file="log.txt", **keys), tmp_path)

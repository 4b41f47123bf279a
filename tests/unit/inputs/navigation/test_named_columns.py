"""Text logs without a preset: their keys by the names of the columns, and read by these keys as they were meant."""

import numpy as np
import pytest

from linepose.inputs.navigation.named_columns import keys_by_names
from linepose.inputs.navigation.table import FORMAT, TableSection

DEG = np.pi / 180
LOGS = {  # heading, row with its time left open, two times, keys
    "own names": (
        "time_us,north_m,east_m,down_m,roll_rad,pitch_rad,yaw_rad\n",
        "{},1,2,3,0.01,0.02,0.5\n",
        ("1700000000000000", "1700000001000000"),
        {"coordinates": "ned", "time_unit": "us", "angle_unit": "radians"},
    ),
    "latitude and longitude": (
        "gps_seconds,lat,lon,height,roll,pitch,heading\n",
        "{},50.0,8.0,100,1,2,90\n",
        ("1400000000.5", "1400000001.5"),
        {"coordinates": "geodetic", "time_scale": "gps", "time_unit": "s", "angle_unit": "degrees"},
    ),
    "units in brackets": (
        "Time [ms];Easting (m);Northing (m);Up (m);Roll (deg);Pitch (deg);Yaw (deg)\n",
        "{};2;1;-3;1;2;3\n",
        ("1700000000000", "1700000001000"),
        {"delimiter": ";", "coordinates": "enu", "time_unit": "ms", "angle_unit": "degrees", "attitude_axes": None},
    ),
    "quaternion, commented heading": (
        "# a drive\n# timestamp x y z qx qy qz qw\n",
        "{} 2 1 -3 0 0 0 1\n",
        ("1700000000.25", "1700000001.25"),
        {"delimiter": " ", "comment": "#", "coordinates": "enu", "attitude_axes": "enu", "time_unit": "s"},
    ),
    "text times, decimal comma": (
        "utc;latitude;longitude;altitude;roll;pitch;yaw\n",
        "{};50,5;8,25;100,0;1,0;2,0;90,5\n",
        ("2026-05-01T12:00:00.25Z", "2026-05-01T12:00:01.25Z"),
        {"delimiter": ";", "decimal": ",", "time_scale": "iso", "coordinates": "geodetic", "angle_unit": "degrees"},
    ),
    "seconds of the week, a row of units, a title": (
        "Trajectory of a drive\nWeek,GPSTime,Latitude,Longitude,Height,Roll,Pitch,Heading\n"
        "(weeks),(s),(deg),(deg),(m),(deg),(deg),(deg)\n",
        "2411,{},50.0,8.0,100,1,2,181\n",
        ("302400.5", "302401.5"),
        {"unit_rows": 1, "time_scale": "gps_week", "heading_words": ["GPSTime", "Latitude", "Longitude", "Height"]},
    ),
    "degrees, minutes, seconds": (
        "time,lat,lon,alt,roll,pitch,yaw\n",
        "{},50:30:00.0N,8:15:00.0E,100,1,2,90\n",
        ("1700000000", "1700000001"),
        {"latitude_unit": "dms", "coordinates": "geodetic"},
    ),
}


def read(folder, name):
    """The keys of one of the logs, and its poses as they are read with these."""
    heading, row, times, _ = LOGS[name]
    (folder / "log.txt").write_text(heading + "".join(map(row.format, times)))
    keys = keys_by_names(folder / "log.txt")
    return keys, FORMAT.read(TableSection(format="table", file="log.txt", **keys), folder).log


@pytest.mark.parametrize("name", LOGS)
def test_keys_of_a_log_read_it(tmp_path, name):
    keys, poses = read(tmp_path, name)
    expected = LOGS[name][-1]
    assert {key: keys.get(key) for key in expected} == expected
    assert np.diff(poses.time_us).tolist() == [1_000_000]
    assert 2006 < poses.time_us[0] / 1e6 / 31_557_600 + 1970 < 2100


def test_values_are_those_of_the_log(tmp_path):
    _, poses = read(tmp_path, "units in brackets")
    np.testing.assert_allclose(poses.position_m[0], [1, 2, 3])
    assert poses.time_us.tolist() == [1_700_000_000_000_000, 1_700_000_001_000_000]
    np.testing.assert_allclose(poses.euler_rad[0], [1 * DEG, 2 * DEG, 3 * DEG], atol=1e-12)


def test_standard_deviations_are_taken_where_all_are_there(tmp_path):
    names = "time_s,north_m,east_m,down_m,roll_deg,pitch_deg,yaw_deg,{},roll_sd,pitch_sd,yaw_sd"
    row = "1700000000,1,2,3,1,2,30,0.1,0.2,0.3,0.01,0.02,0.03"
    (tmp_path / "log.csv").write_text(f"{names.format('sd_north,sd_east,sd_down')}\n{row}\n")
    columns = keys_by_names(tmp_path / "log.csv")["columns"]
    assert columns["sigma_position"] == ["sd_north", "sd_east", "sd_down"]
    assert columns["sigma_attitude"] == ["roll_sd", "pitch_sd", "yaw_sd"]
    (tmp_path / "log.csv").write_text(f"{names.format('sd_north,sd_east,other')}\n{row}\n")
    assert "sigma_position" not in keys_by_names(tmp_path / "log.csv")["columns"]


@pytest.mark.parametrize(
    "text",
    [
        "",
        "time,x\n1,2\n",
        "time,lat,lon,height,roll,pitch\n1700000000,1,2,3,4,5\n",  # no heading
        "time,lat,lon,height,roll,pitch,yaw\n",  # no row
        "time,lat,lon,height,roll,pitch,yaw\n12.5,1,2,3,4,5,6\n",  # seconds of what?
        "\0time,lat,lon,height,roll,pitch,yaw\n1700000000,1,2,3,4,5,6\n",
    ],
)
def test_what_does_not_tell_all_is_not_guessed(tmp_path, text):
    (tmp_path / "log.txt").write_text(text)
    assert keys_by_names(tmp_path / "log.txt") is None


def test_unit_of_angles_is_told_by_a_turn_far_from_the_start(tmp_path):
    rows = [f"{1_700_000_000 + second},1,2,3,0.1,0.2,{0.5 if second < 4000 else 170}" for second in range(5000)]
    (tmp_path / "log.csv").write_text("\n".join(["time,north,east,down,roll,pitch,yaw", *rows]))
    assert keys_by_names(tmp_path / "log.csv")["angle_unit"] == "degrees"

import numpy as np
import pandas as pd
import pytest

from linepose.errors import InputError
from linepose.inputs.local_frame import geodetic_from_local
from linepose.inputs.navigation import log_covariances, read_navigation
from linepose.inputs.navigation.table import TableSection
from linepose.inputs.source import ScansSection
from unit.inputs.drive import ORIGIN

FIRST_US = 1_700_000_000_250_000
GPS_S = (FIRST_US - 315_964_800_000_000 + 18_000_000) / 1e6
OURS = {"north_m": 10.0, "east_m": 20.0, "down_m": -5.0, "roll_rad": 0.1, "pitch_rad": -0.2, "yaw_rad": 0.5}


def table(**columns):
    values = {"time_us": FIRST_US + 100_000 * np.arange(3)} | OURS | columns
    return pd.DataFrame(values)


def read(tmp_path, values, suffix=".csv", **keys):
    path = tmp_path / f"log{suffix}"
    values.to_csv(path, index=False, float_format="%.17g") if suffix == ".csv" else values.to_parquet(path)
    return read_navigation(TableSection(format="table", file=path.name, **keys), tmp_path)


@pytest.mark.parametrize("suffix", [".csv", ".parquet"])
@pytest.mark.parametrize(
    ("times", "keys"),
    [
        (FIRST_US + 100_000 * np.arange(3), {}),
        ((FIRST_US + 100_000 * np.arange(3)) * 1000, {"time_unit": "ns"}),
        ((FIRST_US + 100_000 * np.arange(3)) / 1000, {"time_unit": "ms"}),
        ((FIRST_US + 100_000 * np.arange(3)) / 1e6, {"time_unit": "s"}),
        (GPS_S + 0.1 * np.arange(3), {"time_unit": "s", "time_scale": "gps"}),
        (
            GPS_S % 604_800 + 0.1 * np.arange(3),
            {"time_unit": "s", "time_scale": "gps_week", "gps_week": int(GPS_S // 604_800)},
        ),
        (["2023-11-14T22:13:20.25Z", "2023-11-14T22:13:20.35Z", "2023-11-14T23:13:20.45+01:00"], {"time_scale": "iso"}),
    ],
)
def test_time_of_every_scale(tmp_path, times, keys, suffix):
    record = read(tmp_path, table(time_us=times), suffix, **keys)
    np.testing.assert_array_equal(record.log.time_us, FIRST_US + 100_000 * np.arange(3))


def test_week_of_each_row(tmp_path):
    week, second = divmod(GPS_S, 604_800)
    values = table(time_us=second + 0.1 * np.arange(3)).assign(w=int(week))
    record = read(tmp_path, values, columns={"week": "w"}, time_unit="s", time_scale="gps_week")
    np.testing.assert_array_equal(record.log.time_us, FIRST_US + 100_000 * np.arange(3))


def test_east_north_up_of_ros(tmp_path):
    values = table(x=20.0, y=10.0, z=5.0, r=5.0, p=0.0, h=30.0, sx=0.1, sy=0.2, sz=0.3, sr=1.0, sp=2.0, sh=3.0)
    columns = {
        "position": ("x", "y", "z"),
        "attitude": ("r", "p", "h"),
        "sigma_position": ("sx", "sy", "sz"),
        "sigma_attitude": ("sr", "sp", "sh"),
    }
    record = read(
        tmp_path, values, columns=columns, coordinates="enu", attitude_axes="enu", angle_unit="degrees", origin=ORIGIN
    )
    np.testing.assert_allclose(record.log.position_m[0], [10.0, 20.0, -5.0])
    np.testing.assert_allclose(np.rad2deg(record.log.euler_rad[0]), [5.0, 0.0, 60.0], atol=1e-12)
    sigma = np.sqrt(np.diag(record.covariances.covariance[0]))
    np.testing.assert_allclose(sigma, [0.2, 0.1, 0.3, *np.deg2rad([1.0, 2.0, 3.0])])
    assert record.origin == ORIGIN  # said by the platform file, so that exports can give back latitude and longitude


@pytest.mark.parametrize(
    ("places", "is_local"),
    [
        ({"north_m": 99_000.0, "east_m": 10_000.0, "down_m": -19_000.0}, True),
        ({"north_m": 6_248_551.0, "east_m": 332_962.0}, False),
        ({"north_m": 0.0, "east_m": 101_000.0}, False),
        ({"down_m": -21_000.0}, False),
    ],
)
def test_an_origin_is_not_that_of_coordinates_far_from_it(tmp_path, places, is_local):
    if is_local:
        assert read(tmp_path, table(**places), origin=ORIGIN).origin == ORIGIN
        return
    with pytest.raises(InputError, match=r"source.navigation.origin: .*write source.navigation.crs: EPSG"):
        read(tmp_path, table(**places), origin=ORIGIN)


def test_map_coordinates_lead_back_to_latitude_and_longitude(tmp_path):
    values = table(north_m=6_248_551.0, east_m=332_962.0, down_m=-42.0)
    record = read(tmp_path, values, crs="EPSG:32756")
    latitude, longitude, height = geodetic_from_local(record.frame, record.log.position_m)[0]
    assert (latitude, longitude, height) == pytest.approx((-33.8906, 151.1939, 42.0), abs=1e-3)


def test_file_without_heading_and_with_semicolons(tmp_path):
    table().to_csv(tmp_path / "log.txt", index=False, header=False, sep=";")
    section = TableSection(
        format="table",
        file="log.txt",
        heading=False,
        delimiter=";",
        columns={"time": "1", "position": ("2", "3", "4"), "attitude": ("5", "6", "7")},
    )
    np.testing.assert_allclose(read_navigation(section, tmp_path).log.euler_rad[2], [0.1, -0.2, 0.5])


@pytest.mark.parametrize(
    ("values", "keys", "told"),
    [
        (
            table().drop(columns="yaw_rad"),
            {},
            r"log.csv: found columns time_us, .*, expected among them yaw_rad; correct",
        ),
        (table(yaw_rad=np.nan), {}, r"log.csv: found no pose, expected a log of poses"),
        (table(yaw_rad=["a", "b", "c"]), {}, r"log.csv, row 2, yaw_rad: found 'a', expected a number; mend"),
        (
            table(yaw_rad=90.0),
            {},
            r"record 1: found roll, pitch, yaw 0.1, -0.2, 90 rad.*; correct source.navigation.angle_unit$",
        ),
        (
            table(time_us=[FIRST_US, FIRST_US + 5, FIRST_US + 5], north_m=[1.0, 2.0, 3.0]),
            {},
            r"log.csv, record 3: found time",
        ),
        (
            table(time_us=FIRST_US / 1e6 + np.arange(3)),
            {},
            r"record 1: found time 1700000000 us .*; correct source.navigation.time_unit, time_scale, gps_week or date",
        ),
        (
            table(time_us=["yesterday"] * 3),
            {"time_scale": "iso"},
            r"log.csv, time_us: found 'yesterday', expected a date and time such as",
        ),
        (table(time_us=[1.0, 2.0, 3.0]), {"time_scale": "gps_week", "time_unit": "s"}, r"without the week.*set source"),
        (table().iloc[:1], {}, r"log.csv: found 1 poses, expected two or more"),
        (
            table(),
            {"coordinates": "geodetic", "crs": "EPSG:4326", "frame": "projected"},
            r"source.navigation.crs: found 'EPSG:4326'",
        ),
    ],
)
def test_broken_table_is_one_line(tmp_path, values, keys, told):
    with pytest.raises(InputError, match=told) as error:
        read(tmp_path, values, **keys)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("name", ["log.csv", "log.parquet"])
def test_file_of_another_format_is_one_line(tmp_path, name):
    (tmp_path / name).write_bytes(b"\xff\xfe\x00\x01a,b\n1,2,3\n\x00")
    with pytest.raises(InputError) as error:
        read_navigation(TableSection(format="table", file=name), tmp_path)
    assert str(error.value).startswith(f"{tmp_path}/{name}: found")
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("coordinates", ["ned", "geodetic"])
def test_row_that_stands_twice_is_passed_over(tmp_path, caplog, coordinates):
    sigmas = {"sigma_position": ("north_m", "north_m", "north_m"), "sigma_attitude": ("yaw_rad",) * 3}
    values = table(time_us=FIRST_US + 10_000 * np.array([0, 1, 2, 2, 3, 4]))
    record = read(tmp_path, values, coordinates=coordinates, columns=sigmas)
    np.testing.assert_array_equal(record.log.time_us, FIRST_US + 10_000 * np.arange(5))
    np.testing.assert_array_equal(record.covariances.time_us, record.log.time_us)
    assert "log.csv: 1 records that repeat the one before are passed over" in caplog.text


def test_rows_without_a_value_are_left_out_and_counted(tmp_path, caplog):
    values = table(time_us=FIRST_US + 10_000 * np.arange(4), yaw_rad=[0.5, np.nan, 0.5, 0.5])
    record = read(tmp_path, values)
    np.testing.assert_array_equal(record.log.time_us, FIRST_US + 10_000 * np.array([0, 2, 3]))
    assert "log.csv: 1 of 4 rows have no time, position or attitude and are left out" in caplog.text


def test_rows_out_of_order_are_sorted_and_counted(tmp_path, caplog):
    sigmas = {"sigma_position": ("north_m", "north_m", "north_m"), "sigma_attitude": ("yaw_rad",) * 3}
    order = np.array([0, 2, 1, 3])
    record = read(tmp_path, table(time_us=FIRST_US + 10_000 * order, north_m=order + 1.0), columns=sigmas)
    np.testing.assert_array_equal(record.log.time_us, FIRST_US + 10_000 * np.arange(4))
    np.testing.assert_allclose(record.log.position_m[:, 0], [1, 2, 3, 4])
    np.testing.assert_allclose(record.covariances.covariance[:, 0, 0], [1, 4, 9, 16])
    assert "log.csv: 1 records behind later ones are sorted by time" in caplog.text


def test_seconds_of_the_week_are_not_taken_for_seconds_since_1980(tmp_path):
    values = table(time_us=GPS_S % 604_800 + np.arange(3))
    with pytest.raises(InputError, match=r"time_us: found times up to .*set source.navigation.time_scale to gps_week"):
        read(tmp_path, values, time_unit="s", time_scale="gps")
    keys = {"time_unit": "s", "time_scale": "gps_week", "gps_week": int(GPS_S // 604_800)}
    assert read(tmp_path, values, **keys).log.time_us[0] == FIRST_US


def test_a_negative_sigma_is_told(tmp_path):
    sigmas = {"sigma_position": ("north_m", "north_m", "north_m"), "sigma_attitude": ("yaw_rad",) * 3}
    values = table(time_us=FIRST_US + 10_000 * np.arange(3), north_m=[1.0, 2.0, -3.0])
    with pytest.raises(InputError, match=r"log\.csv, covariance 3: found a sigma or variance that is negative"):
        read(tmp_path, values, columns=sigmas)


def test_a_log_with_sigmas_needs_no_file_of_covariances(tmp_path):
    sigmas = {"sigma_position": ("north_m", "north_m", "north_m"), "sigma_attitude": ("yaw_rad",) * 3}
    record = read(tmp_path, table(time_us=FIRST_US + 10_000 * np.arange(3), north_m=[1.0, 2.0, 3.0]), columns=sigmas)
    source = ScansSection(kind="scans", covariances="covariances.csv")
    with pytest.raises(InputError, match=r"covariances\.csv: found no such file.*remove source\.covariances"):
        log_covariances(record, source, (3, 4, 5), tmp_path)


GEODETIC = {
    "coordinates": "geodetic",
    "columns": {"position": ("lat", "lon", "h"), "attitude": ("roll_rad", "pitch_rad", "yaw_rad")},
}


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"lat": 95.0}, r"record 8: found latitude 95, longitude 13 deg, height 51 m"),
        ({"yaw_rad": 9.0}, r"record 8: found roll, pitch, yaw 0.1, -0.2, 9 rad"),
        ({"time_us": -5}, r"record 8: found time -5 us since 1970"),
        ({"time_us": FIRST_US + 60_000}, rf"record 8: found time {FIRST_US + 60_000} us, expected a time after"),
    ],
)
def test_records_have_the_numbers_of_the_file(tmp_path, change, told):
    """Where rows of no place and of no value stand before them, one of them out of order."""
    values = table(time_us=FIRST_US + 10_000 * np.array([0, 1, 2, 4, 3, 5, 6, 7, 8]), lat=52.0, lon=13.0, h=50.0)
    values.loc[:2, ["lat", "lon"]] = 0.0
    values.loc[3, "yaw_rad"] = np.nan
    for name, value in {"h": 51.0, **change}.items():
        values.loc[7, name] = value
    with pytest.raises(InputError, match=rf"log\.csv, {told}"):
        read(tmp_path, values, **GEODETIC)


def test_the_index_of_a_parquet_file_is_a_column_as_others(tmp_path):
    for index in ("time_us", "yaw_rad"):
        table().set_index(index).to_parquet(tmp_path / "log.parquet")
        record = read_navigation(TableSection(format="table", file="log.parquet"), tmp_path)
        np.testing.assert_array_equal(record.log.time_us, FIRST_US + 100_000 * np.arange(3))

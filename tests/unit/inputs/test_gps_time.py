import logging
from datetime import UTC, datetime

import numpy as np
import pytest

from linepose.errors import InputError
from linepose.inputs import gps_time


def us(*when):
    return round(datetime(*when, tzinfo=UTC).timestamp() * 1e6)


# published pairs: the GPS epoch; the week rollovers of 1999 and 2019; before and after the leap second of 2016
@pytest.mark.parametrize(
    ("week", "second", "utc"),
    [
        (0, 0.0, (1980, 1, 6)),
        (1024, 0.0, (1999, 8, 21, 23, 59, 47)),
        (2048, 0.0, (2019, 4, 6, 23, 59, 42)),
        (1930, 16.0, (2016, 12, 31, 23, 59, 59)),
        (1930, 18.0, (2017, 1, 1)),
        (1512, 345_613.0, (2008, 12, 31, 23, 59, 59)),
    ],
)
def test_weeks_of_known_dates(week, second, utc):
    assert gps_time.unix_from_week(week, second) == us(*utc)


def test_unix_and_gps_are_inverse():
    unix = us(1981, 1, 1) + np.arange(0, 45 * 31_557_600, 86_400, dtype=np.int64) * 1_000_000
    np.testing.assert_array_equal(gps_time.unix_from_gps(gps_time.gps_from_unix(unix)), unix)


def test_the_leap_second_of_2016_lasts():
    gps = gps_time.gps_from_unix(us(2016, 12, 31, 23, 59, 59)) + np.arange(3) * 1_000_000
    midnight = us(2017, 1, 1)
    np.testing.assert_array_equal(gps_time.unix_from_gps(gps), [midnight - 1_000_000, midnight, midnight])


def test_there_have_been_18_leap_seconds_since_1980():
    leaps = gps_time.leap_seconds()
    assert leaps.total_s[-1] >= 18
    assert leaps.total_s[np.searchsorted(leaps.start_us, us(2020, 1, 1)) - 1] == 18
    assert leaps.expires_us > us(2025, 1, 1)


def test_a_time_beyond_the_list_is_converted_with_a_warning(caplog):
    gps = gps_time.gps_from_unix(us(2099, 1, 1))
    with caplog.at_level(logging.WARNING, logger="linepose"):
        assert abs(gps_time.unix_from_gps(gps) - us(2099, 1, 1)) == 0
    assert "update the package tzdata" in caplog.text
    assert "2099-01-01" in caplog.text
    caplog.clear()
    gps_time.unix_from_gps(gps_time.gps_from_unix(us(2024, 1, 1)))
    assert not caplog.text


@pytest.mark.parametrize(
    ("values", "unit", "expected"),
    [
        (np.array([1_700_000_000.123456]), "s", 1_700_000_000_123_456),
        (np.array([1_700_000_000_123.456]), "ms", 1_700_000_000_123_456),
        (np.array([1_700_000_000_123_456_789]), "ns", 1_700_000_000_123_457),
        (np.array([1_700_000_000]), "s", 1_700_000_000_000_000),
        (np.array([604_799.999_999_4]), "s", 604_799_999_999),
    ],
)
def test_microseconds_of_every_unit(values, unit, expected):
    assert gps_time.microseconds(values, unit).tolist() == [expected]


def test_a_week_that_ends_goes_on_in_the_next():
    of_week = np.array([604_799_000_000, 604_799_900_000, 100_000, 200_000])
    unix = gps_time.unix_from_week_of_first(2100, of_week, "log")
    np.testing.assert_array_equal(np.diff(unix), [900_000, 200_000, 100_000])
    assert unix[2] == gps_time.unix_from_week(2101, 0.1)
    assert gps_time.week_at(int(unix[0])) == 2100
    assert gps_time.week_at(int(unix[3])) == 2101


def test_a_week_that_is_missing_or_a_time_outside_it_is_told():
    with pytest.raises(InputError, match=r"log: found seconds of the GPS week without the week.*set source.navigation"):
        gps_time.unix_from_week_of_first(None, np.array([0]), "log")
    with pytest.raises(InputError, match=r"log, record 2: found 1700000000.000 s of the GPS week"):
        gps_time.unix_from_week_of_first(2100, np.array([0, 1_700_000_000_000_000]), "log")


@pytest.mark.parametrize(("unix_s", "is_told"), [(1_126_785_600, True), (1_440_000_000, False)])
def test_weeks_that_a_receiver_of_today_lost_are_told(caplog, unix_s, is_told):
    """2005-09-15 is 1024 weeks before 2025-05-01; 2015 is no time that a lost rollover leads to yet."""
    gps_time.tell_lost_weeks(unix_s * 1_000_000, "log.nmea")
    assert ("may have lost 1024 GPS weeks (2025-05-01); if it has" in caplog.text) == is_told


def test_years_before_christ_have_a_name_in_messages(caplog):
    gps_time.tell_lost_weeks(-250_000_000_000_000_000, "log.lcf")
    assert "log.lcf: times of -5953-" in caplog.text


def test_weeks_that_a_receiver_of_ten_bits_lost_are_told(caplog):
    gps_time.tell_lost_weeks(gps_time.GPS_EPOCH_US, "log.gps")
    assert "lost 1024 GPS weeks (1999-08-22) or 2048 GPS weeks (2019-04-07)" in caplog.text


def test_remedy_of_another_unit_is_of_the_reader():
    """The key, where the reader has one."""
    with pytest.raises(InputError, match=r"it looks like ns: set the time's unit \(time_unit: ns\)$"):
        gps_time.microseconds([1.7e18], "s", "log.csv", "time_unit")
    with pytest.raises(InputError, match=r"it looks like ns: write the times in s$"):
        gps_time.microseconds([1.7e18], "s", "log.lcf")

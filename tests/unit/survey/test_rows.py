"""Rows that no survey is made of are named, in one line."""

import numpy as np
import pandas as pd
import pytest

from linepose.errors import InputError
from linepose.survey.covariance_rule import NEGATIVE, asymmetric, correlations, least_eigenvalue
from linepose.survey.observations import OBSERVATIONS, survey_from_table, table_from_survey
from linepose.survey.rows import check_time_units, checked_rows


@pytest.fixture
def table(survey):
    return table_from_survey(survey)


@pytest.mark.parametrize(
    ("name", "value", "told"),
    [
        ("observation", np.nan, "observation nan, expected a whole number, not negative"),
        ("observation", -1, "observation -1, expected a whole number"),
        ("point", np.inf, "point inf"),
        ("time_us", np.nan, "time_us nan, expected a whole number of microseconds"),
        ("time_us", 1e30, "time_us 1e.30, expected a whole number of microseconds"),
        ("u_px", "x", "u_px x, expected a finite number"),
        ("north_m", np.nan, "north_m nan, expected a finite number"),
        ("yaw_rad", 90.0, "yaw_rad 90.0, expected radians; convert degrees"),
        ("covariance_north_north", np.inf, "covariance_north_north inf"),
        ("nav_gap_s", np.nan, "nav_gap_s nan"),
    ],
)
def test_what_is_no_number_of_its_kind_is_named_with_its_row(table, name, value, told):
    table = table.astype({name: object})
    table.loc[3, name] = value
    with pytest.raises(InputError, match=f"observations, row 3: found {told}") as raised:
        survey_from_table(table)
    assert "\n" not in str(raised.value)


def test_a_table_without_a_column_or_rows_is_refused(table):
    with pytest.raises(InputError, match="no column u_px"):
        survey_from_table(table.drop(columns="u_px"))
    with pytest.raises(InputError, match="no row"):
        survey_from_table(table.iloc[:0])


def test_dates_are_no_microseconds(table):
    dated = table.assign(time_us=pd.to_datetime(table["time_us"], unit="us"))
    with pytest.raises(InputError, match=r"row 0: found time_us .* whole number of microseconds"):
        survey_from_table(dated)


def test_numbers_as_text_count_as_numbers(table):
    again = checked_rows(table.astype({"u_px": str, "observation": str}), OBSERVATIONS.names)
    np.testing.assert_array_equal(again["u_px"], table["u_px"])
    assert again["observation"].dtype == np.int64


def test_times_in_other_units_are_told():
    time_us = np.arange(6) * 100_000
    rows = pd.DataFrame({"observation": np.repeat([1, 2], 3), "time_us": time_us, "east_m": 0.0, "down_m": 0.0})
    rows["north_m"] = 1e-6 * time_us
    check_time_units(rows)
    check_time_units(rows.assign(time_us=0))
    for per_s in (1, 1000):
        with pytest.raises(InputError, match="give microseconds, or leave the times out"):
            check_time_units(rows.assign(time_us=time_us * per_s // 100_000, north_m=np.arange(6.0)))


def test_one_rule_says_what_a_covariance_is():
    ones = np.ones((6, 6))
    rounded = ones + 0.9 * NEGATIVE * (ones - np.eye(6))
    scale = np.outer(np.arange(1, 7), np.arange(1, 7)) * 1e-4
    assert least_eigenvalue(correlations(rounded * scale)) >= -NEGATIVE
    assert least_eigenvalue(correlations((2 * ones - np.eye(6)) * scale)) < -NEGATIVE
    assert least_eigenvalue(correlations(np.diag([1.0, 1, 1, 1, 1, -1e-9]))) < -NEGATIVE
    assert not asymmetric(correlations(scale))
    assert asymmetric(correlations(scale + 1e-8 * np.eye(6, k=1)))

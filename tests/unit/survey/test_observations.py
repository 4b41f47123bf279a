from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from linepose.errors import InputError
from linepose.survey.observations import COVARIANCE_COLUMNS, check_determined, survey_from_table, table_from_survey


def with_gaps(survey):
    """Observation 2 lacks point 1, observation 5 lacks points 0 and 3."""
    u_px = survey.u_px.copy()
    u_px[1, 1] = u_px[4, 0] = u_px[4, 3] = np.nan
    return replace(survey, u_px=u_px)


def test_table_has_one_row_an_observed_point_in_map_coordinates(survey):
    table = table_from_survey(with_gaps(survey))
    assert len(table) == 32 - 3
    assert list(zip(table["observation"], table["point"], strict=True)) == [
        (n, m) for n in range(1, 9) for m in range(4) if (n, m) not in {(2, 1), (5, 0), (5, 3)}
    ]
    second = table[(table["observation"] == 3) & (table["point"] == 2)].iloc[0]
    assert second["time_us"] == survey.time_us[2, 2]
    np.testing.assert_allclose(second["north_m"], survey.position_m[2, 2, 0] + 6_248_551.0, atol=2e-9)
    assert second["yaw_rad"] == survey.euler_rad[2, 2, 2]
    assert second["covariance_east_yaw"] == survey.covariance[2, 2, 1, 5]
    assert second["nav_gap_s"] == 0.25


def test_covariance_columns_are_the_upper_triangle():
    assert len(COVARIANCE_COLUMNS) == 21
    assert COVARIANCE_COLUMNS[:7] == (
        *(f"covariance_north_{axis}" for axis in ("north", "east", "down", "roll", "pitch", "yaw")),
        "covariance_east_east",
    )


def test_survey_returns_from_its_table(survey):
    gaps = with_gaps(survey)
    back = survey_from_table(table_from_survey(gaps).sample(frac=1, random_state=1))
    seen = np.isfinite(gaps.u_px)
    np.testing.assert_array_equal(back.number, gaps.number)
    np.testing.assert_array_equal(back.u_px, gaps.u_px)
    np.testing.assert_array_equal(back.time_us[seen], gaps.time_us[seen])
    np.testing.assert_array_equal(back.euler_rad[seen], gaps.euler_rad[seen])
    np.testing.assert_array_equal(back.nav_gap_s[seen], gaps.nav_gap_s[seen])
    np.testing.assert_array_equal(np.isnan(back.position_m).any(axis=-1), ~seen)
    np.testing.assert_allclose(back.covariance[seen], gaps.covariance[seen], rtol=1e-15)
    # a map coordinate of 6e6 m is held to 1e-9 m
    np.testing.assert_allclose(
        (back.position_m + back.origin_m)[seen], (gaps.position_m + gaps.origin_m)[seen], atol=2e-9
    )


def test_origin_is_the_mean_position_in_whole_metres(survey):
    table = table_from_survey(survey)
    origin = survey_from_table(table).origin_m
    np.testing.assert_array_equal(origin, table[["north_m", "east_m", "down_m"]].mean().round())


def test_numbers_need_not_be_consecutive(survey):
    table = table_from_survey(survey)
    kept = survey_from_table(table[table["observation"].isin([2, 7])])
    assert kept.number.tolist() == [2, 7]
    np.testing.assert_array_equal(kept.u_px, survey.u_px[[1, 6]])


def test_selection_takes_every_field_in_the_given_order(survey):
    chosen = survey.select([7, 2])
    assert (chosen.n_observations, chosen.n_points) == (2, 4)
    for field in ("number", "time_us", "u_px", "position_m", "euler_rad", "covariance", "nav_gap_s"):
        np.testing.assert_array_equal(getattr(chosen, field), getattr(survey, field)[[6, 1]])
    np.testing.assert_array_equal(chosen.origin_m, survey.origin_m)


def test_refuses_to_select_what_is_not_there(survey):
    with pytest.raises(InputError) as error:
        survey.select([1, 9, 12])
    assert str(error.value) == (
        "observations: found number 9, 12, expected numbers among [1, 2, 3, 4, 5, 6, 7, 8]; "
        "remove it from the selection"
    )


def with_views(survey, *views):
    """The first observations of a survey that see this many points each."""
    u_px = np.full((len(views), survey.n_points), 1.0)
    for row, n in enumerate(views):
        u_px[row, n:] = np.nan
    return replace(survey.select(range(1, len(views) + 1)), u_px=u_px)


def test_six_spare_equations_are_enough(survey):
    check_determined(with_views(survey, 2, 2, 2), 6)  # 12 equations, 6 coordinates of points
    check_determined(with_views(survey, 3, 3, 2, 1), 6)  # points 0, 1, 2 seen 4, 3, 2 times: 18 - 9


@pytest.mark.parametrize(
    ("views", "found"),
    [
        ((4,), "0 spare equations (1 observations, 0 points in two or more)"),
        ((4, 4), "4 spare equations (2 observations, 4 points in two or more)"),
        ((1, 1, 1, 1), "5 spare equations (4 observations, 1 points in two or more)"),
    ],
)
def test_refuses_too_few_views_for_six_parameters(survey, views, found):
    with pytest.raises(InputError) as error:
        check_determined(with_views(survey, *views), 6)
    assert (
        str(error.value) == f"observations: found {found}, expected at least 6; add observations, or label more points"
    )


def test_table_is_sorted_whatever_the_survey_was_made_from(survey):
    shuffled = table_from_survey(survey).sample(frac=1, random_state=2)
    again = table_from_survey(survey_from_table(shuffled))
    pd.testing.assert_frame_equal(
        again, shuffled.sort_values(["observation", "point"], ignore_index=True), check_exact=False, rtol=0, atol=2e-9
    )

import numpy as np
import pandas as pd
import pytest

from linepose.errors import InputError
from linepose.inputs.navigation.covariance_file import read_covariances
from linepose.survey.navigation import (
    NAVIGATION_SIGMA,
    NavigationCovariances,
    associate_covariances,
    median_sigma_table,
)
from linepose.survey.observations import COVARIANCE_COLUMNS, survey_from_table

START_US = 1_466_034_716_053_000
ATTITUDE = (3, 4, 5)


def matrix_12(scale=1.0):
    """A covariance of full rank whose every entry differs."""
    root = np.random.default_rng(8).normal(size=(12, 12))
    return scale * root @ root.T


@pytest.fixture
def log(tmp_path):
    """Writes rows of (time, 12x12) and gives the file's path."""

    def write(*rows):
        path = tmp_path / "nav_covs.csv"
        path.write_text("".join(f"{time}," + ",".join(map(repr, np.ravel(m).tolist())) + "\n" for time, m in rows))
        return path

    return write


def seconds(*times_s):
    return np.array([START_US + round(t * 1e6) for t in times_s])


def test_takes_position_and_the_chosen_attitude_columns(log):
    matrix = matrix_12()
    read = read_covariances(log((START_US, matrix), (START_US + 1, 2 * matrix)), (6, 8, 7))
    assert read.time_us.tolist() == [START_US, START_US + 1]
    chosen = [0, 1, 2, 6, 8, 7]
    np.testing.assert_array_equal(read.covariance, np.array([matrix, 2 * matrix])[:, chosen][:, :, chosen])


def test_six_printed_digits_of_a_singular_covariance_pass(log):
    column = np.random.default_rng(9).uniform(0.5, 2.0, (12, 1)) * np.array([[1.0]] * 3 + [[1e-3]] * 9)
    printed = np.vectorize(lambda x: float(f"{x:.6g}"))(column @ column.T)
    assert np.linalg.eigvalsh(printed[:6, :6])[0] < 0
    read_covariances(log((START_US, printed)), ATTITUDE)


def test_faults_outside_the_chosen_columns_do_not_matter(log):
    matrix = matrix_12()
    matrix[9, 10] = 77.0
    read_covariances(log((START_US, matrix)), ATTITUDE)


def asymmetric():
    matrix = matrix_12()
    matrix[1, 7], matrix[7, 1] = 0.25, 0.5
    return matrix


def negative_variance():
    matrix = np.diag(np.repeat([25.0, 1e-8], [3, 9]))
    matrix[7, 7] = -1e-8  # far below what position's variance counts
    return matrix


def correlated_beyond_one():
    matrix = np.eye(12)
    matrix[0, 1] = matrix[1, 0] = 1.5
    return matrix


def with_a_gap():
    matrix = matrix_12()
    matrix[6, 0] = np.nan
    return matrix


@pytest.mark.parametrize(
    ("matrix", "fault"),
    [
        (
            asymmetric(),
            "found covariance 0.25 at (1, 7) and 0.5 at (7, 1), expected a symmetric matrix; "
            "check the column order, or remove the row",
        ),
        (
            negative_variance(),
            "found a covariance whose correlations have the eigenvalue -1, expected a positive semi-definite matrix; "
            "check navigation.covariance_columns, or remove the row",
        ),
        (
            correlated_beyond_one(),
            "found a covariance whose correlations have the eigenvalue -0.5, expected a positive semi-definite matrix; "
            "check navigation.covariance_columns, or remove the row",
        ),
        (with_a_gap(), "found a covariance that is no number, expected 36 finite numbers; remove or mend the row"),
    ],
)
def test_names_the_row_of_a_matrix_that_is_no_covariance(log, matrix, fault):
    path = log((START_US, matrix_12()), (START_US + 1_000_000, matrix))
    with pytest.raises(InputError) as error:
        read_covariances(path, (6, 7, 8))
    assert str(error.value) == f"{path}, row 2: {fault}"


def test_names_the_row_of_a_second_matrix_at_one_time(log):
    path = log((START_US, matrix_12()), (START_US + 5, matrix_12()), (START_US + 5, 2 * matrix_12()))
    with pytest.raises(InputError) as error:
        read_covariances(path, ATTITUDE)
    assert str(error.value) == (
        f"{path}, row 3, column 1: found time {START_US + 5} with another matrix, expected one matrix at a time; "
        "remove one of the rows"
    )


def test_rows_out_of_order_are_sorted_and_repeats_passed_over(log, caplog):
    path = log(
        (START_US, matrix_12()), (START_US + 9, matrix_12()), (START_US + 5, 2 * matrix_12()), (START_US, matrix_12())
    )
    found = read_covariances(path, ATTITUDE)
    np.testing.assert_array_equal(found.time_us, START_US + np.array([0, 5, 9]))
    np.testing.assert_allclose(found.covariance[1], 2 * found.covariance[0])
    assert "1 records that repeat the one before are passed over; 2 records behind later ones are sorted" in caplog.text


def test_names_a_time_in_seconds(log):
    path = log((1_466_034_716, matrix_12()))
    with pytest.raises(InputError) as error:
        read_covariances(path, ATTITUDE)
    assert str(error.value) == (
        f"{path}, row 1, column 1: found time 1466034716, expected microseconds since 1970-01-01; "
        "they look like seconds: multiply by 1000000"
    )


def test_names_a_missing_column(log):
    path = log((START_US, np.zeros(143)))
    with pytest.raises(InputError) as error:
        read_covariances(path, ATTITUDE)
    assert str(error.value) == (
        f"{path}, row 1: found 144 columns, expected 145 columns (time (us) and 144 covariances); mend the row"
    )


def navigation(*times_s):
    """Covariances that carry their index: k+1 times one matrix."""
    matrix = matrix_12()[:6, :6]
    return NavigationCovariances(
        seconds(*times_s), np.arange(1, len(times_s) + 1)[:, None, None] * matrix, "nav_covs.csv"
    )


def points(*times_s):
    return pd.DataFrame({"observation": 3, "point": np.arange(len(times_s)), "time_us": seconds(*times_s)})


def test_nearest_time_stamp_is_taken():
    times_s = np.random.default_rng(4).uniform(0, 12, 200)
    log_s = np.cumsum(np.random.default_rng(5).uniform(0.5, 1.5, 9))
    associated = associate_covariances(points(*times_s), navigation(*log_s), 20.0)
    distance = np.abs(seconds(*times_s)[:, None] - seconds(*log_s)) / 1e6
    np.testing.assert_array_equal(associated["nav_gap_s"], distance.min(axis=1))
    matrix = matrix_12()[:6, :6]
    factor = associated["covariance_north_yaw"] / matrix[0, 5]
    np.testing.assert_allclose(factor, distance.argmin(axis=1) + 1, rtol=1e-14)


def test_whole_matrix_arrives():
    associated = associate_covariances(points(0.9), navigation(0.0, 1.0), 1.0)
    upper = matrix_12()[:6, :6][np.triu_indices(6)]
    np.testing.assert_allclose(associated[list(COVARIANCE_COLUMNS)].iloc[0], 2 * upper, rtol=1e-15)


@pytest.mark.parametrize(("time_s", "gap_s"), [(-2.0, 2.0), (0.0, 0.0), (3.5, 3.5)])
def test_one_covariance_serves_alone(time_s, gap_s):
    assert associate_covariances(points(time_s), navigation(0.0), 5.0)["nav_gap_s"].tolist() == [gap_s]


@pytest.mark.parametrize(
    ("matrix", "told"),
    [
        (np.zeros((6, 6)), "a covariance that is zero.*data sheet"),
        (-np.eye(6), "a covariance with a negative eigenvalue"),
    ],
)
def test_names_the_point_whose_covariance_is_none(matrix, told):
    matrices = np.stack([matrix_12()[:6, :6], matrix])
    reported = NavigationCovariances(seconds(0.0, 1.0), matrices, "nav_covs.csv")
    associate_covariances(points(0.1), reported, 1.0)
    with pytest.raises(InputError, match=f"nav_covs.csv: observation 3, point 1: found {told}"):
        associate_covariances(points(0.1, 0.9), reported, 1.0)


def test_gap_of_exactly_the_maximum_passes():
    associate_covariances(points(2.0), navigation(0.0, 1.0), 1.0)


def test_names_the_point_of_the_largest_gap():
    with pytest.raises(InputError) as error:
        associate_covariances(points(0.5, 3.25, 2.1), navigation(0.0, 1.0), 1.0)
    assert str(error.value) == (
        f"nav_covs.csv: observation 3, point 1: found the covariance nearest to its time {START_US + 3_250_000} us "
        "2.250 s away, expected at most 1 s; "
        "complete the navigation log, correct the clocks, or raise navigation.maximum_gap_s"
    )


def test_read_covariances_remember_their_file(log):
    path = log((START_US, matrix_12()))
    assert read_covariances(path, ATTITUDE).source == str(path)


def test_median_is_of_the_variances():
    log_of_three = navigation(0.0, 1.0, 2.0)
    expected = np.sqrt(2 * np.diag(matrix_12()[:6, :6]))
    np.testing.assert_allclose(log_of_three.median_sigma(), expected, rtol=1e-15)
    table = median_sigma_table(log_of_three)
    assert list(table.columns) == NAVIGATION_SIGMA.names
    np.testing.assert_array_equal(table.iloc[0], log_of_three.median_sigma())


@pytest.mark.field
def test_field_medians_are_table_2s(field_data, published):
    sigma = read_covariances(field_data / "nav_covs.csv", ATTITUDE).median_sigma()
    obtained = np.concatenate([sigma[:3], np.rad2deg(sigma[3:])])
    np.testing.assert_allclose(obtained, published["table2"]["ladybird"], rtol=0.02)


@pytest.mark.field
def test_field_attitude_sigmas_are_those_that_the_platform_file_names(field_data):
    sigma = read_covariances(field_data / "nav_covs.csv", (6, 7, 8)).median_sigma()
    np.testing.assert_allclose(np.rad2deg(sigma[3:]), [0.007, 0.007, 0.100], rtol=0, atol=0.0005)


@pytest.mark.field
def test_field_survey_is_25_views_of_15_points_half_a_second_from_a_covariance(field_data, ladybird):
    from linepose.inputs.labels.labelled_views import read_labelled_views, select_views

    views = select_views(field_data, ladybird.source.views, ladybird.source.first, ladybird.source.step)
    table = read_labelled_views(views, ladybird.camera.n_pixels)
    associated = associate_covariances(table, read_covariances(field_data / "nav_covs.csv", ATTITUDE), 1.0)
    assert associated["nav_gap_s"].max() == pytest.approx(0.504797, abs=5e-7)
    survey = survey_from_table(associated)
    assert survey.u_px.shape == (25, 15)
    assert np.isfinite(survey.u_px).all()
    assert survey.number.tolist() == list(range(1, 26))

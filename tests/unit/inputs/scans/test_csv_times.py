import numpy as np
import pytest

from linepose.errors import InputError
from linepose.inputs.scans.csv_times import read_times

TIMES_US = np.array([1_700_000_000_250_000, 1_700_000_000_257_500])


@pytest.mark.parametrize("heading", ["", "time_us\n", "Time (s)\n", "\ufeff"])
@pytest.mark.parametrize(
    "rows",
    [
        ["1700000000250000", "1700000000257500"],
        ["1700000000.25", "1700000000.257500"],
        ["2023-11-14T22:13:20.25Z", "2023-11-14T22:13:20.257500Z"],
        ["2023/11/14 22:13:20.250", "2023/11/14 22:13:20.2575"],
        ["2023-11-14T23:13:20.25+01:00", "2023-11-14T22:13:20.2575+00:00"],
        ["2023-11-14T22:13:20,25Z", "2023-11-14T22:13:20,2575Z"],
        ["1700000000,25", "1700000000,2575"],
        ["1.70000000025e+09", "1.7000000002575e+09"],
        ["1.700000000250000000e+15", "1.700000000257500000e+15"],
    ],
)
def test_stamps_of_every_kind(tmp_path, heading, rows):
    path = tmp_path / "a-times.csv"
    path.write_text(heading + "\n".join(rows) + "\n\n")
    times, n_heading = read_times(path)
    np.testing.assert_array_equal(times, TIMES_US)
    assert n_heading == ("ime" in heading)


@pytest.mark.parametrize(
    ("rows", "told"),
    [
        (["1700000000250000", "x"], r"row 2: found 'x', expected a whole number of microseconds; mend"),
        (["1700000000250000", "1700000000.25"], r"row 2: found '1700000000.25', expected a whole number"),
        (["1700000000.25", "1700000000250000"], r"row 2: found .*, expected seconds with decimals"),
        (["2023-11-14T22:13:20Z", "2023-13-14T22:13:20Z"], r"row 2: found '2023-13.*, expected a date and time"),
        (["12:30", "12:31"], r"row 1: found '12:30', expected one time alone: a whole number of microseconds, seconds"),
        (["0,1700000000.25", "1,1700000000.26"], r"row 1: found '0,17.*', expected one time alone"),
        (["0,1700000000", "1,1700000001"], r"row 1: found '0,17.*', expected one time alone"),
        (["0,1700000000000000", "1,1700000000010000"], r"row 1: found '0,17.*', expected one time alone"),
        (
            [f"1700000000,{us}" for us in (5, 1005, 2005, 10005)],
            r"row 1: found '1700000000,5', expected one time alone",
        ),
        (["9" * 19, "1"], r"row 1: found '9999999999999999999', expected a whole number"),
    ],
)
def test_rows_of_another_kind_are_told(tmp_path, rows, told):
    (tmp_path / "a-times.csv").write_text("\n".join(rows))
    with pytest.raises(InputError, match=told):
        read_times(tmp_path / "a-times.csv")


def test_seconds_whose_decimals_are_left_out_where_they_are_zero(tmp_path):
    (tmp_path / "a-times.csv").write_text("1700000000\n1700000000.01\n1700000000.02\n")
    np.testing.assert_array_equal(read_times(tmp_path / "a-times.csv")[0] - 1_700_000_000_000_000, [0, 10_000, 20_000])


def test_text_of_spreadsheets(tmp_path):
    (tmp_path / "a-times.csv").write_bytes("1700000000.25\r\n1700000000.2575\r\n".encode("utf-16"))
    np.testing.assert_array_equal(read_times(tmp_path / "a-times.csv")[0], TIMES_US)

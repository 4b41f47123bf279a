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
        (["12:30", "12:31"], r"row 1: found '12:30', expected a whole number of microseconds"),
    ],
)
def test_rows_of_another_kind_are_told(tmp_path, rows, told):
    (tmp_path / "a-times.csv").write_text("\n".join(rows))
    with pytest.raises(InputError, match=told):
        read_times(tmp_path / "a-times.csv")

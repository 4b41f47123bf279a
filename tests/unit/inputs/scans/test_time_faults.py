from pathlib import Path

import numpy as np
import pytest

from linepose.errors import InputError
from linepose.inputs.scans.time_faults import checked_line_times

GOOD = 1_700_000_000_000_000 + 7_500 * np.arange(20)
PATH = Path("a-times.csv")


def checked(times, n_lines=20):
    return checked_line_times(np.asarray(times), n_lines, PATH, 1)


def test_good_stamps_pass_without_a_word(caplog):
    np.testing.assert_array_equal(checked(GOOD), GOOD)
    assert not caplog.text


@pytest.mark.parametrize("row", [0, 7, 19])
def test_line_stamped_twice_is_passed_over(caplog, row):
    np.testing.assert_array_equal(checked(np.insert(GOOD, row + 1, GOOD[row])), GOOD)
    assert f"stamp {row + 2} of a line stamped twice is passed over" in caplog.text


@pytest.mark.parametrize(
    "times",
    [
        np.append(GOOD, GOOD[-1] + 7_500),
        np.insert(GOOD, 0, GOOD[0] - 1_000_000),  # of a trigger before the recording, or a pause and one too many
        np.append(GOOD, GOOD[-1] + 1_000_000),
    ],
)
def test_one_too_many_that_nothing_tells_is_refused(times):
    with pytest.raises(InputError, match=r"a-times.csv: found 21 time stamps, expected 20"):
        checked(times)


@pytest.mark.parametrize("repeats_before", [True, False])
def test_stamp_that_stands_twice_is_put_between_its_neighbours(caplog, repeats_before):
    times = GOOD.copy()
    times[7] = times[6] if repeats_before else times[8]
    np.testing.assert_array_equal(checked(times), GOOD)
    assert "a time that stands twice is put between its neighbours" in caplog.text


def test_stamp_that_stands_twice_without_a_longer_step_is_refused():
    times = GOOD.copy()
    times[8:] -= 7_500
    with pytest.raises(InputError, match=r"row 10: found time .*, expected a time after the line before it"):
        checked(times)


def test_jump_is_told(caplog):
    times = GOOD.copy()
    times[8:] += 500_000
    np.testing.assert_array_equal(checked(times), times)
    assert "a-times.csv, row 10: 0.507 s after the line before it, where lines are 0.007500 s apart" in caplog.text

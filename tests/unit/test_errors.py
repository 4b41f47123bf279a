import pickle

import numpy as np
import pytest

from linepose.errors import EstimationError, InputError, LineposeError, quoted


def test_message_is_one_line_of_place_found_expected_remedy():
    error = InputError("a.csv, row 3", "'x'", "a number", "mend the cell")
    assert str(error) == "a.csv, row 3: found 'x', expected a number; mend the cell"


def test_survives_the_way_back_from_another_process():
    error = pickle.loads(pickle.dumps(InputError("a.csv", "nothing", "rows", "restore it")))
    assert str(error) == "a.csv: found nothing, expected rows; restore it"
    assert error.remedy == "restore it"


def test_one_base_catches_both():
    assert issubclass(InputError, LineposeError)
    assert issubclass(EstimationError, LineposeError)


@pytest.mark.parametrize(("value", "told"), [("x", "'x'"), (np.float64(0.1), "0.1"), (np.int64(3), "3"), ([1], "[1]")])
def test_a_value_is_quoted_as_python_writes_it(value, told):
    assert quoted(value) == told

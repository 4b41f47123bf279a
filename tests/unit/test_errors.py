import errno
import pickle
import re

import numpy as np
import pytest

from linepose.errors import EstimationError, InputError, LineposeError, one_line, quoted


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


def test_what_a_file_holds_never_reaches_the_terminal_as_it_is():
    error = InputError("a\nb.csv", "\x1b[31mred\x00", "x" * 10_000, "mend it")
    assert str(error).isprintable()
    assert r"\x1b[31mred\x00" in str(error)
    assert len(str(error)) < 800


@pytest.mark.parametrize(
    ("error", "told"),
    [
        (OSError(errno.ENOSPC, "No space left on device", "results/a"), "results/a: found no space left on device"),
        (OSError(errno.EFBIG, "File too large", "results/a"), "results/a: found file too large, .*ulimit -f"),
        (PermissionError(errno.EACCES, "no", "a"), "a: found permission denied, expected the right to read or write"),
        (MemoryError(), "too little memory"),
        (OSError(errno.ENOMEM, "Cannot allocate memory"), "too little memory"),
        (KeyError("x"), None),
        (FileNotFoundError(errno.ENOENT, "no", "x"), None),
    ],
)
def test_faults_of_the_machine_are_one_line_those_of_the_program_none(error, told):
    line = one_line(error)
    assert (line is None) if told is None else re.search(told, line)

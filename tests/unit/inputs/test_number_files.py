import contextlib
import errno
import os

import numpy as np
import pytest

from linepose.errors import InputError
from linepose.inputs.control_points import read_control_points
from linepose.inputs.labels.labels import read_labels
from linepose.inputs.navigation.log_file import read_navigation_log
from linepose.inputs.number_files import check_microseconds, read_numbers
from linepose.inputs.text_files import check_text, small_text

WHAT = "time (us), a, b"


@pytest.fixture
def csv(tmp_path):
    """Writes a file and gives its path."""

    def write(text):
        path = tmp_path / "numbers.csv"
        path.write_bytes(text.encode() if isinstance(text, str) else text)
        return path

    return write


def test_reads_whole_numbers_exactly_and_empty_cells_as_nan(csv):
    time_us, others = read_numbers(csv("1466040439908161,1.5,-2e-3\n1466040439908162,, 4\r\n\n"), 3, WHAT)
    assert time_us.tolist() == [1466040439908161, 1466040439908162]
    np.testing.assert_array_equal(others, [[1.5, -2e-3], [np.nan, 4.0]])


@pytest.mark.parametrize(
    ("content", "place", "rest"),
    [
        ("", "", "found an empty file, expected time (us), a, b; restore it, or leave it out"),
        (" \n\n", "", "found an empty file, expected time (us), a, b; restore it, or leave it out"),
        ("1,2,3\n1,2\n", ", row 2", "found 2 columns, expected 3 columns (time (us), a, b); mend the row"),
        ("1,2,3,4\n", ", row 1", "found 4 columns, expected 3 columns (time (us), a, b); mend the row"),
        ("1,2,3\n\n1,2,x\n", ", row 2", "found 1 columns, expected 3 columns (time (us), a, b); mend the row"),
        ("1,2,3\n1,2,x\n", ", row 2, column 3", "found 'x', expected a number; mend the cell"),
        (
            "t,a,b\n1,2,3\n",
            ", row 1, column 1",
            "found 't', expected a whole number; write the time as a whole number of microseconds",
        ),
        (
            "1,2,3\n1466040439.908,2,3\n",
            ", row 2, column 1",
            "found '1466040439.908', expected a whole number; write the time as a whole number of microseconds",
        ),
        (
            "99999999999999999999,2,3\n",
            ", row 1, column 1",
            "found '99999999999999999999', expected a whole number; write the time as a whole number of microseconds",
        ),
        (b"1,2,\xff\n", "", "found bytes that are not UTF-8, expected time (us), a, b; save the file as UTF-8 text"),
    ],
)
def test_names_the_fault(csv, content, place, rest):
    path = csv(content)
    with pytest.raises(InputError) as error:
        read_numbers(path, 3, WHAT)
    assert str(error.value) == f"{path}{place}: {rest}"


def test_names_a_missing_file(tmp_path):
    path = tmp_path / "none.csv"
    with pytest.raises(InputError) as error:
        read_numbers(path, 3, WHAT)
    assert str(error.value) == (
        f"{path}: found no such file, expected time (us), a, b; restore it, or correct the platform file"
    )


@pytest.mark.parametrize(
    ("time", "remedy"),
    [
        (1_466_040_439, "they look like seconds: multiply by 1000000"),
        (1_466_040_439_908, "they look like milliseconds: multiply by 1000"),
        (1_466_040_439_908_160_000, "they look like nanoseconds: multiply by 0.001"),
        (0, "write microseconds since 1970"),
        (-5, "write microseconds since 1970"),
    ],
)
def test_guesses_the_unit_of_times_that_are_no_microseconds(tmp_path, time, remedy):
    path = tmp_path / "nav.csv"
    with pytest.raises(InputError) as error:
        check_microseconds(np.array([1_466_040_439_908_160, time]), path)
    assert str(error.value) == (
        f"{path}, row 2, column 1: found time {time}, expected microseconds since 1970-01-01; {remedy}"
    )


def test_microseconds_from_1980_to_2100_pass(tmp_path):
    first, last = (int(np.datetime64(day, "us").astype(int)) for day in ("1980-01-06", "2100-01-01"))
    check_microseconds(np.array([first, last]), tmp_path)
    with pytest.raises(InputError):
        check_microseconds(np.array([first - 1]), tmp_path)
    with pytest.raises(InputError):
        check_microseconds(np.array([last + 1]), tmp_path)


@pytest.mark.parametrize(("sign", "name"), [(";", "semicolons"), ("\t", "tabs")])
@pytest.mark.parametrize(
    ("read", "heading"),
    [
        (lambda path: read_labels(path, [1]), "observation,point,u_px,line\n"),
        (read_navigation_log, "time_us,north_m,east_m,down_m\n"),
        (lambda path: read_control_points(path, None, None), "id,north_m,east_m,down_m\n"),
        (lambda path: read_numbers(path, 4, WHAT), ""),
    ],
)
def test_tables_tell_other_signs_between_cells(csv, read, heading, sign, name):
    rows = [row.replace(",", sign) for row in (heading, "1,2,3,4\n", "1,2,3.5,4.25\n")]
    path = csv("".join(row.replace(".", ",") for row in rows))
    with pytest.raises(InputError, match=f"numbers.csv: found {name} between cells, expected commas"):
        read(path)


def test_bytes_that_are_no_text_are_told_before_all_are_read(tmp_path):
    for content, is_text in ((b"1,2\n", True), (b"\xff\xfe1\x00", True), (b"1,2\n\x00\x00", False)):
        (tmp_path / "a.csv").write_bytes(content)
        with contextlib.nullcontext() if is_text else pytest.raises(InputError, match="found bytes that are"):
            check_text(tmp_path / "a.csv", "numbers")


def test_a_line_without_an_end_is_told_before_all_is_read(tmp_path):
    path = tmp_path / "a.csv"
    path.write_bytes(b"1," * 600_000)
    with pytest.raises(
        InputError, match=r"a.csv, line 1: found no line end within 1000000 bytes, expected lines of num"
    ):
        check_text(path, "numbers")
    check_text(path, "JSON", in_lines=False)
    path.write_bytes(b"1," * 400_000 + b"\n" + b"1," * 600_000)
    check_text(path, "numbers")


@pytest.mark.parametrize(
    ("fault", "told"),
    [
        (errno.EACCES, "found a file that may not be read, expected numbers; get the right to read it"),
        (errno.EIO, "found input/output error, expected numbers; restore it"),
    ],
)
@pytest.mark.parametrize("read", [check_text, lambda path, what: small_text(path, what, "key")])
def test_a_file_that_cannot_be_read_is_an_input_error(csv, monkeypatch, read, fault, told):
    path = csv("1,2\n")

    def refuse(self, *args, **kwargs):
        raise OSError(fault, os.strerror(fault), str(self))

    monkeypatch.setattr("pathlib.Path.open", refuse)
    with pytest.raises(InputError, match=told):
        read(path, "numbers")


@pytest.mark.parametrize(
    "read", [lambda path: read_labels(path, [1]), lambda path: read_control_points(path, None, None)]
)
def test_a_comment_in_place_of_the_heading_is_told(csv, read):
    with pytest.raises(InputError, match=r"found a heading that begins with '# of Monday', .*; remove the comment"):
        read(csv("# of Monday\nid,north_m,east_m,down_m\n1,2,3,4\n"))

"""Tables of control points: what they say, and what is told of rows and columns that say nothing."""

import numpy as np
import pytest

from linepose.errors import InputError
from linepose.inputs.control_points import read_control_points

HEADING = "id,north_m,east_m,down_m,sigma_m\n"


def read(folder, text):
    (folder / "points.csv").write_text(text)
    return read_control_points(folder / "points.csv", None, None)


def test_points_by_name_and_heights_alone(tmp_path):
    known = read(tmp_path, f"{HEADING}A, 1.5,2.5,-3,0.1\nB,,,-2.5,0.2\n")
    np.testing.assert_allclose(known["A"].position_m, [1.5, 2.5, -3])
    np.testing.assert_allclose(np.diag(known["A"].information), [100] * 3)
    np.testing.assert_allclose(np.diag(known["B"].information), [0, 0, 25])


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("id,north_m,east_m,down_m,sigma_m,sigma_m\nA,1,2,3,0.1,9\n", r"points.csv: found column sigma_m twice"),
        (f"{HEADING}A,1,2,3,0.1,9\n", r"points.csv: found rows of more cells than the heading"),
        (f"{HEADING}\x1b[31mA,1,2,3,0.1\n", r"row 2, id: found '\\x1b\[31mA', expected a whole number from 0, or a na"),
        (f"{HEADING},1,2,3,0.1\n", r"row 2, id: found '', expected"),
        (f"{HEADING}A,1,2,3,0.1\nA,1,2,3,0.1\n", r"row 3: found point A again"),
        (f"{HEADING}A,1,2,1e300,0.1\n", r"row 2: found a place or sigma that is none"),
        (f"{HEADING}A,1,2,3,1e-200\n", r"row 2: found a place or sigma that is none, expected .* of 1e-06 m or more"),
        (f"{HEADING}A,1,2,1e400,0.1\n", r"row 2, down_m: found '1e400', expected a number"),
        (f"{HEADING}A,1,,3,0.1\n", r"row 2: found north_m without east_m"),
    ],
)
def test_what_says_nothing_is_one_line(tmp_path, text, told):
    with pytest.raises(InputError, match=told) as error:
        read(tmp_path, text)
    assert str(error.value).isprintable()

import numpy as np
import pytest

from linepose.survey.point_names import in_words, nameless, point_name, point_names


@pytest.mark.parametrize(
    ("value", "name"),
    [(7, 7), (7.0, 7), ("07", 7), ("7.0", 7), ("1e6", 1_000_000), (" gate ", "gate"), ("p07", "p07"), ("1_0", "1_0")],
)
def test_a_name_is_a_whole_number_or_text(value, name):
    assert point_name(value) == name


@pytest.mark.parametrize(
    "value",
    [-1, "-3", 1.5, "1.5", "", " ", None, float("nan"), "nan", float("inf"), "9" * 30, "\x1b[2J", "a" * 81],
)
def test_what_is_no_name(value):
    assert point_name(value) is None
    assert nameless([1, value]).tolist() == [1]


def test_names_are_numbers_only_where_all_are():
    assert point_names(["7", "07", 3]).tolist() == [7, 7, 3]
    assert point_names([7, "gate", "08"]).tolist() == ["7", "gate", "8"]
    assert point_names(np.array([1.0, 2.0])).dtype == np.int64


def test_many_names_in_a_sentence():
    assert in_words(["a", 1]) == "a, 1"
    assert in_words(range(10)) == "0, 1, 2, 3, 4, 5, 6, 7 and 2 more"

"""The declaration file is closed, and says of every number what it is held to."""

import pytest

from linepose.errors import InputError
from linepose.paper.declarations import load_declarations
from linepose.paper.regression import obtained_numbers
from unit.paper.reproduced import DECLARED, PUBLISHED, everything

SMALL = """
platforms: {robot: ladybird}
tolerances: [{quantities: ["robot, *"], absolute: 1.0}]
deviations: [{reason: printed wrongly, numbers: {"robot, a": {expected: 2.0, tolerance: 0.1}}}]
"""


def load(tmp_path, text):
    (tmp_path / "regression.yaml").write_text(text)
    return load_declarations(tmp_path / "regression.yaml")


def test_a_small_file_is_read(tmp_path):
    declared = load(tmp_path, SMALL)
    assert declared.platforms == {"robot": "ladybird"}
    assert declared.tolerance_of("robot, b").absolute == 1.0
    assert declared.expected["robot, a"][1] == "printed wrongly"
    assert declared.reason("robot, ") == "printed wrongly"
    assert declared.reason("another, ") == ""


@pytest.mark.parametrize(
    ("right", "wrong", "told"),
    [
        ("absolute: 1.0", "absolut: 1.0", "absolut: found an unknown key"),
        ("absolute: 1.0", "absolute: -1.0", "tolerances.0.absolute: found -1.0"),
        ("robot: ladybird", "robot: bird", "platforms.robot: found 'bird'"),
        ("reason: printed wrongly", "reason: ''", "deviations.0.reason: found ''"),
        ("tolerance: 0.1", "tolerance: 0.0", "found 0.0, expected .*greater than 0"),
        (
            "deviations: [",
            'deviations: [{reason: too, numbers: {"robot, a": {expected: 1, tolerance: 1}}}, ',
            "robot, a",
        ),
    ],
)
def test_faults_are_told_in_one_line(tmp_path, right, wrong, told):
    with pytest.raises(InputError, match=told) as error:
        load(tmp_path, SMALL.replace(right, wrong))
    assert "\n" not in str(error.value)


def test_a_number_of_two_groups_is_told(tmp_path):
    declared = load(tmp_path, SMALL.replace("tolerances: [", 'tolerances: [{quantities: ["*, a"]}, '))
    with pytest.raises(InputError, match="found 2 groups for robot, a"):
        declared.tolerance_of("robot, a")


def test_no_declaration_is_idle():
    quantities = {number.quantity for number in obtained_numbers(PUBLISHED, everything(), DECLARED.platforms)}
    assert set(DECLARED.expected) <= quantities
    for group in DECLARED.tolerances:
        for pattern in group.quantities:
            one = group.model_copy(update={"quantities": [pattern]})
            assert any(one.holds_for(quantity) for quantity in quantities), pattern

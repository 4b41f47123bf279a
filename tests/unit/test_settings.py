import ast
import doctest
from pathlib import Path
from typing import Annotated, Literal

import pytest
from pydantic import Field, PositiveInt, model_validator

import linepose
from linepose.errors import InputError
from linepose.estimation.sampling import SamplingSettings
from linepose.settings import Settings, SettingsError, validated


class Lens(Settings):
    focal_length_m: float
    k1: float = 0.0


class ByFile(Settings):
    kind: Literal["file"]
    path: str = ""


class ByNumber(Settings):
    kind: Literal["number"]
    value: int = 0


class Pair(Settings):
    first: float = 0.0
    second: tuple[float, ...] = (1.0,)

    @model_validator(mode="after")
    def _rises(self):
        if self.first >= self.second[0]:
            raise SettingsError("second below first", "first below second", "exchange them")
        if self.first < 0:
            raise SettingsError(f"{self.first:g}", "no debts", "raise it", "first")
        if len(self.second) > 30:
            raise ValueError("few")
        return self


class Whole(Settings):
    lens: Lens
    pair: Pair = Pair()
    count: PositiveInt = 1
    corner: tuple[float, float] = (0.0, 0.0)
    names: list[str] = Field(default=["a"], min_length=1)
    source: Annotated[ByFile | ByNumber, Field(discriminator="kind")] = ByFile(kind="file")


GOOD = {"lens": {"focal_length_m": 0.008}}


def message_of(values):
    with pytest.raises(InputError) as error:
        validated(Whole, values, "s.yaml")
    return str(error.value)


def test_values_become_a_model():
    settings = validated(Whole, GOOD | {"count": 3, "corner": [1, 2.5]}, "s.yaml")
    assert settings.lens.focal_length_m == 0.008
    assert settings.corner == (1.0, 2.5)


def test_number_that_yaml_takes_for_text_is_a_number():
    assert validated(Whole, {"lens": {"focal_length_m": "1e-4"}}, "s.yaml").lens.focal_length_m == 1e-4


def test_models_do_not_change():
    with pytest.raises(ValueError, match="frozen"):
        validated(Whole, GOOD, "s.yaml").count = 2


@pytest.mark.parametrize(
    ("values", "message"),
    [
        (
            GOOD | {"cuont": 3},
            "s.yaml: cuont: found an unknown key, expected one of lens, pair, count, corner, names, source; "
            "did you mean count?",
        ),
        (
            GOOD | {"zebra": 3},
            "s.yaml: zebra: found an unknown key, expected one of lens, pair, count, corner, names, source; remove it",
        ),
        (
            {"lens": {"focal_length_m": 0.008, "k_1": 0.1}},
            "s.yaml: lens.k_1: found an unknown key, expected one of focal_length_m, k1; did you mean k1?",
        ),
        (  # a misspelt key that must be there: the misspelling is told of, not the absence
            {"lens": {"focal_lenght_m": 0.008}},
            "s.yaml: lens.focal_lenght_m: found an unknown key, expected one of focal_length_m, k1; "
            "did you mean focal_length_m?",
        ),
        ({"lens": {}}, "s.yaml: lens.focal_length_m: found nothing, expected a value; add it"),
        ({}, "s.yaml: lens: found nothing, expected a value; add it"),
        (GOOD | {"corner": [1.0]}, "s.yaml: corner.1: found nothing, expected a value; add it"),
        (
            {"lens": {"focal_length_m": float("nan")}},
            "s.yaml: lens.focal_length_m: found nan, expected a finite number; correct the value",
        ),
        (
            {"lens": {"focal_length_m": float("inf")}},
            "s.yaml: lens.focal_length_m: found inf, expected a finite number; correct the value",
        ),
        (
            {"lens": {"focal_length_m": "8 mm"}},
            "s.yaml: lens.focal_length_m: found '8 mm', expected a valid number, "
            "unable to parse string as a number; correct the value",
        ),
        (
            {"lens": {"focal_length_m": None}},
            "s.yaml: lens.focal_length_m: found None, expected a valid number; correct the value",
        ),
        (GOOD | {"count": 0}, "s.yaml: count: found 0, expected greater than 0; correct the value"),
        (
            GOOD | {"names": []},
            "s.yaml: names: found [], expected list should have at least 1 item after validation, not 0; "
            "correct the value",
        ),
        (
            {"lens": 0.008},
            "s.yaml: lens: found 0.008, expected keys and values; write `key: value` lines below it",
        ),
        ([], "s.yaml: top level: found [], expected keys and values; write `key: value` lines below it"),
    ],
)
def test_fault_is_told_in_one_line(values, message):
    assert message_of(values) == message


@pytest.mark.parametrize(
    ("pair", "message"),
    [
        ({"first": 2.0}, "s.yaml: pair: found second below first, expected first below second; exchange them"),
        ({"first": -2.0}, "s.yaml: pair.first: found -2, expected no debts; raise it"),
        ({"second": [1.5] * 40}, "s.yaml: pair: found the keys second, expected few; correct the value"),
        ({"first": [1.5] * 40}, "s.yaml: pair.first: found 40 values, expected a valid number; correct the value"),
    ],
)
def test_fault_of_a_section_does_not_tell_all_that_stands_in_it(pair, message):
    assert message_of(GOOD | {"pair": pair}) == message


def test_every_check_of_a_whole_section_tells_what_it_found_and_what_to_do():
    unclear = []
    for path in sorted(Path(linepose.__file__).parent.rglob("*.py")):
        for function in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(function, ast.FunctionDef) and "model_validator" in map(name_of, function.decorator_list):
                raised = {name_of(one.exc) for one in ast.walk(function) if isinstance(one, ast.Raise)}
                unclear += [f"{path.name}: {function.name}"] if "ValueError" in raised else []
    assert unclear == []


def name_of(node):
    """The name of what a call or a decorator calls."""
    return ast.unparse(node.func if isinstance(node, ast.Call) else node)


def test_unknown_key_of_one_kind_among_several_is_refused():
    message = message_of(GOOD | {"source": {"kind": "file", "pth": "x"}})
    assert "pth: found an unknown key" in message
    assert "\n" not in message


def test_wrong_values_in_python_are_told_in_one_line():
    with pytest.raises(InputError) as error:
        Lens(focal_length_m=0.008, k11=1.0)
    assert str(error.value) == ("Lens: k11: found an unknown key, expected one of focal_length_m, k1; did you mean k1?")
    with pytest.raises(InputError, match=r"Whole: lens\.focal_length_m: found 'x', expected a valid number"):
        Whole(lens={"focal_length_m": "x"})


def test_replaced_values_are_checked():
    lens = Lens(focal_length_m=0.008)
    assert lens.replaced(k1=0.5) == Lens(focal_length_m=0.008, k1=0.5)
    with pytest.raises(InputError, match="Lens: k1: found 'x', expected a valid number"):
        lens.replaced(k1="x")


PUBLIC = [name for name in linepose.__all__ if isinstance(getattr(linepose, name), type)]
SETTINGS = [name for name in PUBLIC if issubclass(getattr(linepose, name), Settings)]


@pytest.mark.parametrize("name", SETTINGS)
def test_keys_are_told_in_the_docstring_with_their_defaults(name):
    model = getattr(linepose, name)
    for key, field in model.model_fields.items():
        assert f"\n{key} : " in model.__doc__
        assert field.description
        assert f"    {field.description}\n" in model.__doc__
    assert "Parameters" not in model.model_json_schema()["description"]


@pytest.mark.parametrize("name", [*SETTINGS, "InputError", "EstimationError", "LineposeError"])
def test_example_of_the_docstring_runs(name):
    (example,) = doctest.DocTestFinder(recurse=False).find(getattr(linepose, name), name, globs={})
    told = []
    doctest.DocTestRunner(verbose=False).run(example, out=told.append)
    assert example.examples
    assert told == []


@pytest.mark.parametrize("value", [True, "1_00", "٣"])
def test_what_is_no_number_to_people_is_none(value):
    with pytest.raises(InputError, match="n_walkers"):
        SamplingSettings(n_walkers=value)


@pytest.mark.parametrize("keys", [{"n_walkers": 10**9}, {"n_steps": 10**12}, {"n_walkers": 10_000, "n_steps": 10_000}])
def test_counts_that_no_memory_holds_are_refused(keys):
    with pytest.raises(InputError):
        SamplingSettings(**keys)

"""YAML that PyYAML takes for something else than was meant, or fails on outside its own errors."""

from pathlib import Path

import pytest
import yaml

from linepose.config import yaml_file
from linepose.config.yaml_file import _parser_of, parsed_yaml
from linepose.errors import InputError

ROOT = Path(__file__).parents[3]

BOMB = "a0: &a0 [x, x, x, x, x, x, x, x]\n" + "".join(
    f"a{one}: &a{one} [{', '.join([f'*a{one - 1}'] * 8)}]\n" for one in range(1, 12)
)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("date: 2024-02-30", "a value that is none"),
        ("a: !!int abc", "a value that is none"),
        (f"a: {'9' * 5000}", "a value that is none"),
        ("[" * 5000, "in lists"),
        ("a: &a [*a]", "in lists"),
        (BOMB, "in lists"),
        ("a: 1\nb: 2\na: 3", "line 3: found the key 'a' again"),
        ("a: {b: 1, b: 2}", "the key 'b' again"),
        ("a: 1_00", "found 1_00"),
        ("a: 1:30", "found 1:30"),
        ("a: [", "expected YAML"),
        ("a: \x00", "expected YAML"),
        ("a: 1\nb: [1, 2\nc: 3\n", "a.yaml, line 2: found a bracket [ that is not closed"),
        ("a: 1\nb: {c: 1\nd: 3\n", "a.yaml, line 2: found a bracket { that is not closed"),
        ("a: b: c", "line 1: found a second colon"),
        ("a: 1\n  b: 2\n", "line 2: found a second colon, or a line indented too far"),
        ("a:\n  b: 1\n c: 2\n", "line 3: found a line indented unlike"),
        ("a:\n\tb: 1\n", "line 2: found a tab"),
        ("a: 1\nb: 'c\nd: 1\n", "line 2: found a quotation mark that is not closed"),
        ("a: 1\nwords\nb: 2\n", "line 2: found a line without a colon"),
        ("a: *b", "line 1: found an alias"),
        ("a: @b", "line 1: found "),
    ],
)
def test_is_one_line(text, told):
    with pytest.raises(InputError) as caught:
        parsed_yaml(text, "a.yaml")
    assert told in str(caught.value)
    assert str(caught.value).startswith("a.yaml")
    assert "^" not in str(caught.value)
    assert str(caught.value).isprintable()


@pytest.mark.parametrize("text", ["[" * 60, "[" * 200_000, "{a: " * 200_000, "- " * 200_000])
def test_text_that_is_too_deep_never_reaches_the_parser_without_bounds(text):
    with pytest.raises(InputError, match=r"a\.yaml, line 1: found lists in lists"):
        _parser_of(text, "a.yaml")


def test_both_parsers_read_the_same(monkeypatch):
    texts = [path.read_bytes() for path in sorted((ROOT / "config").rglob("*.yaml"))]
    assert all(_parser_of(text, "a.yaml") is yaml.CSafeLoader for text in texts)
    fast = [parsed_yaml(text, "a.yaml") for text in texts]
    monkeypatch.setattr(yaml_file, "_FAST", yaml.SafeLoader)
    assert [parsed_yaml(text, "a.yaml") for text in texts] == fast


def test_plain_values_are_as_before():
    assert parsed_yaml("a: &x [1, -2.5e-3, text, 2024-05-01T10:00:00Z]\nb: *x\nc: yes", "a.yaml")["b"][:3] == [
        1,
        -2.5e-3,
        "text",
    ]

"""YAML files of a project: one mapping, every key once, numbers written as numbers."""

import re
from pathlib import Path
from typing import Any, Final

import yaml

from linepose.config.yaml_fault import yaml_fault
from linepose.errors import InputError

_MOST_BYTES: Final = 1_000_000
_DEEPEST: Final = 50
_MOST_NODES: Final = 500_000  # of what aliases unfold to
_WITH_SIGNS: Final = re.compile(r"[-+]?[0-9][0-9_:.eE+-]*[_:][0-9_:.eE+-]*")  # YAML 1.1: 1_00 is 100, 1:30 is 90
_FAST: Final[Any] = getattr(yaml, "CSafeLoader", yaml.SafeLoader)  # ten times as fast; libyaml is not everywhere
_NUMBERS: Final = {"tag:yaml.org,2002:int", "tag:yaml.org,2002:float"}


def read_yaml(path: Path) -> dict[str, Any]:
    """A YAML file's mapping; raises InputError for a file that is missing, broken, or holds something else."""
    if not path.is_file():
        near = sorted(p.stem for p in path.parent.glob("*.yaml"))
        raise InputError(
            str(path), "no such file", f"one of {', '.join(near) or 'none'}", "create it or correct the name"
        )
    if path.stat().st_size > _MOST_BYTES:
        raise InputError(str(path), f"{path.stat().st_size} bytes", f"at most {_MOST_BYTES}", "restore the file")
    values = parsed_yaml(path.read_bytes(), str(path))
    if not isinstance(values, dict):
        raise InputError(str(path), type(values).__name__, "keys and values", "write `key: value` lines")
    return values


def parsed_yaml(text: bytes | str, place: str) -> Any:
    """What a YAML text holds; raises InputError naming the line of what is broken, doubled or no plain value."""
    loader = None
    try:
        loader = _parser_of(text, place)(text)
        root = loader.get_single_node()
        if root is None:
            return None
        _check_node(root, place, 0, [0])
        return loader.construct_document(root)
    except yaml.YAMLError as error:
        raise yaml_fault(error, place) from None
    except RecursionError:
        raise InputError(place, "lists in lists without end", "YAML", "correct the file") from None
    except (ValueError, OverflowError, TypeError, AttributeError) as error:
        found = f"a value that is none ({' '.join(str(error).split())})"
        raise InputError(place, found, "numbers, words and dates that there are", "correct the value") from None
    finally:
        if loader is not None:
            loader.dispose()


def _parser_of(text: bytes | str, place: str) -> Any:
    """The fast parser for a text that it reads; the other one tells what is wrong with a text, and where.

    Raises InputError for lists deeper than may be, to which the fast parser's composing has no bound.
    """
    depth = 0
    if _FAST is yaml.SafeLoader:
        return _FAST
    try:
        for event in yaml.parse(text, Loader=_FAST):
            depth += isinstance(event, yaml.CollectionStartEvent) - isinstance(event, yaml.CollectionEndEvent)
            if depth > _DEEPEST + 1:
                line = event.start_mark.line + 1 if event.start_mark else 1
                raise _without_bounds(f"{place}, line {line}")
    except (yaml.YAMLError, ValueError, TypeError, AttributeError):
        return yaml.SafeLoader
    return _FAST


def _without_bounds(where: str) -> InputError:
    found = "lists in lists, or aliases of aliases, without bounds"
    return InputError(where, found, "plain YAML", "write it out")


def _check_node(node: yaml.Node, place: str, depth: int, counted: list[int]) -> None:
    """Raise InputError for a key that stands twice, a number with signs in it, and what unfolds without bounds."""
    counted[0] += 1
    where = f"{place}, line {node.start_mark.line + 1}"
    if depth > _DEEPEST or counted[0] > _MOST_NODES:
        raise _without_bounds(where)
    if isinstance(node, yaml.MappingNode):
        keys: set[tuple[str, str]] = set()
        for key, value in node.value:
            name = str(key.value)
            if isinstance(key, yaml.ScalarNode) and (key.tag, name) in keys:
                line = key.start_mark.line + 1
                raise InputError(f"{place}, line {line}", f"the key {name!r} again", "each key once", "remove one")
            keys.add((key.tag, name))
            _check_node(key, place, depth + 1, counted)
            _check_node(value, place, depth + 1, counted)
    elif isinstance(node, yaml.SequenceNode):
        for one in node.value:
            _check_node(one, place, depth + 1, counted)
    elif node.tag in _NUMBERS and _WITH_SIGNS.fullmatch(node.value):
        raise InputError(where, node.value, "a number of digits, point and exponent", "write it without _ and :")

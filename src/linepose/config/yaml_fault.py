"""What is wrong with a YAML text in plain words, from what its parser says."""

from typing import Final, NamedTuple

import yaml

from linepose.errors import InputError


class _Fault(NamedTuple):
    """Words of the parser, and what stands for them; whether the fault is where the parser began to read."""

    said: str
    found: str
    remedy: str
    at_begin: bool = False


_FAULTS: Final = (
    _Fault("mapping values are not allowed", "a second colon, or a line indented too far", "quote text with a colon"),
    _Fault("'\\t' that cannot start", "a tab", "indent with spaces"),
    _Fault("or ']'", "a bracket [ that is not closed", "close it", at_begin=True),
    _Fault("or '}'", "a bracket { that is not closed", "close it", at_begin=True),
    _Fault("flow node", "a bracket that is not closed, or a value that is missing", "close it", at_begin=True),
    _Fault("unexpected end of stream", "a quotation mark that is not closed", "close it", at_begin=True),
    _Fault("could not find expected ':'", "a line without a colon", "write `key: value`", at_begin=True),
    _Fault("expected <block end>", "a line indented unlike those above it", "indent it as its neighbours are"),
    _Fault("undefined alias", "an alias * of nothing", "quote text that begins with *"),
)


def yaml_fault(error: yaml.YAMLError, place: str) -> InputError:
    """The error to tell: file and line, what is wrong, and what to do."""
    if not isinstance(error, yaml.MarkedYAMLError) or error.problem_mark is None:
        return InputError(place, " ".join(str(error).split()), "YAML", "correct the file")
    said = str(error.problem)
    known = next((one for one in _FAULTS if one.said in said), _Fault(said, said, "correct the line"))
    mark = error.context_mark if known.at_begin and error.context_mark is not None else error.problem_mark
    return InputError(f"{place}, line {mark.line + 1}", known.found, "YAML", known.remedy)

"""Settings: closed, frozen classes that the library and the configuration share, and their faults told in one line.

A class of settings stands in the module whose function takes it; the configuration is composed of these classes, so
that each default stands once.
"""

import difflib
import inspect
import re
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Final, Self, TypeVar, get_args

from pydantic import BaseModel, ConfigDict, GetJsonSchemaHandler, ValidationError, model_validator
from pydantic.fields import FieldInfo
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema, ErrorDetails

from linepose.errors import InputError, quoted

if TYPE_CHECKING:
    from pydantic._internal._model_construction import ModelMetaclass
else:
    ModelMetaclass = type(BaseModel)


class SettingsError(ValueError):
    """What a validator of a whole section finds: told at it, or at one of its keys, without what else is there.

    Parameters
    ----------
    found, expected : str
        What stands in the section that does not go together, and what would.
    remedy : str
        What to do, as an imperative.
    key : str
        Where in the section, dots between keys; the section itself if empty.
    """

    def __init__(self, found: str, expected: str, remedy: str, key: str = "") -> None:
        self.found, self.expected, self.remedy, self.key = found, expected, remedy, key
        super().__init__(f"found {found}, expected {expected}; {remedy}")


class _FaultsInOneLine(ModelMetaclass):
    """Lets wrong values in a constructor's call raise an InputError; pydantic itself builds nested ones otherwise."""

    if not TYPE_CHECKING:

        def __call__(self, *args: Any, **values: Any) -> Any:
            try:
                return super().__call__(*args, **values)
            except ValidationError as error:
                raise _first_fault(self, error, self.__name__) from None


class Settings(BaseModel, metaclass=_FaultsInOneLine):
    """A group of settings: an unknown key is an error, and so is a value that is not finite or out of its range.

    Raises InputError where it is made with wrong values.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    @model_validator(mode="before")
    @classmethod
    def _numbers_are_numbers(cls, values: Any) -> Any:
        """Yes and no are no numbers, nor are digits with signs: pydantic takes `yes` for 1.0 and "1_00" for 100."""
        if not isinstance(values, Mapping):
            return values
        numeric = {name for name, field in cls.model_fields.items() if _is_numeric(field)}
        return {name: _without_others(value) if name in numeric else value for name, value in values.items()}

    @classmethod
    def __pydantic_init_subclass__(cls, **_: Any) -> None:
        """Tell the keys in the docstring, as numpydoc has it, in the words of the configuration's reference."""
        about, examples, code = inspect.cleandoc(cls.__doc__ or "").partition("Examples\n--------")
        keys = [
            f"{name} : {_kind_of(field)}\n    {field.description or ''}" for name, field in cls.model_fields.items()
        ]
        cls.__doc__ = "\n".join([about.rstrip(), "", "Parameters", "----------", *keys, "", examples + code])

    @classmethod
    def __get_pydantic_json_schema__(cls, core_schema: CoreSchema, handler: GetJsonSchemaHandler) -> JsonSchemaValue:
        schema = handler(core_schema)
        own = handler.resolve_ref_schema(schema)
        about = own.pop("description", "").partition("Parameters\n----------")[0].rstrip()
        own |= {"description": about} if about else {}
        return schema

    def replaced(self, **changes: Any) -> Self:
        """These settings with other values of some keys, checked like those given first; raises InputError."""
        return type(self)(**{name: getattr(self, name) for name in type(self).model_fields} | changes)


def _scalars(annotation: Any) -> set[Any]:
    """The plain types that an annotation is made of."""
    inner = [one for one in get_args(annotation) if one is not Ellipsis]
    return set().union(*(_scalars(one) for one in inner)) if inner else {annotation}


def _is_numeric(field: FieldInfo) -> bool:
    """Whether a key takes numbers, and nothing that yes, no or text may stand for."""
    kinds = _scalars(field.annotation)
    return bool(kinds & {int, float}) and not kinds & {bool, str, Any, object}


class _NoNumber:
    """What stands where a number is expected, as no type that pydantic makes a number of."""

    def __init__(self, value: bool | str) -> None:
        self.value = value

    def __repr__(self) -> str:
        return repr(self.value)


def _without_others(value: Any) -> Any:
    """A value with what is no number marked as such, also within lists; `1e-4`, to YAML a text, is one."""
    if isinstance(value, list | tuple):
        return [_without_others(one) for one in value]
    if isinstance(value, bool) or (isinstance(value, str) and ("_" in value or not value.isascii())):
        return _NoNumber(value)
    return value


def _kind_of(field: FieldInfo) -> str:
    """A key's type and default for people: `float, default 2.0`."""
    annotation = field.annotation
    name = annotation.__name__ if isinstance(annotation, type) and not get_args(annotation) else str(annotation)
    name = re.sub(r"\b(?:[a-z_]+\.)+", "", name)
    if field.is_required():
        return name
    default = field.get_default(call_default_factory=True, validated_data={})
    return f"{name}, default {type(default).__name__ + '()' if isinstance(default, BaseModel) else repr(default)}"


_MOST_SHOWN: Final = 12  # values of a list

Model = TypeVar("Model", bound=Settings)


def validated(model: type[Model], values: Any, place: str) -> Model:
    """The values as a model; raises InputError naming the place, the key and what was expected there."""
    try:
        return model.model_validate(values)
    except ValidationError as error:
        raise _first_fault(model, error, place) from None
    except InputError as error:  # of a section that another part of the library checks
        raise InputError(f"{place}: {error.place}", error.found, error.expected, error.remedy) from None


def faults_of(model: type[Settings], values: Any, place: str) -> list[InputError]:
    """Every fault of the values as a model, misspelt keys first; none where they are right."""
    try:
        model.model_validate(values)
    except ValidationError as error:
        faults = sorted(error.errors(), key=lambda fault: fault["type"] != "extra_forbidden")
        return [_one_line(model, fault, place) for fault in faults]
    except InputError as error:
        return [InputError(f"{place}: {error.place}", error.found, error.expected, error.remedy)]
    return []


def _first_fault(model: type[Settings], error: ValidationError, place: str) -> InputError:
    faults = error.errors()
    unknown = next((fault for fault in faults if fault["type"] == "extra_forbidden"), None)
    return _one_line(model, unknown or faults[0], place)  # a misspelt key explains why one is missing


def _one_line(model: type[Settings], fault: ErrorDetails, place: str) -> InputError:
    location = [str(part) for part in fault["loc"]]
    named = fault["type"] in {"extra_forbidden", "missing"}  # the last part is then a key that is not to be looked up
    keys, known = _walk(model, location[:-1] if named else location)
    where = f"{place}: {'.'.join([*keys, *location[-1:]] if named else keys) or 'top level'}"
    if fault["type"] == "extra_forbidden":
        near = difflib.get_close_matches(location[-1], known, n=1)
        remedy = f"did you mean {near[0]}?" if near else "remove it"
        return InputError(where, "an unknown key", f"one of {', '.join(known)}" if known else "no such key", remedy)
    if fault["type"] == "missing":
        return InputError(where, "nothing", "a value", "add it")
    if fault["type"] == "model_type":
        return InputError(where, _shown(fault["input"]), "keys and values", "write `key: value` lines below it")
    told = fault.get("ctx", {}).get("error")
    if isinstance(told, SettingsError):
        where = f"{place}: {'.'.join([*keys, told.key] if told.key else keys) or 'top level'}"
        return InputError(where, told.found, told.expected, told.remedy)
    return InputError(where, _shown(fault["input"]), _expected(fault["msg"]), "correct the value")


def _shown(value: Any) -> str:
    """A value as a message shows it: of a section its keys, of a long list how many it has."""
    if isinstance(value, Mapping):
        return f"the keys {', '.join(map(str, value))}" if value else "no keys"
    if isinstance(value, list | tuple) and len(value) > _MOST_SHOWN:
        return f"{len(value)} values"
    return quoted(value)


def _expected(message: str) -> str:
    """Pydantic's message, without what it opens with: "Input should be a valid number" is "a valid number"."""
    for opening in ("Input should be ", "Value error, "):
        message = message.removeprefix(opening)
    return message[:1].lower() + message[1:]


def _walk(model: type[Settings], location: list[str]) -> tuple[list[str], list[str]]:
    """The keys of a location, and those of the section there, as far as the schema tells.

    A location also names the kind (`scans`, `sbet`) by which pydantic chose among sections; nobody wrote it as a key.
    """
    definitions = model.model_json_schema(by_alias=True)
    options, keys = _options(definitions, definitions), []
    for part in location:
        kinds = [option for option in options if _is_kind(option, part)]
        if kinds and len(options) > 1:
            options = kinds
            continue
        keys.append(part)
        below = [option["properties"][part] for option in options if part in option.get("properties", {})]
        options = [one for node in below for one in _options(node, definitions)]
    return keys, list(dict.fromkeys(key for option in options for key in option.get("properties", {})))


def _is_kind(option: dict[str, Any], name: str) -> bool:
    return any(node.get("const") == name for node in option.get("properties", {}).values())


def _options(node: dict[str, Any], definitions: dict[str, Any]) -> list[dict[str, Any]]:
    """The schemas that a node stands for, references followed and alternatives side by side."""
    reference = node.get("$ref")
    node = definitions["$defs"][reference.rsplit("/", 1)[-1]] if reference else node
    several = node.get("anyOf", node.get("oneOf"))
    return [node] if several is None else [one for option in several for one in _options(option, definitions)]

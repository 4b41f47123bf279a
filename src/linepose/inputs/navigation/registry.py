"""The navigation formats by name: entry points of the group `linepose.navigation_formats`, ours and others' alike.

Ours stand in pyproject.toml; how another package brings one: docs/formats.md.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Final

from pydantic import BeforeValidator, Discriminator, GetJsonSchemaHandler, SerializeAsAny, Tag

from linepose.errors import InputError
from linepose.inputs.navigation.format import NavigationFormat, NavigationFormatSection
from linepose.inputs.patterns import Files
from linepose.plugins import PluginGroup
from linepose.settings import validated

FORMATS: Final = PluginGroup("linepose.navigation_formats", NavigationFormat, "source.navigation.format")


def recognised(path: Path, chosen: str | None = None) -> tuple[str | None, dict[str, Any]]:
    """Name of the format that a log is of, and the keys that it needs beside `format` and `file`.

    The name is `chosen` where one is given, and None where the log is of no format that is known.
    """
    for name in FORMATS.names() if chosen is None else [chosen]:
        keys = FORMATS.member(name).recognise(path)
        if keys is not None:
            return name, keys
    return chosen, {}


class SectionsOfFormats:
    """Says of a key that its section depends on the format: for JSON schemas and the reference, which show ours."""

    def sections(self) -> list[type[NavigationFormatSection]]:
        """The sections of our own formats."""
        return [one.section for one in FORMATS.own()]

    def __get_pydantic_json_schema__(self, _: Any, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        names = [one.name for one in FORMATS.own()]
        other = {
            "type": "object",
            "properties": {"format": {"type": "string", "not": {"enum": names}}},
            "required": ["format"],
        }
        return {"anyOf": [*(handler(section.__pydantic_core_schema__) for section in self.sections()), other]}


def _section(value: Any) -> NavigationFormatSection:
    if isinstance(value, NavigationFormatSection):
        return value
    if not isinstance(value.get("format"), str):
        expected = f"one of {', '.join(FORMATS.names())}"
        raise InputError("source.navigation.format", repr(value.get("format")), expected, "add or correct it")
    try:
        return validated(FORMATS.member(value["format"]).section, value, "source.navigation")
    except InputError as error:
        place = error.place.replace("source.navigation: top level", "source.navigation")
        place = place.replace("source.navigation: ", "source.navigation.")
        raise InputError(place, error.found, error.expected, error.remedy) from None


def _kind(value: Any) -> str:
    return "format" if isinstance(value, Mapping | NavigationFormatSection) else "path"


# closed: an unknown key of any format is an error, also of one that another package brings
Navigation = Annotated[
    Annotated[Files, Tag("path")]
    | Annotated[SerializeAsAny[NavigationFormatSection], BeforeValidator(_section), SectionsOfFormats(), Tag("format")],
    Discriminator(_kind),
]

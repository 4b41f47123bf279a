"""The navigation formats by name: entry points of the group `linepose.navigation_formats`, ours and others' alike.

Ours stand in pyproject.toml; how another package brings one: docs/formats.md.
"""

import difflib
from collections.abc import Mapping
from functools import cache
from importlib.metadata import EntryPoint, entry_points
from typing import Annotated, Any, Final

from pydantic import BeforeValidator, Discriminator, GetJsonSchemaHandler, SerializeAsAny, Tag

from linepose.errors import InputError
from linepose.inputs.navigation.format import NavigationFormat, NavigationFormatSection
from linepose.settings import validated

GROUP: Final = "linepose.navigation_formats"


def format_names() -> list[str]:
    """The names of all formats, sorted."""
    return sorted(point.name for point in entry_points(group=GROUP))


def navigation_format(name: str) -> NavigationFormat:
    """The format of this name; raises InputError naming the nearest one where there is none."""
    points = {point.name: point for point in entry_points(group=GROUP)}
    if name not in points:
        near = difflib.get_close_matches(name, points, n=1)
        remedy = f"did you mean {near[0]}?" if near else "correct it, or install the package that brings the format"
        raise InputError("source.navigation.format", repr(name), f"one of {', '.join(sorted(points))}", remedy)
    return _loaded(points[name])


def own_formats() -> list[NavigationFormat]:
    """The formats that linepose itself brings, sorted by name."""
    own = [point for point in entry_points(group=GROUP) if point.dist is not None and point.dist.name == "linepose"]
    return [_loaded(point) for point in sorted(own, key=lambda point: point.name)]


@cache
def _loaded(point: EntryPoint) -> NavigationFormat:
    found = point.load()
    if not isinstance(found, NavigationFormat) or found.name != point.name:
        place, expected = f"entry point {point.name} of {GROUP}", f"a NavigationFormat named {point.name}"
        raise InputError(place, repr(found)[:60], expected, "correct the package that brings it")
    return found


class SectionsOfFormats:
    """Says of a key that its section depends on the format: for JSON schemas and the reference, which show ours."""

    def sections(self) -> list[type[NavigationFormatSection]]:
        """The sections of our own formats."""
        return [one.section for one in own_formats()]

    def __get_pydantic_json_schema__(self, _: Any, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        names = [one.name for one in own_formats()]
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
        expected = f"one of {', '.join(format_names())}"
        raise InputError("source.navigation.format", repr(value.get("format")), expected, "add or correct it")
    try:
        return validated(navigation_format(value["format"]).section, value, "source.navigation")
    except InputError as error:
        place = error.place.replace("source.navigation: top level", "source.navigation")
        place = place.replace("source.navigation: ", "source.navigation.")
        raise InputError(place, error.found, error.expected, error.remedy) from None


def _kind(value: Any) -> str:
    return "format" if isinstance(value, Mapping | NavigationFormatSection) else "path"


# closed: an unknown key of any format is an error, also of one that another package brings
Navigation = Annotated[
    Annotated[str, Tag("path")]
    | Annotated[SerializeAsAny[NavigationFormatSection], BeforeValidator(_section), SectionsOfFormats(), Tag("format")],
    Discriminator(_kind),
]

"""What this package and others bring under a name: entry points of a group, ours in pyproject.toml."""

import difflib
from dataclasses import dataclass
from functools import cache
from importlib.metadata import EntryPoint, entry_points
from typing import Final, Generic, Protocol, TypeVar

from linepose.errors import InputError

_PACKAGE: Final = __name__.partition(".")[0]


class Named(Protocol):
    """What an entry point must lead to: something that knows its own name."""

    @property
    def name(self) -> str:
        """The name of its entry point."""


Member = TypeVar("Member", bound=Named)


@dataclass(frozen=True)
class PluginGroup(Generic[Member]):
    """The members of a group of entry points, each loaded when it is asked for.

    `kind` is the class of the members, `place` is where a user writes a member's name.
    """

    group: str
    kind: type[Member]
    place: str

    def names(self) -> list[str]:
        """The names of all members, sorted."""
        return sorted(self._points())

    def own(self) -> list[Member]:
        """The members that linepose itself brings, sorted by name."""
        points = sorted(self._points().items())
        return [self._loaded(point) for _, point in points if point.dist and point.dist.name == _PACKAGE]

    def member(self, name: str) -> Member:
        """The member of this name; raises InputError naming the nearest one where there is none."""
        points = self._points()
        if name not in points:
            near = difflib.get_close_matches(name, points, n=1)
            remedy = f"did you mean {near[0]}?" if near else "correct it, or install the package that brings it"
            raise InputError(self.place, repr(name), f"one of {', '.join(sorted(points))}", remedy)
        return self._loaded(points[name])

    def _points(self) -> dict[str, EntryPoint]:
        points = {point.name: point for point in entry_points(group=self.group)}
        if not points:  # a package installed before it had the group
            remedy = "install linepose again: pip install --no-deps --editable ."
            raise InputError(f"entry points {self.group}", "none", "those of linepose", remedy)
        return points

    def _loaded(self, point: EntryPoint) -> Member:
        found, kind = _load(point), self.kind
        if not isinstance(found, kind) or found.name != point.name:
            place, expected = f"entry point {point.name} of {self.group}", f"{_with_article(kind)} named {point.name}"
            raise InputError(place, repr(found)[:60], expected, "correct the package that brings it")
        return found


@cache
def _load(point: EntryPoint) -> object:
    found: object = point.load()
    return found


def _with_article(kind: type) -> str:
    return f"{'an' if kind.__name__[0] in 'AEIOU' else 'a'} {kind.__name__}"

"""A key of an experiment in a platform's file."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Generic, TypeVar

from pydantic import Field, create_model

from linepose.config.platform import Platform
from linepose.settings import Settings, validated

Value = TypeVar("Value", covariant=True)


def settings_class(name: str, fields: Mapping[str, Any]) -> type[Settings]:
    """A closed class of settings with these fields, each a type and a pydantic field."""
    model: type[Settings] = create_model(name, __base__=Settings, **fields)
    return model


@dataclass(frozen=True)
class Section(Generic[Value]):
    """A key below `experiments` in a platform's file: its value's type, the default, and what it means."""

    key: str
    value: type[Value]
    default: Value | None
    description: str

    @property
    def field(self) -> tuple[Any, Any]:
        """The key as a field of a pydantic model; null leaves the experiment out."""
        return self.value | None, Field(self.default, description=self.description)

    @cached_property
    def _model(self) -> type[Settings]:
        return settings_class(self.key, {self.key: self.field})

    def of(self, platform: Platform) -> Value | None:
        """What a platform's file says, the default where it says nothing; None where the experiment is left out.

        Raises InputError for what no such section has.
        """
        return self.read({key: value for key, value in platform.experiments.items() if key == self.key})

    def values(self, platform: Platform) -> Any:
        """The same as plain values, defaults included."""
        known = {key: value for key, value in platform.experiments.items() if key == self.key}
        return validated(self._model, known, "experiments").model_dump(mode="json")[self.key]

    def read(self, values: Mapping[str, Any]) -> Value | None:
        """The same from the mapping of this key alone."""
        value: Value | None = getattr(validated(self._model, dict(values), "experiments"), self.key)
        return value

"""Values and comments of a settings file that a person reads on."""

from collections.abc import Mapping, Sequence
from typing import Any

import yaml


def descriptions(section: type) -> Mapping[str, str]:
    """What each key of a section means, as a comment's words."""
    fields = section.model_fields  # type: ignore[attr-defined]
    return {name: (field.description or "").rstrip(".") for name, field in fields.items()}


def number(value: float) -> str:
    """A number that every YAML reader takes for one: with a point also before an exponent."""
    text = repr(float(value))
    mantissa, exponent, power = text.partition("e")
    return text if "." in mantissa else f"{mantissa}.0{exponent}{power}"


def numbers(values: Sequence[float]) -> str:
    """A list of numbers on one row."""
    return f"[{', '.join(number(value) for value in values)}]"


def quoted(value: Any) -> str:
    """A value as YAML on one row; a text in quotes where it needs them."""
    text: str = yaml.safe_dump(value, default_flow_style=True, width=10_000, sort_keys=False)
    return text.removesuffix("\n").removesuffix("...").rstrip("\n")

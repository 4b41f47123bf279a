"""The configuration explained: a page for people, made from the models.

`python -m linepose.output.reference` writes docs/configuration.md.
"""

import json
from pathlib import Path
from typing import Any

from pydantic import BaseModel, Field, create_model
from pydantic.fields import FieldInfo
from pydantic_core import PydanticUndefined

from linepose.config.platform import Platform
from linepose.config.study import DatasetSection, Study
from linepose.experiments.registry import ExperimentsSettings
from linepose.inputs.navigation.registry import SectionsOfFormats
from linepose.settings import Settings

# as linepose.config.platform has it, with what linepose.experiments.registry says of its `experiments`
_Platform = create_model(
    "Platform",
    __base__=Platform,
    __doc__=Platform.__doc__,
    experiments=(
        ExperimentsSettings,
        Field(ExperimentsSettings(), description=Platform.model_fields["experiments"].description),
    ),
)

_PARTS: dict[str, type[Settings]] = {
    "config/config.yaml": Study,
    "config/platforms/NAME.yaml": _Platform,
    "config/datasets/NAME.yaml": DatasetSection,
}
_INTRODUCTION = """# Configuration

Science stands in `config/`, machines in `profiles/`. An unknown key is an error, which names the nearest known one.
A platform file may say `like: OTHER`: what it leaves out is then taken from `config/platforms/OTHER.yaml`.

This page is made from the code by `make reference`.
"""


def reference_page() -> str:
    """Every key of every configuration file in Markdown tables: key, default, meaning with its unit."""
    parts = [_INTRODUCTION]
    for title, model in _PARTS.items():
        rows = "\n".join(f"| `{key}` | {default} | {meaning} |" for key, default, meaning in _rows(model, ""))
        parts.append(f"## {title}\n\n| key | default | meaning |\n| --- | --- | --- |\n{rows}\n")
    return "\n".join(parts)


def _rows(model: type[BaseModel], prefix: str) -> list[tuple[str, str, str]]:
    rows = []
    for name, field in model.model_fields.items():
        sections = _sections(field.annotation)
        rows.append((f"{prefix}{name}", _default(field), (field.description or "").replace("|", "\\|")))
        for section in sections:
            rows += _rows(section, f"{prefix}{name}.")
    return rows


def _default(field: FieldInfo) -> str:
    default: Any = field.get_default(call_default_factory=True, validated_data={})
    if default is PydanticUndefined:
        return "required"
    return "see below" if isinstance(default, BaseModel) else f"`{json.dumps(default, default=str)}`"


def _sections(annotation: Any) -> list[type[BaseModel]]:
    for marker in getattr(annotation, "__metadata__", ()):
        if isinstance(marker, SectionsOfFormats):
            return list(marker.sections())
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return [annotation]
    return [section for part in getattr(annotation, "__args__", ()) for section in _sections(part)]


def write_reference(root: Path) -> None:
    """Write the page below the repository's root."""
    (root / "docs").mkdir(exist_ok=True)
    (root / "docs" / "configuration.md").write_text(reference_page(), encoding="utf-8")


if __name__ == "__main__":
    write_reference(Path())

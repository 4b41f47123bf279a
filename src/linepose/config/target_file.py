"""A file with a target's description, as `linepose target` writes it beside the print."""

from pathlib import Path

import yaml

from linepose.config.yaml_file import read_yaml
from linepose.errors import InputError
from linepose.settings import Settings, validated
from linepose.survey.targets.base import TargetSection
from linepose.survey.targets.registry import Target


class _TargetFile(Settings):
    target: Target


def read_target(path: Path) -> TargetSection:
    """The target of a file whose only key is `target`; raises InputError."""
    if not path.is_file():
        raise InputError(str(path), "no such file", "a file with `target:`", "correct the name")
    return validated(_TargetFile, read_yaml(path), str(path)).target


def target_text(target: TargetSection) -> str:
    """The `target` section of a platform's file, each key commented with its meaning."""
    fields = type(target).model_fields
    lines = ["target:"]
    for name, value in target.model_dump(mode="json").items():
        text = yaml.safe_dump(value, default_flow_style=True, width=10_000).removesuffix("\n").removesuffix("...")
        lines.append(f"  {name}: {text.strip()} # {(fields[name].description or '').rstrip('.')}")
    return "\n".join(lines) + "\n"

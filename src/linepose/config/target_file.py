"""A file with a target's description, as `linepose target` writes it beside the print."""

from pathlib import Path

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

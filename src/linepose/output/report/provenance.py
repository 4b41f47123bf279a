"""What a report was made with: versions of the software, and settings that name no folder of the machine."""

from collections.abc import Mapping
from importlib import metadata
from pathlib import PurePath
from platform import python_version
from typing import Any, Final

import yaml

PACKAGES: Final = (
    "linepose",
    "corner",
    "emcee",
    "matplotlib",
    "numba",
    "numpy",
    "pandas",
    "pyarrow",
    "scipy",
    "snakemake",
)


def versions() -> dict[str, str]:
    """Versions of Python and of the packages that results depend on."""
    return {"python": python_version()} | {name: metadata.version(name) for name in PACKAGES}


def settings_text(values: Mapping[str, Any]) -> str:
    """Settings as YAML; of an absolute path only its last part, because a report travels."""
    return yaml.safe_dump(
        _without_folders(dict(values)), sort_keys=False, allow_unicode=True, width=80, default_flow_style=None
    ).strip()


def _without_folders(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {key: _without_folders(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_without_folders(item) for item in value]
    if isinstance(value, PurePath) or (isinstance(value, str) and PurePath(value).is_absolute()):
        return f".../{PurePath(value).name}"
    return value

"""A project on disk: the folder that holds config/config.yaml, found from anywhere below it."""

from pathlib import Path
from typing import Any

from linepose.config.project import CONFIG as CONFIG
from linepose.config.project import Compared, Project, compared_with_none, load_project
from linepose.config.yaml_file import read_yaml
from linepose.errors import InputError


def find_project(start: Path | str = ".") -> Path:
    """The nearest folder from `start` upwards with a config/config.yaml; raises InputError where there is none."""
    here = Path(start).resolve()
    for folder in (here, *here.parents):
        if (folder / CONFIG).is_file():
            return folder
    remedy = "go to the project's folder, or make one here with `linepose new NAME`"
    raise InputError(str(here), f"no {CONFIG.as_posix()} here or above", "a linepose project", remedy)


def load_platform_project(
    name: str, root: Path, compared: Compared = compared_with_none, offline: bool = False
) -> Project:
    """The project in a folder as if this platform were its only one; raises InputError.

    Relative data folders are taken from `root`. `compared` as in `load_project`; `offline` as in config.yaml.
    """
    values: dict[str, Any] = read_yaml(root / CONFIG) | {"platforms": [name]}
    return load_project(values | ({"offline": True} if offline else {}), root, compared)

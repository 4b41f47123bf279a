"""A project on disk: the folder that holds config/config.yaml, found from anywhere below it."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from linepose.config.names import check_name
from linepose.config.platform_patterns import named_platforms
from linepose.config.project import CONFIG as CONFIG
from linepose.config.project import Compared, Project, compared_with_none, load_project
from linepose.config.study import check_study
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


def chosen_platforms(given: Sequence[str], all_platforms: bool, root: Path) -> list[str]:
    """Names of the platforms that a person asks for, by name and pattern, or of all that config.yaml names.

    Raises InputError where both or neither are asked for, for a name given twice, and for a pattern that fits none.
    """
    if all_platforms and given:
        raise InputError("--all", f"{', '.join(given)} beside it", "names or --all", "leave one of them out")
    if not all_platforms and not given:
        raise InputError("NAME", "nothing", "a platform's name, a pattern of names, or --all", "give one of them")
    values: dict[str, Any] = read_yaml(root / CONFIG)
    study = check_study(values if all_platforms else values | {"platforms": list(given)})
    place = "config/config.yaml: platforms" if all_platforms else "NAME"
    return named_platforms(study.platforms, root / study.platforms_folder, place)


def load_platform_project(
    name: str, root: Path, compared: Compared = compared_with_none, offline: bool = False
) -> Project:
    """The project in a folder as if this platform were its only one; raises InputError.

    Relative data folders are taken from `root`. `compared` as in `load_project`; `offline` as in config.yaml.
    """
    return load_platforms_project([check_name(name)], root, compared, offline)


def load_platforms_project(
    names: Sequence[str], root: Path, compared: Compared = compared_with_none, offline: bool = False
) -> Project:
    """The project in a folder as if these platforms were its only ones; the rest as in `load_platform_project`."""
    values: dict[str, Any] = read_yaml(root / CONFIG) | {"platforms": list(names)}
    return load_project(values | ({"offline": True} if offline else {}), root, compared)

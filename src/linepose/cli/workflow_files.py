"""Where the workflow stands that a project is run with, and its profiles."""

import os
from collections.abc import Mapping
from importlib.util import find_spec
from pathlib import Path
from typing import Any, Final

from linepose.errors import InputError

_BUILT_IN: Final = {"local", "dryrun", "touch"}  # executors that Snakemake brings


def find_workflow(root: Path) -> Path:
    """The Snakefile: the project's own, the one that this package carries, or that of the clone it runs from.

    Raises InputError if there is none.
    """
    package = Path(__file__).parents[1]
    for folder in (root, package / "workflow", package.parents[1]):
        if (folder / "Snakefile").is_file() and (folder / "workflow" / "rules").is_dir():
            return folder / "Snakefile"
    raise InputError(
        str(package / "workflow"),
        "no Snakefile",
        "the workflow, which the installed package carries",
        "install linepose again; without the workflow, linepose.calibrate_platform(NAME) in Python gives pose and "
        "sigmas (docs/api.md)",
    )


def find_profile(name: str, root: Path, snakefile: Path) -> Path:
    """The folder or file of a Snakemake profile: a path, or a name in the project, the workflow or the user's own.

    Raises InputError where there is none, or where the program that it hands jobs to is not installed.
    """
    user = Path(os.environ.get("XDG_CONFIG_HOME") or Path.home() / ".config") / "snakemake"
    folders = [root / "profiles", snakefile.parent / "profiles", user, Path("/etc/xdg/snakemake")]
    for place in [Path(name), *(folder / name for folder in folders)]:
        if _files(place):
            _check_executor(place)
            return place.resolve()
    names = sorted({path.name for folder in folders if folder.is_dir() for path in folder.iterdir() if _files(path)})
    raise InputError(
        "--profile",
        f"{name!r}",
        f"a folder with a config.yaml for Snakemake, or one of {', '.join(names)}",
        f"correct it, or write {root / 'profiles' / name / 'config.yaml'}",
    )


def says_cores(profile: Path) -> bool:
    """Whether a profile itself says how much may run at a time."""
    return bool({"cores", "jobs"} & _read(profile).keys())


def _check_executor(profile: Path) -> None:
    executor = str(_read(profile).get("executor", "local"))
    if executor not in _BUILT_IN and find_spec(f"snakemake_executor_plugin_{executor.replace('-', '_')}") is None:
        raise InputError(
            f"{_files(profile)[0]}: executor",
            f"{executor}, which is not installed here",
            "an executor of Snakemake that is",
            f"pip install snakemake-executor-plugin-{executor}",
        )


def _read(profile: Path) -> Mapping[str, Any]:
    from linepose.config.yaml_file import read_yaml

    return {key: value for file in _files(profile) for key, value in read_yaml(file).items()}


def _files(profile: Path) -> list[Path]:
    """The files of a profile, as Snakemake names them; none if it is no profile."""
    if profile.is_file():
        return [profile]
    return sorted([*profile.glob("profile*.yaml"), *profile.glob("config*.yaml")])

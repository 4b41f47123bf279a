"""The environment for conda has every dependency in the locked version, and works wherever it is copied."""

import re
import tomllib
from pathlib import Path

import yaml

ROOT = Path(__file__).parents[2]


def normal(name: str) -> str:
    return re.sub(r"[-_.]+", "-", name).lower()


def test_environment_has_the_locked_version_of_each_dependency_and_no_path():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    names = [re.match(r"[\w.-]+", one).group(0) for one in project["dependencies"]]
    rows = (ROOT / "requirements.lock").read_text().splitlines()
    locked = {normal(name): version for name, version in (row.split("==") for row in rows if "==" in row)}
    parts = yaml.safe_load((ROOT / "environment.yml").read_text())["dependencies"]
    assert parts[-1]["pip"] == [f"{name}=={locked[normal(name)]}" for name in names]
    assert not any("/" in part or part.startswith("-") for part in parts[:-1])

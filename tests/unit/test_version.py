"""One version: pyproject.toml says it, all others repeat it."""

import re
import tomllib
from pathlib import Path

import pytest
import yaml
from typer.testing import CliRunner

import linepose
from linepose.cli.app import app

ROOT = Path(__file__).parents[2]
VERSION = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["version"]


def test_package_and_command_line_tell_the_version_of_pyproject():
    assert linepose.__version__ == VERSION
    assert CliRunner().invoke(app, ["--version"]).stdout == f"linepose {VERSION}\n"


def test_citation_has_the_version_of_pyproject():
    assert yaml.safe_load((ROOT / "CITATION.cff").read_text())["version"] == VERSION


@pytest.mark.parametrize("page", ["README.md", "docs/your-platform.md"])
def test_wheel_has_the_version_of_pyproject_in_its_name(page):
    assert re.findall(r"linepose-([^-]+)-py3", (ROOT / page).read_text()) == [VERSION]


def test_no_other_file_of_the_library_states_a_version():
    stated = [
        path.name
        for path in (ROOT / "src").rglob("*.py*")
        if path.suffix in {".py", ".pyi"} and re.search(rf"['\"]{re.escape(VERSION)}['\"]", path.read_text())
    ]
    assert stated == []

"""The distributions: what they hold and say, and that the wheel's workflow is the clone's, without the clone."""

import re
import subprocess
import tarfile
import tomllib
import zipfile
from email import message_from_string

import pytest
from installed_wheel import environment, program
from packaging.requirements import Requirement
from tiny_project import ROOT

pytestmark = pytest.mark.workflow
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
FOLDERS = ("workflow/rules", "workflow/report", "scripts", "profiles")
DIGESTS = """
import sys
from pathlib import Path
from linepose.pipeline.code_digest import script_digest
print(*(script_digest(path) for path in sorted(Path(sys.argv[1]).glob("[a-f]*.py"))), sep="\\n")
"""
WITHOUT = """
import sys
sys.modules |= dict.fromkeys(sys.argv[1:])
import linepose
from linepose.cli import app
from linepose.inputs.navigation.registry import FORMATS
from linepose.pipeline.exports.registry import EXPORTS
print(*(type(getattr(linepose, name)).__name__ for name in linepose.__all__))
print(*(members.member(name).name for members in (FORMATS, EXPORTS) for name in members.names()))
"""


def carried():
    """The files that run the workflow, by their paths in the clone."""
    found = [path for folder in FOLDERS for path in (ROOT / folder).rglob("*.*") if "__pycache__" not in path.parts]
    return {path.relative_to(ROOT).as_posix(): path for path in [*found, ROOT / "Snakefile", ROOT / "environment.yml"]}


def of_package(suffixes):
    package = ROOT / "src" / "linepose"
    found = (path for path in package.rglob("*.*") if path.suffix in suffixes)
    return {f"linepose/{path.relative_to(package).as_posix()}" for path in found}


def test_wheel_holds_the_package_and_the_workflow_and_nothing_else(installed):
    (wheel,) = (installed / "dist").glob("*.whl")
    with zipfile.ZipFile(wheel) as archive:
        held = {name for name in archive.namelist() if ".dist-info/" not in name}
        for name, path in carried().items():
            assert archive.read(f"linepose/workflow/{name}") == path.read_bytes(), name
    package = of_package({".py", ".pyi", ".typed", ".j2", ".css"})
    assert held == package | {f"linepose/workflow/{name}" for name in carried()}


def test_source_distribution_holds_what_the_wheel_is_built_of_and_what_tests_it(installed):
    (source,) = (installed / "dist").glob("*.tar.gz")
    with tarfile.open(source) as archive:
        held = {name.partition("/")[2] for name in archive.getnames()}
    tests = {path.relative_to(ROOT).as_posix() for path in (ROOT / "tests").rglob("*.py")}
    further = {"setup.py", "pyproject.toml", "LICENSE", "README.md", "config/config.yaml", "docs/api.md"}
    assert carried().keys() | tests | further <= held
    assert [name for name in held if "__pycache__" in name or name.startswith(("results", "data", ".venv"))] == []


def test_metadata_are_those_of_pyproject(installed):
    (wheel,) = (installed / "dist").glob("*.whl")
    with zipfile.ZipFile(wheel) as archive:
        text = {name.partition(".dist-info/")[2]: archive.read(name).decode() for name in archive.namelist()[-8:]}
    told = message_from_string(text["METADATA"])
    for key in ("Name", "Version", "Requires-Python"):
        assert told[key] == PROJECT[key.lower()]
    assert (told["Summary"], told["License-Expression"]) == (PROJECT["description"], PROJECT["license"])
    assert told["Description-Content-Type"] == "text/markdown"
    assert set(told.get_all("Provides-Extra")) == PROJECT["optional-dependencies"].keys()
    needed = [Requirement(one) for one in told.get_all("Requires-Dist")]
    core = {str(one) for one in needed if one.marker is None}
    assert core == {str(Requirement(one)) for one in PROJECT["dependencies"]}
    assert "linepose = linepose.cli:main" in text["entry_points.txt"]
    for group in PROJECT["entry-points"].values():
        for name, place in group.items():
            assert f"{name} = {place}" in text["entry_points.txt"]


def test_library_works_without_its_optional_parts(installed):
    extras = {name: parts for name, parts in PROJECT["optional-dependencies"].items() if name != "development"}
    blocked = [Requirement(one).name.replace("-", "_") for parts in extras.values() for one in parts]
    assert {"PySide6", "pymavlink", "gtsam"} <= set(blocked)
    told = of_python(installed, WITHOUT, *blocked)
    assert "ardupilot" in told
    assert "urdf" in told


def test_code_of_the_wheel_is_that_of_the_clone(installed):
    """Or results that were made with the one would be made again with the other."""
    (scripts,) = installed.glob("environment/lib/python*/site-packages/linepose/workflow/scripts")
    assert of_python(installed, DIGESTS, scripts) == of_python(installed, DIGESTS, ROOT / "scripts")
    assert str(ROOT) not in of_python(installed, "import linepose; print(linepose.__file__)")


def test_wheel_goes_on_with_results_of_the_clone_and_knows_its_profiles(copied, installed):
    """In a folder that has neither workflow nor profiles."""
    run = linepose(copied.folder, installed, "run", "tiny", "--dry-run", "--profile", "ci")
    assert run.returncode == 0, run.stderr
    assert "Nothing to be done" in run.stdout + run.stderr
    assert re.search(r"profiles? \S+/linepose/workflow/profiles/ci", run.stderr), run.stderr
    run = linepose(copied.folder, installed, "run", "tiny", "--dry-run", "--profile", "none-such")
    assert run.returncode == 1
    assert run.stderr.startswith("linepose: --profile: found 'none-such', expected")
    assert "ci, default, " in run.stderr


def of_python(installed, code, *arguments):
    command = [program(installed, "python"), "-c", code, *map(str, arguments)]
    done = subprocess.run(command, env=environment(), cwd=installed, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


def linepose(folder, installed, *arguments):
    command = [program(installed, "linepose"), *arguments]
    return subprocess.run(command, env=environment(), cwd=folder, capture_output=True, text=True, check=False)

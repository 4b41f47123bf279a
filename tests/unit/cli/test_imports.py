"""What each command imports: a command that tells something must not load what computes."""

import json
import subprocess
import sys

import pytest

from linepose.config.new_platform import NewPlatform, write_platform
from linepose.config.new_project import make_project

COMPUTES = {"numba", "emcee", "scipy.stats", "scipy.optimize", "snakemake", "matplotlib", "pooch", "geopandas"}
TABLES = {"numpy", "pandas", "pyarrow", "scipy"}
CODE = """
import json, sys
from linepose.cli import main
try:
    main()
finally:
    print(json.dumps(sorted(sys.modules)), file=sys.stderr)
"""


def modules_of(arguments, folder):
    ran = subprocess.run([sys.executable, "-c", CODE, *arguments], cwd=folder, capture_output=True, text=True)
    return set(json.loads(ran.stderr.splitlines()[-1])), ran


@pytest.fixture(scope="module")
def project(tmp_path_factory):
    folder = tmp_path_factory.mktemp("project")
    make_project(folder, "mine")
    (folder / "data" / "mine").mkdir(parents=True)
    new = NewPlatform("mine", 8e-3, 8e-6, 640, (0.2, 0.0, -0.8), (0.0, 0.0, -90.0))
    write_platform(folder / "config" / "platforms", new)
    return folder


@pytest.mark.parametrize("arguments", [["--help"], ["check", "--help"], ["new", "--help"], ["export", "--list"]])
def test_help_and_lists_load_no_library_of_numbers(arguments, project):
    loaded, ran = modules_of(arguments, project)
    assert ran.returncode == 0
    assert (COMPUTES | TABLES) & loaded == set()


@pytest.mark.parametrize("arguments", [["show", "mine"], ["export", "mine", "--format", "urdf"]])
def test_what_tells_a_result_loads_nothing_that_computes(arguments, project):
    loaded, ran = modules_of(arguments, project)
    assert "no result" in ran.stderr
    assert COMPUTES & loaded == set()

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
codes = []
for command in json.loads(sys.argv[1]):
    sys.argv[1:] = command
    try:
        main()
        codes.append(0)
    except SystemExit as ended:
        codes.append(ended.code or 0)
print(json.dumps([codes, sorted(sys.modules)]), file=sys.stderr)
"""


def modules_of(commands, folder, first=""):
    """The codes that commands of one process end with, the modules that it has then, and what it told."""
    ran = subprocess.run(
        [sys.executable, "-c", first + CODE, json.dumps(commands)],
        cwd=folder,
        capture_output=True,
        text=True,
        check=True,
    )
    codes, loaded = json.loads(ran.stderr.splitlines()[-1])
    return codes, set(loaded), ran.stderr


@pytest.fixture(scope="module")
def project(tmp_path_factory):
    folder = tmp_path_factory.mktemp("project")
    make_project(folder, "mine")
    (folder / "data" / "mine").mkdir(parents=True)
    new = NewPlatform("mine", 8e-3, 8e-6, 640, (0.2, 0.0, -0.8), (0.0, 0.0, -90.0))
    write_platform(folder / "config" / "platforms", new)
    return folder


def test_help_and_lists_load_no_library_of_numbers(project):
    codes, loaded, _ = modules_of([["--help"], ["check", "--help"], ["new", "--help"], ["export", "--list"]], project)
    assert codes == [0, 0, 0, 0]
    assert (COMPUTES | TABLES) & loaded == set()


def test_what_tells_a_result_or_reads_the_workflow_loads_nothing_that_computes(project):
    commands = [["show", "mine"], ["export", "mine", "--format", "urdf"]]
    _, loaded, told = modules_of(commands, project, "import linepose.experiments.registry")
    assert told.count("no result") == 2
    assert COMPUTES & loaded == set()

"""A project with one platform of labelled views, written by the simulator: made once, copied for each test to spoil."""

import shutil
from pathlib import Path

import pytest

from linepose.config.new_platform import NewPlatform, write_platform
from linepose.config.new_project import make_project
from linepose.config.platform import load_platform
from unit.recorded_files import write_platform_files

CONFIG = Path(__file__).parents[3] / "config"
N_OBSERVATIONS = 12


@pytest.fixture(scope="session")
def clean_project(tmp_path_factory) -> Path:
    """Platform `mine`: the first passes of the simulated Ladybird, without faults."""
    root = tmp_path_factory.mktemp("clean")
    make_project(root, "mine")
    new = NewPlatform("mine", 8.2e-3, 7.407407407e-6, 648, (0.2, 0.0, -0.8), (-56.0, 0.0, -90.0), 323.0)
    write_platform(root / "config" / "platforms", new)
    write_platform_files(root / "data" / "mine", load_platform(CONFIG / "platforms", "ladybird-sim"), N_OBSERVATIONS)
    return root


@pytest.fixture
def project(clean_project, tmp_path) -> Path:
    """A copy of the clean project."""
    return Path(shutil.copytree(clean_project, tmp_path / "project"))

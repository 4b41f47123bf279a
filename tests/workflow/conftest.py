"""The tiny project after a run, once a session."""

import shutil
from pathlib import Path

import pytest
from installed_wheel import install_wheel
from made_once import made_once
from tiny_project import STUDY, TINY, Project


def _run(folder: Path) -> None:
    project = Project(folder)
    project.configure(STUDY, {"tiny": TINY})
    run = project.run()
    assert run.returncode == 0, run.stderr


@pytest.fixture(scope="session")
def finished(tmp_path_factory) -> Project:
    """The tiny platform's project after a run on two cores; tests must not change its results."""
    return Project(made_once(tmp_path_factory, "finished", _run))


@pytest.fixture
def copied(finished, tmp_path) -> Project:
    """A copy of the finished project, to be spoilt."""
    shutil.copytree(finished.folder, tmp_path / "project")
    return Project(tmp_path / "project")


@pytest.fixture(scope="session")
def installed(tmp_path_factory) -> Path:
    """A folder with the distributions, and an environment in which the wheel is installed."""
    return made_once(tmp_path_factory, "installed", install_wheel)

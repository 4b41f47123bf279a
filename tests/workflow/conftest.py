"""The tiny project after a run, once a session."""

import shutil

import pytest
from tiny_project import STUDY, TINY, Project


@pytest.fixture(scope="session")
def finished(tmp_path_factory) -> Project:
    """The tiny platform's project after a run on two cores; tests must not change its results."""
    project = Project(tmp_path_factory.mktemp("finished"))
    project.configure(STUDY, {"tiny": TINY})
    run = project.run()
    assert run.returncode == 0, run.stderr
    return project


@pytest.fixture
def copied(finished, tmp_path) -> Project:
    """A copy of the finished project, to be spoilt."""
    shutil.copytree(finished.folder, tmp_path / "project")
    return Project(tmp_path / "project")

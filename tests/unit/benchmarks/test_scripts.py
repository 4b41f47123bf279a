"""Benchmarks are not run by the tests, but each can begin."""

import runpy
import sys
from pathlib import Path

import pytest

BENCHMARKS = Path(__file__).parents[3] / "benchmarks"


@pytest.fixture(autouse=True)
def _as_a_script_of_that_folder(monkeypatch):
    monkeypatch.setattr(sys, "path", [str(BENCHMARKS), *sys.path])


@pytest.mark.parametrize("script", sorted(path.name for path in BENCHMARKS.glob("*.py")))
def test_script_finds_all_that_it_imports(script):
    assert runpy.run_path(str(BENCHMARKS / script), run_name="imported")["__doc__"]


def test_benchmark_of_the_workflow_finds_the_study():
    names, folders = runpy.run_path(str(BENCHMARKS / "workflow.py"), run_name="imported")["field_study"]()
    assert names == ["ladybird", "ladybird-attitude"]
    assert all(Path(folder).is_absolute() for folder in folders)
    assert folders

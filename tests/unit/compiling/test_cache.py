"""Compiled code goes when any source of its folder changes, not only its own file."""

import subprocess
import sys

import pytest

from linepose.compiling.cache import forget_outdated


@pytest.fixture
def folder(tmp_path):
    """A package of two modules, one compiled."""
    (tmp_path / "caller.py").write_text("a = 1\n")
    (tmp_path / "called.py").write_text("b = 1\n")
    forget_outdated(tmp_path)
    for ending in ("nbi", "1.nbc"):
        (tmp_path / "__pycache__" / f"caller.f-1.py311.{ending}").write_bytes(b"compiled")
    (tmp_path / "__pycache__" / "caller.cpython-311.pyc").write_bytes(b"bytecode")
    return tmp_path


def compiled(folder):
    return sorted(path.name for path in (folder / "__pycache__").glob("*.nb*"))


def test_unchanged_sources_keep_it(folder):
    forget_outdated(folder)
    assert len(compiled(folder)) == 2


def test_another_source_of_the_folder_removes_it(folder):
    (folder / "called.py").write_text("b = 2\n")
    forget_outdated(folder)
    assert compiled(folder) == []
    assert (folder / "__pycache__" / "caller.cpython-311.pyc").exists()


def test_a_source_elsewhere_removes_it(folder, tmp_path_factory):
    constants = tmp_path_factory.mktemp("elsewhere") / "constants.py"
    constants.write_text("c = 1\n")
    forget_outdated(folder, [constants])
    assert compiled(folder) == []


def test_numba_calls_new_code_of_an_unchanged_function(tmp_path):
    """What the stamp is for: a compiled caller whose callee changes, in processes of their own."""
    package = tmp_path / "kernels"
    package.mkdir()
    (package / "__init__.py").write_text(
        "from pathlib import Path\nfrom linepose.compiling.cache import forget_outdated\n"
        "forget_outdated(Path(__file__).parent)\n"
    )
    (package / "caller.py").write_text(
        "from numba import njit\nfrom kernels.called import g\n@njit(cache=True)\ndef f():\n    return g()\n"
    )
    results = []
    for number in (1, 2):
        (package / "called.py").write_text(
            f"from numba import njit\n@njit(cache=True)\ndef g():\n    return {number}\n"
        )
        command = [sys.executable, "-c", "from kernels.caller import f; print(f())"]
        run = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=True)
        results.append(run.stdout.strip())
    assert results == ["1", "2"]

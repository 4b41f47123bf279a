import ast
import importlib.util
import shutil
from pathlib import Path

import pytest

import linepose
from linepose.pipeline.provenance import files_digest, source_digest

LIBRARY = Path(linepose.__file__).parent


@pytest.fixture
def copied(tmp_path):
    """A copy of the library, and a function that gives digests of it as it stands."""
    package = tmp_path / "linepose"
    shutil.copytree(LIBRARY, package, ignore=shutil.ignore_patterns("__pycache__"))

    def digest(module):
        spec = importlib.util.spec_from_file_location("copied_provenance", package / "provenance.py")
        fresh = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(fresh)
        return fresh.source_digest(module)

    return package, digest


def test_digest_is_the_same_wherever_the_library_stands(copied):
    _, digest = copied
    assert (
        digest("linepose.estimation.outliers")
        == source_digest("linepose.estimation.outliers")
        == source_digest("linepose.estimation.outliers")
    )


@pytest.mark.parametrize(
    "changed",
    [
        "outliers.py",  # itself
        "optimise.py",  # from linepose.estimation.optimise import Optimum
        "rotations.py",  # through pose: from linepose import rotations
        "likelihood/base.py",
        "likelihood/__init__.py",  # runs when base is imported
        "__init__.py",
        "errors.py",
    ],
)
def test_digest_changes_with_whatever_the_module_imports(copied, changed):
    package, digest = copied
    before = digest("linepose.estimation.outliers")
    with (package / changed).open("a") as file:
        file.write("# another line\n")
    assert digest("linepose.estimation.outliers") != before


@pytest.mark.parametrize("changed", ["diagnostics.py", "tables/regression.py", "storage.py", "config/study.py"])
def test_digest_does_not_change_with_an_unrelated_module(copied, changed):
    package, digest = copied
    before = digest("linepose.estimation.outliers")
    with (package / changed).open("a") as file:
        file.write("# another line\n")
    assert digest("linepose.estimation.outliers") == before


@pytest.mark.parametrize("statement", ["import linepose.tables", "def late():\n    from linepose import storage\n"])
def test_every_form_of_import_counts(copied, statement):
    package, digest = copied
    (package / "made_up.py").write_text(f"{statement}\n")
    before = digest("linepose.made_up")
    with (package / "storage.py").open("a") as file:
        file.write("# another line\n")
    assert digest("linepose.made_up") != before


def test_modules_that_import_each_other_have_a_digest(copied):
    package, digest = copied
    (package / "one.py").write_text("import linepose.two\n")
    (package / "two.py").write_text("import linepose.one\n")
    assert digest("linepose.one") != digest("linepose.geometry.rotations")


def test_package_stands_for_its_own_source(copied):
    package, digest = copied
    before = digest("linepose.likelihood")
    (package / "likelihood" / "__init__.py").write_text("")
    assert digest("linepose.likelihood") != before


def test_library_has_no_relative_import_which_the_digest_would_miss():
    for path in LIBRARY.rglob("*.py"):
        relative = [n for n in ast.walk(ast.parse(path.read_text())) if isinstance(n, ast.ImportFrom) and n.level]
        assert not relative, path


def test_digest_of_a_folder_follows_its_files(copied, monkeypatch):
    package, _ = copied
    monkeypatch.setattr("linepose.pipeline.provenance._PACKAGE", package)
    before = files_digest("output/report/templates")
    assert files_digest("output/report/templates") == before
    style = package / "report" / "templates" / "style.css"
    style.write_text(style.read_text(encoding="utf-8") + "\n", encoding="utf-8")
    assert files_digest("output/report/templates") != before

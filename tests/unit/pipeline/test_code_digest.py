"""Digests of scripts: each module that a script imports counts, and only what changes numbers."""

import ast
import dataclasses
import importlib.util
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import linepose
from linepose.pipeline import code_digest
from linepose.pipeline.code_digest import code_files, present_digest, script_digest

LIBRARY = Path(linepose.__file__).parent
SCRIPTS = sorted((LIBRARY.parents[1] / "scripts").glob("*.py"))
OPTIMISE = LIBRARY.parents[1] / "scripts" / "optimise.py"


@pytest.fixture
def copied(tmp_path):
    """A copy of the library and of a script, and a function that gives the script's digest as they now are."""
    package = tmp_path / "linepose"
    shutil.copytree(LIBRARY, package, ignore=shutil.ignore_patterns("__pycache__"))
    script = tmp_path / "scripts" / "made_up.py"
    script.parent.mkdir()
    script.write_text("from helper import run\nfrom linepose.estimation import outliers\n")
    script.with_name("helper.py").write_text("run = 1\n")

    def digest(*modules):
        spec = importlib.util.spec_from_file_location("copied_digest", package / "pipeline" / "code_digest.py")
        fresh = importlib.util.module_from_spec(spec)
        sys.modules["copied_digest"] = fresh
        spec.loader.exec_module(fresh)
        return fresh.script_digest(script, *modules)

    return package, script, digest


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.stem)
def test_every_module_that_a_script_imports_counts(script, monkeypatch):
    files, before, read = code_files(script), code_digest._digest.__wrapped__(str(script), ()), code_digest._file
    for changed in files:

        def with_change(name, changed=changed):
            file = read(name)
            return dataclasses.replace(file, digest="changed") if name == str(changed) else file

        monkeypatch.setattr(code_digest, "_file", with_change)
        assert code_digest._digest.__wrapped__(str(script), ()) != before, changed


def test_closure_is_what_a_run_of_the_imports_loads():
    tree = ast.parse(OPTIMISE.read_text())
    imports = [ast.unparse(node) for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)]
    told = (
        "import sys; print(*(m.__file__ for n, m in sys.modules.items() if n.split('.')[0] == 'linepose'), sep='\\n')"
    )
    code = "\n".join([f"import sys; sys.path.insert(0, {str(OPTIMISE.parent)!r})", *imports, told])
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()
    assert len(loaded) > 20
    assert set(loaded) <= {str(path) for path in code_files(OPTIMISE)}


@pytest.mark.parametrize(
    "changed",
    [
        "estimation/outliers.py",  # named by the script
        "estimation/optimise.py",  # from linepose.estimation.optimise import ...
        "geometry/rotations.py",  # through others
        "likelihood/__init__.py",  # runs when a module of it is imported
        "__init__.py",
        "../scripts/helper.py",
        "../scripts/made_up.py",
    ],
)
def test_changed_code_counts_wherever_it_is_imported(copied, changed):
    package, _, digest = copied
    before = digest()
    with (package / changed).open("a") as file:
        file.write("FURTHER = 1\n")
    assert digest() != before


@pytest.mark.parametrize("unrelated", ["estimation/diagnostics.py", "output/report/page.py"])
def test_unrelated_code_does_not_count(copied, unrelated):
    package, _, digest = copied
    before = digest()
    with (package / unrelated).open("a") as file:
        file.write("FURTHER = 1\n")
    assert digest() == before


CODE = '''"""Words."""

LIMIT: float = 2.0


class Settings:
    """Words."""

    size: int = 3


def run(x: float) -> float:
    """Words."""
    half: float = x / 2  # a comment
    return half
'''


@pytest.mark.parametrize(
    ("old", "new", "counts"),
    [
        ("Words", "Other words", False),
        ("  # a comment", "", False),
        ("\n\nclass", "\n\n# another comment\n\n\nclass", False),
        ("x: float) -> float", "x: int) -> int", False),
        ("half: float =", "half: int =", False),
        ("x / 2", "(x / 2)", False),
        ("x / 2", "x / 3", True),
        ("2.0", "2.5", True),
        ("size: int", "size: float", True),
        ("half\n", "x\n", True),
        ("def run", "@decorated\ndef run", True),
    ],
)
def test_only_what_changes_numbers_counts(copied, old, new, counts):
    package, _, digest = copied
    (package / "made_up.py").write_text(CODE)
    before = digest("linepose.made_up")
    assert old in CODE
    (package / "made_up.py").write_text(CODE.replace(old, new))
    assert (digest("linepose.made_up") != before) is counts


@pytest.mark.parametrize(
    "statement",
    [
        "import linepose.output.report.page",
        "def late():\n    from linepose.output.report import page",
        'MEMBERS = ["linepose.output.report.page:PAGE"]',
    ],
)
def test_every_way_to_name_a_module_counts(copied, statement):
    package, _, digest = copied
    (package / "made_up.py").write_text(f"{statement}\n")
    before = digest("linepose.made_up")
    with (package / "output" / "report" / "page.py").open("a") as file:
        file.write("FURTHER = 1\n")
    assert digest("linepose.made_up") != before


def test_names_that_a_package_imports_late_count(copied):
    package, _, digest = copied
    before = digest("linepose.inputs.navigation")
    with (package / "inputs" / "navigation" / "reading.py").open("a") as file:
        file.write("FURTHER = 1\n")
    assert digest("linepose.inputs.navigation") != before


def test_data_beside_the_code_count(copied):
    package, _, digest = copied
    before = digest("linepose.output.report.page")
    with (package / "output" / "report" / "templates" / "style.css").open("a") as file:
        file.write("\n")
    assert digest("linepose.output.report.page") != before


def test_modules_that_import_each_other_have_a_digest(copied):
    package, _, digest = copied
    (package / "one.py").write_text("import linepose.two\n")
    (package / "two.py").write_text("import linepose.one\n")
    assert digest("linepose.one") != digest()


def test_a_list_of_modules_does_not_lead_to_its_members(copied):
    package, _, digest = copied
    (package / "experiments" / "registry.py").write_text("from linepose.output.report import page\n")
    before = digest("linepose.experiments.registry")
    with (package / "output" / "report" / "page.py").open("a") as file:
        file.write("FURTHER = 1\n")
    assert digest("linepose.experiments.registry") == before


def test_digest_is_found_again_by_what_it_says(tmp_path):
    recorded = script_digest(OPTIMISE, "linepose.experiments.basin")
    assert recorded.split()[:2] == ["optimise", "linepose.experiments.basin"]
    assert present_digest(recorded, OPTIMISE.parent) == recorded
    assert present_digest(recorded, tmp_path) is None


def test_library_has_no_import_that_the_digest_would_miss():
    lazy = set(linepose.__all__)
    for path in LIBRARY.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.ImportFrom):
                assert not node.level, f"{path}: relative import, which is not followed"
                assert not (node.module == "linepose" and lazy & {name.name for name in node.names}), path

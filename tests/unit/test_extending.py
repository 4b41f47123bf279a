"""docs/extending.md adds one of each to a copy of the package, exactly as it stands there, and each is reachable."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import yaml

from unit import made_up

ROOT = Path(os.environ.get("ROOT_TO_EXTEND", Path(__file__).parents[2]))
PAGE = (Path(__file__).parents[2] / "docs" / "extending.md").read_text()
COPIED = ("src", "config", "workflow", "scripts", "docs", "Snakefile", "pyproject.toml", "README.md")
EDIT = re.compile(r"^`([^`\n]+)`(?:, new)?:\n\n((?:```(?:python|diff|toml)\n.*?^```\n\n?)+)", re.MULTILINE | re.DOTALL)
TABLE_ROW = re.compile(r"^\| an? (.+?) \| `(.+?)` \| `(.+?)` \|$", re.MULTILINE)


GIVEN = (
    *("--focal-length-mm", "8.2", "--pixel-pitch-um", "7.407407", "--pixels", "648"),
    *("--position-m", "0.2", "0", "-0.8", "--euler-deg", "-56", "0", "-90"),
)
IN_USE = """
from pathlib import Path

from linepose.config.platform import load_platform
from linepose.estimation.noise_models import likelihood_of
from linepose.simulation.survey import simulate_survey

mine = load_platform(Path("config/platforms"), "mine")
survey, _ = simulate_survey(mine.intrinsics(), mine.simulation, seed=5)
likelihood = likelihood_of(mine.noise_model, survey, mine.intrinsics())
print(likelihood.survey.covariance[0, 0, 0, 0] / survey.covariance[0, 0, 0, 0])
"""
READ = """
from pathlib import Path

from linepose.config.platform import load_platform
from linepose.inputs.navigation import read_navigation

record = read_navigation(load_platform(Path("config/platforms"), "mine").source, Path())
print(*record.log.position_m[0], record.log.euler_rad[0, 2])
"""
DRAW = """
from pathlib import Path

from linepose.config.platform import load_platform
from linepose.output.figures import render
from linepose.pipeline.calibration import Calibration

render.FIGURES = [entry for entry in render.FIGURES if entry.name == "headings"]
folder = Path("results/mine")
mine = Calibration.from_results(folder, load_platform(Path("config/platforms"), "mine"))
print(*render.render_figures(mine, folder / "figures")["alt"])
print(*((folder / "figures" / f"headings.{kind}").is_file() for kind in ("png", "pdf")))
"""


class Copy:
    """A copy of what a clone holds, to be extended."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        ignored = shutil.ignore_patterns("__pycache__", "*.egg-info")
        for name in COPIED:
            source = ROOT / name
            if source.is_dir():
                shutil.copytree(source, folder / name, ignore=ignored)
            else:
                shutil.copy(source, folder / name)

    def install(self) -> None:
        """Let the copy's entry points be found."""
        self.python("-c", "from setuptools import setup; setup()", "--quiet", "egg_info")

    def extend(self, kind: str) -> set[str]:
        """Make the edits of a section of the page; the paths that they touch."""
        (section,) = re.findall(rf"^## An? {kind}\n(.*?)(?=^## |\Z)", PAGE, re.MULTILINE | re.DOTALL)
        edits = EDIT.findall(section)
        for path, blocks in edits:
            for language, block in re.findall(r"```(\w+)\n(.*?)^```", blocks, re.MULTILINE | re.DOTALL):
                self.edit(self.folder / path, language, block)
        return {path for path, _ in edits}

    def edit(self, path: Path, language: str, block: str) -> None:
        """Write a new file, or make the change of a diff: its old rows stand in the file once."""
        if language != "diff":
            assert not path.exists()
            path.write_text(block)
            return
        rows = block.splitlines(keepends=True)
        old, new = ("".join(row[1:] or "\n" for row in rows if row[0] != other) for other in "+-")
        text = path.read_text()
        assert text.count(old) == 1, old
        path.write_text(text.replace(old, new))

    def python(self, *arguments: str) -> str:
        """What Python prints with the copy as the package; it must end well."""
        done = subprocess.run(
            [sys.executable, *arguments],
            cwd=self.folder,
            env=os.environ | {"PYTHONPATH": str(self.folder / "src")},
            capture_output=True,
            text=True,
            timeout=300,
            check=False,
        )
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout

    def linepose(self, *arguments: str) -> str:
        """What the command line prints."""
        return self.python("-c", "from linepose.cli import main; main()", *arguments)

    def reference(self) -> str:
        """The page of all keys, as `make reference` makes it."""
        (module,) = re.findall(r"python -m (linepose\S+reference)$", (ROOT / "Makefile").read_text(), re.MULTILINE)
        self.python("-m", module)
        return (self.folder / "docs" / "configuration.md").read_text()

    def platform(self, **values: object) -> None:
        """A platform `mine` of the copy, like the simulated one."""
        text = yaml.safe_dump({"like": "ladybird-sim"} | values)
        (self.folder / "config" / "platforms" / "mine.yaml").write_text(text)
        (self.folder / "config" / "config.yaml").write_text(yaml.safe_dump({"platforms": ["mine"]}))


@pytest.fixture(scope="module")
def copy(tmp_path_factory) -> Copy:
    """The copy with one more of each kind; no file was touched but those that the page's table names for the kind."""
    copy = Copy(tmp_path_factory.mktemp("copy"))
    rows, modules = TABLE_ROW.findall(PAGE), []
    assert len(rows) == 5
    for kind, new, entry in rows:
        touched = copy.extend(kind)
        assert touched == {new, entry}
        modules += [path for path in touched if path.endswith(".py")]
    copy.python("-m", "ruff", "check", *modules)
    copy.python("-m", "ruff", "format", "--check", "--diff", *modules)
    copy.install()
    return copy


@pytest.fixture(scope="module")
def reference(copy) -> str:
    return copy.reference()


@pytest.fixture(scope="module")
def planned(copy) -> str:
    """What the workflow plans for a platform with the new noise model and the new experiment."""
    copy.platform(noise_model="doubled", experiments={"headings": {"n_sectors": 8}})
    wanted = ["results/mine/optima.parquet", "results/mine/headings.parquet"]
    return copy.python("-m", "snakemake", "--dry-run", "--cores", "1", *wanted)


def test_noise_model(copy, reference, planned):
    copy.platform(noise_model="doubled")
    assert "doubled: the paper's, with the reported sigmas doubled" in reference
    assert float(copy.python("-c", IN_USE)) == pytest.approx(4)
    assert "results/compiled/doubled.txt" in planned


def test_navigation_format(copy, reference):
    navigation = {"format": "tum", "file": "trajectory.txt"}
    source = {"kind": "scans", "dataset": "mine", "navigation": navigation, "covariances": "covariances.csv"}
    copy.platform(source=source, simulation=None)
    (copy.folder / "trajectory.txt").write_text("1700000000.25 1 2 3 0 0 0 1\n1700000000.50 2 2 3 0 0 0 1\n")
    assert "`tum`: time, position and quaternion of each pose." in reference
    north, east, down, yaw = np.array(copy.python("-c", READ).split(), dtype=float)
    np.testing.assert_allclose([north, east, down, yaw], [2, 1, -3, np.pi / 2], atol=1e-12)
    copy.linepose("new", "other", *GIVEN, "--source", "scans", "--navigation-format", "tum")
    assert "format: tum" in (copy.folder / "config" / "platforms" / "other.yaml").read_text()


def test_experiment(reference, planned):
    assert "experiments.headings.n_sectors" in reference
    assert "rule headings:" in planned


def test_figure(copy):
    copy.platform()
    made_up.write_results(copy.folder / "results" / "mine")
    told = copy.python("-c", DRAW)
    assert told.splitlines() == ["mine: histogram of the headings of the accepted observations.", "True True"]


def test_export(copy):
    copy.platform()
    made_up.write_results(copy.folder / "results" / "mine")
    assert "4 x 4 matrix from camera to body, plain text" in copy.linepose("export", "mine", "--list")
    copy.linepose("export", "mine", "--format", "matrix")
    matrix = np.loadtxt(copy.folder / "results" / "mine" / "exports" / "mine.txt")
    np.testing.assert_allclose(matrix[:3, 3], made_up.OPTIMUM[:3])

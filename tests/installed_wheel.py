"""The wheel, built offline from the source distribution, and installed beside this environment's libraries."""

import os
import shutil
import subprocess
import sys
import sysconfig
import venv
from pathlib import Path

ROOT = Path(__file__).parents[1]
BUILD = "from setuptools import build_meta; build_meta.build_sdist('dist')"
IGNORED = shutil.ignore_patterns(
    ".*", "__pycache__", "*.egg-info", "results", "data", "build", "dist", "logs", "field-data"
)


def install_wheel(folder: Path) -> None:
    """Fill `folder` with `dist`, both distributions, and `environment`, in which only the wheel is linepose.

    Kernels that were compiled in the clone are taken along: their sources are the same.
    """
    shutil.copytree(ROOT, folder / "clone", ignore=IGNORED)
    _run([sys.executable, "-c", BUILD], folder / "clone")
    (source,) = (folder / "clone" / "dist").iterdir()
    (folder / "dist").mkdir()
    shutil.move(source, folder / "dist")
    shutil.rmtree(folder / "clone")
    pip = [sys.executable, "-m", "pip", "--quiet", "--disable-pip-version-check"]
    offline = ["--no-deps", "--no-build-isolation", "--no-index"]
    _run([*pip, "wheel", *offline, "--wheel-dir", "dist", f"dist/{source.name}"], folder)
    venv.create(folder / "environment", symlinks=True)
    (wheel,) = (folder / "dist").glob("*.whl")
    python = str(program(folder, "python"))
    _run([*pip, "--python", python, "install", "--no-compile", *offline, str(wheel)], folder)
    packages = _packages(folder)
    (packages / "libraries.pth").write_text(f"{sysconfig.get_path('purelib')}\n")
    _take_kernels(packages / "linepose")


def program(folder: Path, name: str) -> Path:
    """A program of the environment in a folder that `install_wheel` has filled."""
    return folder / "environment" / "bin" / name


def environment() -> dict[str, str]:
    """The variables of a user who has no clone."""
    return {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}


def _packages(folder: Path) -> Path:
    (found,) = (folder / "environment" / "lib").glob("python*/site-packages")
    return found


def _take_kernels(package: Path) -> None:
    """Numba knows the sources of compiled code by their times and sizes."""
    clone = ROOT / "src" / "linepose"
    for cache in {path.parent for path in clone.rglob("__pycache__/*.nbi")}:
        place = package / cache.relative_to(clone)
        place.mkdir(exist_ok=True)
        for path in [*cache.glob("*.nb[ic]"), *cache.glob("compiled_from.txt")]:
            shutil.copy2(path, place)
        for source in cache.parent.glob("*.py"):
            shutil.copystat(source, place.parent / source.name)


def _run(command: list[str], folder: Path) -> None:
    done = subprocess.run(command, cwd=folder, env=environment(), capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr

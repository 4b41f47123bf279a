"""What code a result comes from: a digest of a script and of all it imports, of which only what changes numbers counts.

Followed are imports of this package and of the script's own folder, at the top or inside functions, modules that a
string names ("linepose.survey.navigation", as lists of lazy imports do), and entry points of a group that a string
names. Docstrings, comments, blank lines, and annotations inside functions are left out.
"""

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from importlib.metadata import entry_points
from pathlib import Path
from typing import Final

from linepose.pipeline.module_source import SourceCache

_PACKAGE: Final = Path(__file__).parents[1]
_WORKFLOW: Final = _PACKAGE / "workflow"  # which the wheel carries: no part of the library
_CODE: Final = {".py", ".pyi", ".pyc", ".typed"}
_CACHE: Final = SourceCache(Path(__file__).parent / "__pycache__")

LISTS: Final = frozenset({"linepose/experiments/registry.py", "linepose/pipeline/exports/registry.py"})
"""Modules that list others of which a job runs one, which its rule names beside the script, or none."""


def script_digest(script: Path | str, *modules: str) -> str:
    """The digest of a script's code as "NAME MODULE ... DIGEST", by which `present_digest` finds it again.

    `modules` are those ("linepose.experiments.basin") that the script imports by a name it is given.
    """
    return " ".join([Path(script).stem, *modules, _digest(str(script), modules)])


def present_digest(recorded: str, scripts: Path) -> str | None:
    """What `script_digest` is now for the script of an earlier one, in this folder; None where the script is gone."""
    name, *modules, _ = recorded.split(" ")
    script = scripts / f"{name}.py"
    return script_digest(script, *modules) if script.is_file() else None


def code_files(script: Path | str, *modules: str) -> list[Path]:
    """Every file that counts: the script, the modules it imports and theirs, and what lies beside these as data."""
    return [Path(file) for file in _closure(str(script), modules)]


@dataclass(frozen=True)
class _File:
    """What counts of a file, its name wherever library and scripts stand, and the files that it leads to."""

    digest: str
    place: str
    leads_to: tuple[str, ...]


@cache
def _digest(script: str, modules: tuple[str, ...]) -> str:
    counted = [_file(file) for file in _closure(script, modules)]
    _CACHE.save()
    text = "\n".join(sorted(f"{file.place} {file.digest}" for file in counted))
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def _closure(script: str, modules: Sequence[str]) -> list[str]:
    found: set[str] = set()
    waiting = [script, *(file for name in modules for file in _files(name, script))]
    while waiting:
        path = waiting.pop()
        if path not in found:
            found.add(path)
            waiting.extend(_file(path).leads_to)
    return sorted(found)


@cache
def _file(name: str) -> _File:
    path = Path(name)
    place = path.relative_to(_PACKAGE.parent).as_posix() if _is_of_library(path) else path.name
    if path.suffix != ".py":
        return _File(hashlib.sha256(path.read_bytes()).hexdigest()[:16], place, ())
    source = _CACHE.read(path)
    if place in LISTS:
        return _File(source.digest, place, ())
    points = [point for group in source.strings if group in _groups() for point in entry_points(group=group)]
    named = [*source.imports, *(text.partition(":")[0] for text in source.strings), *(point.module for point in points)]
    stub = path.with_suffix(".pyi")
    if path.name == "__init__.py" and path.parent != _PACKAGE and stub.is_file():  # names that are imported late
        package = ".".join(path.parent.relative_to(_PACKAGE.parent).parts)
        named += [f"{package}{module}" for module in _CACHE.read(stub).imports if module.startswith(".")]
    strangers = sorted(f" {point.name}={point.value}" for point in points if not _is_ours(point.module))
    leads_to = dict.fromkeys(file for module in named for file in _files(module, name))
    data = _package_data(path.parent) if path.name == "__init__.py" else ()
    return _File("".join([source.digest, *strangers]), place, (*leads_to, *data))


@cache
def _groups() -> frozenset[str]:
    """Groups of entry points that belong to this package."""
    return frozenset(group for group in entry_points().groups if group.startswith(f"{_PACKAGE.name}."))


def _files(module: str, importer: str) -> tuple[str, ...]:
    """The files that importing a module runs, its packages' among them; none for what is not followed."""
    if _is_ours(module):
        return _package_files(module)
    beside = Path(importer).with_name(f"{module}.py")
    return (str(beside),) if not _is_of_library(Path(importer)) and beside.is_file() else ()


@cache
def _package_files(module: str) -> tuple[str, ...]:
    found, path = [], _PACKAGE
    for part in ["", *module.split(".")[1:]]:
        path = path / part
        file = path / "__init__.py" if path.is_dir() else path.with_suffix(".py")
        if not file.is_file():
            break
        found.append(str(file))
    return tuple(found)


def _package_data(package: Path) -> tuple[str, ...]:
    """Files other than code in a package's folder and in those of its folders that are no packages."""
    found: list[Path] = []
    for path in sorted(package.iterdir()):
        if path == _WORKFLOW or path.name == "__pycache__":
            continue
        if path.is_dir() and not any(path.glob("*.py")):
            found += (file for file in path.rglob("*") if file.is_file())
        elif path.is_file() and path.suffix not in _CODE:
            found.append(path)
    return tuple(str(path) for path in sorted(found))


def _is_of_library(path: Path) -> bool:
    return path.is_relative_to(_PACKAGE) and not path.is_relative_to(_WORKFLOW)


def _is_ours(module: str) -> bool:
    return module.partition(".")[0] == _PACKAGE.name

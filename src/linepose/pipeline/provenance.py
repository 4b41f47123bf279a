"""What code a result comes from: a digest of a module and of all modules of this package that it imports."""

import ast
import hashlib
from functools import cache
from pathlib import Path
from typing import Final

_PACKAGE: Final = Path(__file__).parents[1]


def source_digest(module: str) -> str:
    """Digest of the sources that `module` ("linepose.errors") is made of; it changes when one of them does."""
    digest = hashlib.sha256()
    for path in sorted(_closure(_path_of(module))):
        digest.update(path.relative_to(_PACKAGE).as_posix().encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def files_digest(folder: str) -> str:
    """Digest of all files in a folder of this package ("output/report/templates"), beside its code."""
    digest = hashlib.sha256()
    for path in sorted((_PACKAGE / folder).iterdir()):
        digest.update(path.name.encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def _closure(start: Path) -> set[Path]:
    found: set[Path] = set()
    waiting = [start]
    while waiting:
        path = waiting.pop()
        if path not in found:
            found.add(path)
            waiting.extend(_imports(path))
    return found


@cache
def _imports(path: Path) -> tuple[Path, ...]:
    names: list[str] = []
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.module and node.level == 0:
            names += [node.module, *(f"{node.module}.{alias.name}" for alias in node.names)]
        elif isinstance(node, ast.Import):
            names += [alias.name for alias in node.names]
    ours = (name.split(".") for name in names if name.split(".")[0] == _PACKAGE.name)
    with_packages = (".".join(parts[:n]) for parts in ours for n in range(1, len(parts) + 1))
    return tuple(path for name in with_packages if (path := _path_of(name)).is_file())


def _path_of(module: str) -> Path:
    below = _PACKAGE.joinpath(*module.split(".")[1:])
    return below / "__init__.py" if below.is_dir() else below.with_suffix(".py")

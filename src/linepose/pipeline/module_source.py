"""What counts of one Python file for the numbers it computes, and which other modules it names.

Left out are comments, blank lines, docstrings and other strings that stand alone, and the annotations of functions
without decorators and of variables inside functions. Read from a cache, by content, where the file was read before.
"""

import ast
import hashlib
import json
import re
import sys
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Final

from linepose.tables import atomic_write

_NAME: Final = re.compile(r"linepose(\.\w+)+(:\w+)?")
_WITHOUT_EFFECT: Final = {"type_comment", "kind", "type_ignores"}
_FUNCTION: Final = (ast.FunctionDef, ast.AsyncFunctionDef)
_NOTHING: Final = ast.Constant(None)


@dataclass(frozen=True)
class ModuleSource:
    """Digest of what counts of a file, modules it may import ("linepose.errors", ".beside"), and names in strings."""

    digest: str
    imports: tuple[str, ...]
    strings: tuple[str, ...]


class SourceCache:
    """What counts of Python files, kept by the files' content in a file of a folder; if it cannot be, parsed anew."""

    def __init__(self, folder: Path) -> None:
        version = hashlib.sha256(Path(__file__).read_bytes()).hexdigest()[:8]
        self._file = folder / f"module_sources-{sys.implementation.cache_tag}-{version}.json"
        self._known = _read_json(self._file)
        self._used: dict[str, Any] = {}
        self._has_new = False

    def read(self, path: Path) -> ModuleSource:
        """What counts of a file."""
        content = path.read_bytes()
        key = hashlib.sha256(content).hexdigest()
        if key not in self._known:
            self._known[key] = asdict(source_of(content))
            self._has_new = True
        self._used[key] = self._known[key]
        found = self._known[key]
        return ModuleSource(found["digest"], tuple(found["imports"]), tuple(found["strings"]))

    def save(self) -> None:
        """Keep what was read, if there is anything new."""
        if not self._has_new:
            return
        self._has_new = False
        try:
            with atomic_write(self._file) as temporary:
                temporary.write_text(json.dumps(_read_json(self._file) | self._used), encoding="utf-8")
        except OSError:
            return


def source_of(content: bytes) -> ModuleSource:
    """What counts of a file's content."""
    tree = ast.parse(content)
    imports = dict.fromkeys(name for node in ast.walk(tree) for name in _imported(node))
    strings = dict.fromkeys(
        node.value
        for node in ast.walk(tree)
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and _NAME.fullmatch(node.value)
    )
    parts: list[str] = []
    _collect(tree, parts, False)
    text = "\0".join(parts)
    return ModuleSource(hashlib.sha256(text.encode()).hexdigest()[:16], tuple(imports), tuple(strings))


def _imported(node: ast.AST) -> list[str]:
    if isinstance(node, ast.ImportFrom):
        module = "." * node.level + (node.module or "")
        return [module, *(f"{module.rstrip('.')}.{alias.name}" for alias in node.names if node.module)]
    if isinstance(node, ast.Import):
        return [alias.name for alias in node.names]
    return []


def _collect(node: ast.AST, parts: list[str], in_function: bool) -> None:
    """Append the names and constants of a syntax tree in order; in a function, variables have no annotations."""
    parts.append(type(node).__name__)
    if isinstance(node, _FUNCTION) and not node.decorator_list:
        _drop_annotations(node)
    elif isinstance(node, ast.AnnAssign) and in_function:
        parts.append(repr(node.value is None))  # a name that is only declared
        node.annotation = _NOTHING
    in_function = (in_function or isinstance(node, _FUNCTION)) and not isinstance(node, ast.ClassDef)
    for name in node._fields:
        value = getattr(node, name, None)
        if value is None or value == [] or name in _WITHOUT_EFFECT:
            continue  # also what only newer versions of Python have
        parts.append(name)
        for part in value if isinstance(value, list) else [value]:
            if not isinstance(part, ast.AST):
                parts.append(repr(part))
            elif not _stands_alone(part):
                _collect(part, parts, in_function)
        parts.append(";")


def _drop_annotations(function: ast.FunctionDef | ast.AsyncFunctionDef) -> None:
    function.returns = None
    for node in ast.walk(function.args):
        if isinstance(node, ast.arg):
            node.annotation = None


def _stands_alone(node: ast.AST) -> bool:
    """Whether this is a docstring, or a string that is no more than that."""
    return isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str)


def _read_json(path: Path) -> dict[str, Any]:
    try:
        return dict(json.loads(path.read_text(encoding="utf-8")))
    except (OSError, ValueError):
        return {}

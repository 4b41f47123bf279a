"""The library's rooms, ground first: each imports only from those before it, and no module stands loose."""

import ast
from pathlib import Path

import linepose

PACKAGE = Path(linepose.__file__).parent
LOOSE = ("errors", "arrays", "tables", "plugins", "settings")
ROOMS = (
    *LOOSE,
    "compiling",
    "geometry",
    "survey",
    "simulation",
    "likelihood",
    "adjustment",
    "estimation",
    "inputs",
    "config",
    "pipeline",
    "experiments",
    "check",
    "output",
    "cli",
    "paper",
)


def imported(path):
    """The rooms that a file imports from, wherever in the file it does, with the lines."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.level == 0 and node.module == "linepose":
            yield from ((name.name, node.lineno) for name in node.names)
        elif isinstance(node, ast.ImportFrom) and node.level == 0 and (node.module or "").startswith("linepose."):
            yield node.module.split(".")[1], node.lineno
        elif isinstance(node, ast.Import):
            yield from ((n.name.split(".")[1], node.lineno) for n in node.names if n.name.startswith("linepose."))
        elif isinstance(node, ast.Call) and ast.unparse(node.func).split(".")[-1] in ("import_module", "__import__"):
            texts = (
                one.value for one in ast.walk(node) if isinstance(one, ast.Constant) and isinstance(one.value, str)
            )
            yield from ((text.split(".")[1], node.lineno) for text in texts if text.startswith("linepose."))


def against_the_order(package):
    """Imports of a room that comes later, as `file:line: what is imported`."""
    found = []
    for path in sorted(package.rglob("*.py")):
        room = path.relative_to(package).parts[0].removesuffix(".py")
        if room == "__init__":
            continue
        allowed = ROOMS[: ROOMS.index(room) + 1]
        found += [
            f"{path.relative_to(package)}:{line}: {other}"
            for other, line in imported(path)
            if other in ROOMS and other not in allowed
        ]
    return found


def test_rooms_import_only_from_those_before_them():
    assert against_the_order(PACKAGE) == []


def test_no_module_stands_loose_and_every_room_is_listed():
    files = {path.stem for path in PACKAGE.glob("*.py")} - {"__init__"}
    assert files == set(LOOSE)
    folders = {path.name for path in PACKAGE.iterdir() if path.is_dir() and any(path.glob("*.py"))}
    assert folders == set(ROOMS) - set(LOOSE)


def test_an_import_from_a_later_room_is_found(tmp_path):
    (tmp_path / "survey").mkdir()
    (tmp_path / "survey" / "points.py").write_text(
        "from linepose.geometry.pose import x\n\n\n"
        "def f(name):\n    from linepose.config import study\n    import linepose.cli.app\n"
        "    importlib.import_module('linepose.geometry.pose')\n"
        "    importlib.import_module('linepose.output.exports')\n"
        "    import_module(f'linepose.paper.{name}')\n"
        "    __import__('linepose.check.clock')\n"
    )
    found = ["5: config", "6: cli", "8: output", "9: paper", "10: check"]
    assert against_the_order(tmp_path) == [f"survey/points.py:{one}" for one in found]

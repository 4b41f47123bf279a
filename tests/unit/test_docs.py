"""The documentation is true: its examples run, and the commands, files and modules that it names exist."""

import importlib.util
import re
import runpy
import shlex
from functools import cache
from pathlib import Path

import pytest
import typer
from typer.testing import CliRunner

from linepose.cli.app import app
from unit.test_rooms import ROOMS

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", ROOT / "config" / "README.md", *sorted(DOCS.glob("*.md"))]
PAGES = [page for page in PAGES if page.exists()]
BLOCK = re.compile(r"^```python\n(.*?)^```$", re.MULTILINE | re.DOTALL)
CODE = re.compile(r"^```\w*\n(.*?)^```$|^    (\S[^\n]*)$|`([^`\n]+)`", re.MULTILINE | re.DOTALL)
FOLDERS = "src|docs|config|workflow|scripts|benchmarks|tests|profiles|\\.github|\\.ci"
NOT_MODULES = {"linepose.navigation_formats"}  # an entry point group


def code_of(page: Path) -> list[str]:
    """What a page sets as code: rows of its blocks, and code within sentences."""
    return [
        row.split("#")[0].strip() for match in CODE.findall(page.read_text()) for row in "".join(match).splitlines()
    ]


def commands_of(page: Path, program: str) -> list[list[str]]:
    """The words of each command of a program."""
    rows = [row for row in code_of(page) if row.startswith(f"{program} ")]
    return [shlex.split(row.split(" && ")[0], posix=False) for row in rows]


@cache
def options() -> dict[str, set[str]]:
    """The options that each command of `linepose` has."""
    group = typer.main.get_command(app)
    of_commands = {name: {o for p in command.params for o in p.opts} for name, command in group.commands.items()}
    return of_commands | {"": {o for p in group.params for o in p.opts} | {"--help"}}


EXTENDING = DOCS / "extending.md"  # names what a reader adds; tests/unit/test_extending.py adds it
OTHER_PAGES = [page for page in PAGES if page != EXTENDING]
every_page = pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
every_other_page = pytest.mark.parametrize("page", OTHER_PAGES, ids=lambda page: str(page.relative_to(ROOT)))


@pytest.mark.parametrize("page", ["conventions.md", "without-a-board.md"])
def test_python_examples_run(page):
    """In one namespace, one after the other; a page without an example would say nothing."""
    blocks = BLOCK.findall((DOCS / page).read_text())
    assert blocks
    namespace: dict[str, object] = {}
    for block in blocks:
        exec(compile(block, page, "exec"), namespace)


@every_page
def test_links_and_pictures_exist(page):
    for target in re.findall(r"\]\(([^)#:]+)(?:#[^)]*)?\)", page.read_text()):
        assert (page.parent / target).exists(), target


@every_page
def test_commands_of_linepose_and_their_options_exist(page):
    for words in commands_of(page, "linepose"):
        command = words[1] if re.fullmatch("[a-z]+", words[1]) else ""
        if command != "COMMAND" and words[1] != "COMMAND":
            assert command in options(), words
            asked = {word.split("=")[0] for word in words[1:] if re.match("--?[a-z]", word)}
            assert asked <= options()[command] | {"--help"}, words


def test_commands_of_the_page_on_targets_run(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r"^```bash\n(.*?)^```$", (DOCS / "targets.md").read_text(), re.MULTILINE | re.DOTALL)
    rows = [row for block in blocks for row in block.splitlines()]
    assert len(rows) == 6
    for row in rows:
        ran = CliRunner().invoke(app, shlex.split(row)[1:])
        assert ran.exit_code == 0, ran.output
    assert {path.stem for path in tmp_path.glob("*.pdf")} == {"board", "rings", "chessboard", "again"}
    assert "kind: chessboard" in (tmp_path / "config" / "platforms" / "myrobot.yaml").read_text()


@every_page
def test_targets_of_make_exist(page):
    makefile = (ROOT / "Makefile").read_text()
    for words in commands_of(page, "make"):
        target = words[1]
        assert re.search(rf"^{re.escape(target)}:", makefile, re.MULTILINE) or f":= {target}\n" in makefile, words


@every_page
def test_targets_of_snakemake_are_rules(page):
    rules = "".join(file.read_text() for file in (ROOT / "workflow" / "rules").glob("*.smk"))
    for words in commands_of(page, "snakemake"):
        for target in (word for word in words[1:] if re.fullmatch("[a-z_]+", word)):
            assert f"rule {target}:" in rules, words


@every_other_page
def test_files_named_exist(page):
    named = re.findall(
        rf"(?:^|[\s(`])((?:{FOLDERS})/[\w./-]*\w)(?=[`\s,.:;)]|$)", "\n".join(code_of(page)), re.MULTILINE
    )
    placeholders = re.compile(r"[A-Z]{3,}|myrobot")
    missing = [name for name in named if not placeholders.search(name) and not (ROOT / name).exists()]
    assert missing == []


@every_other_page
def test_modules_named_can_be_imported(page):
    for name in set(re.findall(r"\blinepose(?:\.[A-Za-z_]+)+", "\n".join(code_of(page)))) - NOT_MODULES:
        parts = name.split(".")
        found: object = importlib.import_module("linepose")
        for depth, part in enumerate(parts[1:], start=2):
            try:
                found = getattr(found, part)
            except AttributeError:
                found = importlib.import_module(".".join(parts[:depth]))


@every_page
def test_scripts_of_python_exist(page):
    for words in commands_of(page, "python"):
        if words[1] == "-m":
            assert importlib.util.find_spec(words[2]), words
        else:
            assert (ROOT / words[1]).is_file(), words


def test_every_public_page_is_on_the_site():
    index = (DOCS / "index.md").read_text()
    for page in DOCS.glob("*.md"):
        assert page.stem == "index" or re.search(rf"^{page.stem}$", index, re.MULTILINE), page.name


def test_rooms_stand_in_the_order_in_which_they_may_import():
    cells = re.findall(r"^\| (`.*?`) \|", (DOCS / "architecture.md").read_text(), re.MULTILINE)
    assert tuple(re.sub(r"\.py|/", "", name) for name in re.findall(r"`(.*?)`", " ".join(cells))) == ROOMS


def test_readme_fits_two_screens():
    assert len((ROOT / "README.md").read_text().splitlines()) <= 95


def test_readme_has_rows_of_what_the_bench_printed():
    block = re.compile(r"<!-- make bench -->\n```text\n(.*?)```\n<!-- end of make bench -->", re.DOTALL)
    (printed,) = block.findall((DOCS / "benchmarks.md").read_text())
    (kept,) = block.findall((ROOT / "README.md").read_text())
    rows = runpy.run_path(str(ROOT / "benchmarks" / "into_readme.py"))["rows_for_readme"](printed.splitlines())
    assert kept.splitlines() == rows
    assert len(rows) == 5


def test_makefile_helps_with_every_target():
    makefile = (ROOT / "Makefile").read_text()
    targets = re.search(r"^\.PHONY: (.*)$", makefile, re.MULTILINE).group(1).split()
    assert targets == re.findall(r"^([a-z-]+):.*## \S", makefile, re.MULTILINE)

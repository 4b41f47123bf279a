"""Every command of docs/your-platform.md, in the page's order, as a user of the wheel gives them in an empty folder."""

import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest
from installed_wheel import environment, program
from tiny_project import ROOT

from linepose.config.platform import load_platform

sys.path.insert(0, str(ROOT / "tests" / "unit"))
from recorded_files import write_platform_files

pytestmark = pytest.mark.workflow
BLOCK = re.compile(r"^```sh\n(.*?)^```$", re.MULTILINE | re.DOTALL)
SHORT = "outliers: {minimum_observations: 7}\nsampling: {n_walkers: 24, n_burn_in: 40, n_steps: 60}\n"


def test_commands_of_the_page_in_order(installed, tmp_path):
    page = (ROOT / "docs" / "your-platform.md").read_text()
    commands = [line for block in BLOCK.findall(page) for line in block.splitlines()]
    assert [command.split()[1] for command in commands] == ["new", "check", "run", "show", "export", "export"]
    told = {}
    for command in commands:
        told[command.split()[1]] = as_a_user(command, tmp_path, installed)
        if " new " in command:
            write_platform_files(
                tmp_path / "data" / "myrobot", load_platform(ROOT / "config" / "platforms", "ladybird-sim"), 8
            )
            platform = tmp_path / "config" / "platforms" / "myrobot.yaml"
            text = platform.read_text().replace("{n_splits: 20}", "null")
            platform.write_text(text + "  mapping: null\n")
            config = tmp_path / "config" / "config.yaml"
            config.write_text(config.read_text() + SHORT)
    assert "linepose check myrobot" in told["new"]
    assert "`linepose run myrobot` can start" in told["check"]
    assert "Use this pose" in told["show"] or "Do not use this pose" in told["show"]
    assert (tmp_path / "results" / "myrobot" / "report.html").is_file()
    assert (tmp_path / "results" / "myrobot" / "exports" / "myrobot.urdf").is_file()
    assert (tmp_path / "myrobot.json").is_file()


def as_a_user(command: str, folder: Path, installed: Path) -> str:
    """What a command of the page prints; it must end well."""
    first, *arguments = shlex.split(command)
    assert first == "linepose"
    done = subprocess.run(
        [program(installed, "linepose"), *arguments],
        cwd=folder,
        env=environment(),
        capture_output=True,
        text=True,
        timeout=900,
        check=False,
    )
    assert done.returncode == 0, f"{command}\n{done.stdout}\n{done.stderr}"
    return done.stdout

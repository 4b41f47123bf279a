"""Two platforms of one project, run one after the other: the first's results and page stay as they were."""

import hashlib
import os
import subprocess
import sys
from pathlib import Path

import pytest
from tiny_project import QUICK, STUDY, TINY


def linepose(folder: Path, *arguments: str) -> str:
    """What a command prints; it must end well."""
    command = [Path(sys.executable).with_name("linepose"), *arguments]
    path = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
    environment = os.environ | {"PATH": path}
    ended = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)
    assert ended.returncode == 0, ended.stderr
    return ended.stdout


def digests(folder: Path) -> dict[str, str]:
    """Of every file of a platform's results, by its path."""
    files = (path for path in folder.rglob("*") if path.is_file())
    return {str(path): hashlib.sha256(path.read_bytes()).hexdigest() for path in sorted(files)}


@pytest.mark.workflow
def test_each_platform_keeps_its_page_and_its_numbers(copied):
    folder, results = copied.folder, copied.folder / "results"
    copied.configure(STUDY | {"platforms": ["tiny", "second"]}, {"tiny": TINY, "second": QUICK})
    before, shown = digests(results / "tiny"), linepose(folder, "show", "tiny")
    linepose(folder, "run", "second", "--cores", "2")
    assert digests(results / "tiny") == before
    assert linepose(folder, "show", "tiny") == shown
    assert str(results / "tiny" / "report.html") in shown
    assert "Camera calibration of tiny" in (results / "tiny" / "report.html").read_text()
    assert "second" not in (results / "tiny" / "report.html").read_text()
    study = (results / "report.html").read_text()
    assert all(f'href="{name}/report.html"' in study for name in ("tiny", "second"))

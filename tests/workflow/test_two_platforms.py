"""Two platforms of one project, run one after the other: the first's results and page stay as they were.

The second is the first again, run on one core where the first was on two: its tables are the same to the last bit.
"""

import hashlib
import os
import subprocess
import sys
from pathlib import Path

import pyarrow as pa
import pytest
from pyarrow import parquet
from tiny_project import STUDY, TINY


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


def same_bits(table: pa.Table) -> bytes:
    """A table's columns as bytes, without what it says of the settings and files that made it."""
    sink = pa.BufferOutputStream()
    with pa.ipc.new_stream(sink, table.schema.remove_metadata()) as stream:
        stream.write_table(table.replace_schema_metadata(None).combine_chunks())
    return sink.getvalue().to_pybytes()


@pytest.mark.workflow
def test_each_platform_keeps_its_page_and_its_numbers(copied):
    folder, results = copied.folder, copied.folder / "results"
    copied.configure(STUDY | {"platforms": ["tiny", "sec*"]}, {"tiny": TINY, "second": TINY})
    before, shown = digests(results / "tiny"), linepose(folder, "show", "tiny")
    linepose(folder, "run", "second", "--cores", "1")
    assert "done: 2 platforms" in linepose(folder, "run", "--all", "--cores", "1")  # and nothing of the first again
    assert digests(results / "tiny") == before
    assert linepose(folder, "show", "tiny") == shown
    assert str(results / "tiny" / "report.html") in shown
    assert "Camera calibration of tiny" in (results / "tiny" / "report.html").read_text()
    assert "second" not in (results / "tiny" / "report.html").read_text()
    study = (results / "report.html").read_text()
    assert all(f'href="{name}/report.html"' in study for name in ("tiny", "second"))
    assert "2 platforms, those that need a look first" in study
    paths = sorted(path.relative_to(results / "tiny") for path in (results / "tiny").rglob("*.parquet"))
    assert paths == sorted(path.relative_to(results / "second") for path in (results / "second").rglob("*.parquet"))
    for path in (path for path in paths if path.parts[0] != "figures"):  # whose captions name the platform
        ours, theirs = (parquet.read_table(results / name / path) for name in ("tiny", "second"))
        assert same_bits(ours) == same_bits(theirs), path

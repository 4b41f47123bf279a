"""A job compares its node with the machine that planned, and says in one line what differs."""

import json
import os
import time

import pytest

from linepose.errors import InputError
from linepose.pipeline.cluster import node
from linepose.pipeline.cluster.node import HEAD, check_node, check_room, hand_over


@pytest.fixture
def root(tmp_path, monkeypatch):
    """A project's folder whose planning process has handed over."""
    monkeypatch.setenv(HEAD, "")
    monkeypatch.setenv("SLURMD_NODENAME", "n7")
    hand_over(tmp_path)
    return tmp_path


def told(root):
    with pytest.raises(InputError) as error:
        check_node(root)
    assert str(error.value).startswith("node n7: found ")
    return str(error.value)


def test_a_node_like_the_head_is_fit(root):
    check_node(root)


def test_without_a_head_there_is_nothing_to_compare_with(tmp_path, monkeypatch):
    monkeypatch.delenv(HEAD, raising=False)
    check_node(tmp_path)


def test_another_version_is_refused_and_both_are_named(root, monkeypatch):
    head = json.loads(os.environ[HEAD])
    monkeypatch.setattr(node, "version", lambda name: "0.0.7")
    assert f"found linepose 0.0.7, expected linepose {head['version']} as on {head['host']}" in told(root)


@pytest.mark.parametrize("there", [None, "of another folder"])
def test_a_folder_that_is_not_shared_is_refused(root, there):
    token = root / node._TOKEN
    token.unlink()
    if there is not None:
        token.write_text(there)
    assert "expected one folder that all nodes share" in told(root)


def test_a_clock_behind_that_of_the_head_is_refused(root, monkeypatch):
    monkeypatch.setenv(HEAD, json.dumps(json.loads(os.environ[HEAD]) | {"time_s": time.time() + 100.0}))
    assert "found a clock 100 s behind the clock of " in told(root)


def test_a_clock_before_that_of_the_file_system_is_refused(root, monkeypatch):
    now = time.time()
    monkeypatch.setattr(node.time, "time", lambda: now + 60.0)
    assert "found a clock 60 s before that of the file system" in told(root)


def test_a_full_folder_is_refused_before_a_run_and_on_the_node(root, monkeypatch):
    usage = node.shutil.disk_usage(root)
    monkeypatch.setattr(node.shutil, "disk_usage", lambda folder: usage._replace(free=3_000_000))
    assert "found 3 MB free in" in told(root)
    with pytest.raises(InputError, match="expected at least 200 MB"):
        hand_over(root)


def test_room_is_looked_for_among_temporary_files_too(tmp_path, monkeypatch):
    scratch = tmp_path / "scratch"
    scratch.mkdir()
    usage = node.shutil.disk_usage
    monkeypatch.setenv("TMPDIR", str(scratch))
    monkeypatch.setattr(node.tempfile, "gettempdir", lambda: str(tmp_path))  # as Python passes over a full one
    full = usage(tmp_path)._replace(free=0)
    monkeypatch.setattr(node.shutil, "disk_usage", lambda folder: full if folder == scratch else usage(folder))
    with pytest.raises(InputError, match=r"0 MB free in .*scratch"):
        check_room(tmp_path, "here")

"""Batches: the same result in any number of processes and after any interruption."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pandas as pd
import pyarrow as pa
import pytest

from linepose.errors import InputError
from linepose.pipeline import batches
from linepose.pipeline.batches import batch_ranges, inputs_digest, remove_finished, run_batches, share_of
from linepose.tables import write_table

SCHEMA = pa.schema([pa.field("batch", pa.string(), nullable=False), pa.field("value", pa.float64(), nullable=False)])
NAMES = [f"b{k}" for k in range(6)]


def table(name: str) -> pd.DataFrame:
    return pd.DataFrame({"batch": [name, name], "value": [len(name) / 3, int(name[1:]) / 7]})


@pytest.mark.parametrize("n_processes", [1, 2, 9])
def test_all_batches_in_the_given_order(tmp_path, n_processes):
    found = run_batches(table, NAMES, tmp_path, SCHEMA, n_processes)
    assert found.equals(pd.concat([table(name) for name in NAMES], ignore_index=True))
    assert sorted(path.name for path in tmp_path.iterdir()) == [f"{name}.parquet" for name in NAMES]


def test_same_batches_where_processes_cannot_be_forked(tmp_path, monkeypatch):
    forked = run_batches(table, NAMES, tmp_path / "forked", SCHEMA, 2)
    monkeypatch.setattr(batches, "FORKS", False)
    monkeypatch.setattr(batches, "ProcessPoolExecutor", None)
    assert run_batches(table, NAMES, tmp_path / "alone", SCHEMA, 2).equals(forked)


def test_finished_batches_are_not_made_again(tmp_path):
    run_batches(table, NAMES[:4], tmp_path, SCHEMA, 2)

    def only_the_rest(name: str) -> pd.DataFrame:
        assert name in NAMES[4:]
        return table(name)

    found = run_batches(only_the_rest, NAMES, tmp_path, SCHEMA, 2)
    assert found.equals(pd.concat([table(name) for name in NAMES], ignore_index=True))


def test_fault_in_a_batch_is_told_and_finished_batches_stay(tmp_path):
    def fails(name: str) -> pd.DataFrame:
        if name == "b3":
            raise InputError("here", "that", "this", "change it")
        return table(name)

    with pytest.raises(InputError, match="here: found that"):
        run_batches(fails, NAMES, tmp_path, SCHEMA, 1)
    assert (tmp_path / "b0.parquet").is_file()
    assert not (tmp_path / "b3.parquet").exists()


SLOW = """
import sys, time
from pathlib import Path
import pandas as pd, pyarrow as pa
from linepose.pipeline.batches import run_batches
SCHEMA = pa.schema([pa.field("value", pa.float64(), nullable=False)])
def task(name):
    time.sleep(0.3)
    return pd.DataFrame({"value": [float(name)]})
print(run_batches(task, [str(k) for k in range(12)], Path(sys.argv[1]), SCHEMA, 2).to_csv())
"""


@pytest.mark.skipif(not Path("/proc/self/task").is_dir(), reason="looks for processes in /proc")
def test_killed_run_leaves_no_process_behind_and_goes_on_where_it_was(tmp_path):
    killed = subprocess.Popen([sys.executable, "-c", SLOW, tmp_path / "killed"], stdout=subprocess.DEVNULL)
    while len(list((tmp_path / "killed").glob("*.parquet"))) < 3:
        time.sleep(0.05)
    children = [int(p) for p in Path(f"/proc/{killed.pid}/task/{killed.pid}/children").read_text().split()]
    os.kill(killed.pid, signal.SIGKILL)
    killed.wait()
    assert children
    deadline = time.monotonic() + 30
    while any(Path(f"/proc/{child}/cmdline").exists() for child in children):
        assert time.monotonic() < deadline, "a child outlived its killed parent"
        time.sleep(0.1)
    done = {path.name: path.stat().st_mtime_ns for path in (tmp_path / "killed").glob("[0-9]*.parquet")}
    assert 3 <= len(done) < 12
    outputs = [
        subprocess.run([sys.executable, "-c", SLOW, tmp_path / name], capture_output=True, check=True).stdout
        for name in ("killed", "whole")
    ]
    assert outputs[0] == outputs[1]
    for name, modified in done.items():
        assert (tmp_path / "killed" / name).stat().st_mtime_ns == modified
    for path in (tmp_path / "whole").iterdir():
        assert (tmp_path / "killed" / path.name).read_bytes() == path.read_bytes()


@pytest.mark.parametrize("size", [1, 7, 30, 100])
def test_ranges_cover_all_once_in_the_order_of_their_names(size):
    ranges = batch_ranges(30, size)
    assert [cell for cells in ranges.values() for cell in cells] == list(range(30))
    assert list(ranges) == sorted(ranges)
    assert all(len(cells) <= size for cells in ranges.values())


@pytest.mark.parametrize(("count", "parts"), [(200, 4), (7, 3), (2, 4), (1, 1)])
def test_shares_cover_all_once_and_are_alike_in_size(count, parts):
    shares = [share_of(count, f"{part}-of-{parts}") for part in range(1, parts + 1)]
    assert [number for share in shares for number in share] == list(range(count))
    assert max(map(len, shares)) - min(map(len, shares)) <= 1


def test_no_batch_is_an_empty_table(tmp_path):
    found = run_batches(lambda name: pd.DataFrame(), [], tmp_path, SCHEMA, 1)
    assert found.empty
    write_table(found, tmp_path / "empty.parquet", SCHEMA)


def test_digest_tells_settings_and_contents_apart(tmp_path):
    (tmp_path / "mcmc").mkdir()
    (tmp_path / "mcmc" / "a.parquet").write_bytes(b"1")
    (tmp_path / "b").write_bytes(b"2")
    files = [tmp_path / "mcmc", tmp_path / "b"]
    first = inputs_digest({"seed": 1, "grid": {"n": 3}}, files)
    assert inputs_digest({"grid": {"n": 3}, "seed": 1}, files) == first
    assert inputs_digest({"seed": 2, "grid": {"n": 3}}, files) != first
    (tmp_path / "mcmc" / "a.parquet").write_bytes(b"3")
    assert inputs_digest({"seed": 1, "grid": {"n": 3}}, files) != first


def test_finished_and_outdated_work_is_removed(tmp_path):
    for kind, digest in (("basin", "new"), ("basin", "old"), ("splits", "new")):
        run_batches(table, NAMES[:1], tmp_path / "work" / kind / digest, SCHEMA, 1)
    remove_finished(tmp_path / "work" / "basin" / "new")
    assert [path.name for path in (tmp_path / "work").iterdir()] == ["splits"]
    remove_finished(tmp_path / "work" / "splits" / "new")
    assert list(tmp_path.iterdir()) == []

"""One run at a time: the lock ends with its process, and a new run waits for the jobs of a killed one."""

import os
import subprocess
import sys
import time

import pytest

from linepose.errors import InputError
from linepose.pipeline import run_lock
from linepose.pipeline.run_lock import check_no_run, hold_run_lock

HOLD = (
    "import sys, time; from pathlib import Path; from linepose.pipeline.run_lock import {0}; {0}(Path(sys.argv[1])); "
)
WAIT = "print('held', flush=True); time.sleep(60)"


@pytest.fixture
def other(tmp_path):
    """Starts another process that holds a lock of the folder."""
    started = []

    def start(name):
        process = subprocess.Popen(
            [sys.executable, "-c", HOLD.format(name) + WAIT, tmp_path], stdout=subprocess.PIPE, text=True
        )
        started.append(process)
        assert process.stdout.readline() == "held\n"
        return process

    yield start
    for process in started:
        process.kill()
        process.wait()


@pytest.fixture(autouse=True)
def released():
    yield
    for descriptor in run_lock._held:
        os.close(descriptor)
    run_lock._held.clear()


def test_second_run_is_told_of_the_first_until_that_is_killed(tmp_path, other):
    first = other("hold_run_lock")
    for begin in (hold_run_lock, check_no_run):
        with pytest.raises(InputError, match=rf"another run at work here \(process {first.pid}\)"):
            begin(tmp_path)
    first.kill()
    first.wait()
    check_no_run(tmp_path)
    hold_run_lock(tmp_path)


def test_jobs_share_their_lock_and_a_run_waits_for_the_last(tmp_path, other, monkeypatch):
    jobs = [other("hold_job_lock"), other("hold_job_lock")]
    monkeypatch.setattr(run_lock, "_PATIENCE_S", 0.3)
    with pytest.raises(InputError, match="jobs of a killed run"):
        hold_run_lock(tmp_path)
    released_held = list(run_lock._held)
    for descriptor in released_held:
        os.close(descriptor)
    run_lock._held.clear()
    for job in jobs:
        job.kill()
        job.wait()
    begun = time.monotonic()
    hold_run_lock(tmp_path)
    assert time.monotonic() - begun < 10


def test_folder_in_which_nothing_ran_is_left_as_it_is(tmp_path):
    check_no_run(tmp_path)
    assert list(tmp_path.iterdir()) == []

"""One run at a time in a project's folder: a lock that the system takes back when the process that holds it ends.

A run holds one lock, and each of its jobs shares another, so that a run begins only when also the last job of a killed
one has ended. Where the file system has no locks, none is held.
"""

import contextlib
import fcntl
import os
import time
from pathlib import Path
from typing import Final

from linepose.errors import InputError

_FOLDER: Final = ".snakemake"
_RUN: Final = "linepose-run.lock"
_JOBS: Final = "linepose-jobs.lock"
_PATIENCE_S: Final = 30.0
_held: list[int] = []  # descriptors, kept open until the process ends


def hold_run_lock(root: Path) -> None:
    """Hold the folder's lock until this process ends; raises InputError where another run is at work."""
    run = _open(root, _RUN)
    if run is None:
        return
    if not _locked(run, fcntl.LOCK_EX):
        raise _busy(root, run)
    os.ftruncate(run, 0)
    os.write(run, str(os.getpid()).encode())
    _held.append(run)
    jobs = _open(root, _JOBS)
    if jobs is not None:
        _wait_for_jobs(root, jobs)


def hold_job_lock(root: Path) -> None:
    """Share the lock of the folder's jobs until this process and those that it forks have ended."""
    jobs = _open(root, _JOBS)
    if jobs is not None and _locked(jobs, fcntl.LOCK_SH):
        _held.append(jobs)


def check_no_run(root: Path) -> None:
    """Raises InputError where another run is at work in the folder."""
    run = _open(root, _RUN) if (root / _FOLDER / _RUN).is_file() else None
    if run is None:
        return
    try:
        if not _locked(run, fcntl.LOCK_EX):
            raise _busy(root, run)
    finally:
        os.close(run)


def _wait_for_jobs(root: Path, jobs: int) -> None:
    deadline = time.monotonic() + _PATIENCE_S
    while not _locked(jobs, fcntl.LOCK_EX):
        if time.monotonic() > deadline:
            found = "jobs of a killed run still at work"
            raise InputError(str(root.resolve()), found, "one run at a time", "wait for them, or end them")
        time.sleep(0.1)
    os.close(jobs)


def _busy(root: Path, run: int) -> InputError:
    process = os.pread(run, 20, 0).decode() or "just begun"
    found = f"another run at work here (process {process})"
    return InputError(str(root.resolve()), found, "one run at a time", "wait for it, or end it")


def _open(root: Path, name: str) -> int | None:
    with contextlib.suppress(OSError):
        (root / _FOLDER).mkdir(exist_ok=True)
        return os.open(root / _FOLDER / name, os.O_RDWR | os.O_CREAT, 0o644)
    return None


def _locked(descriptor: int, kind: int) -> bool:
    """Whether the lock is had; also where the file system has none."""
    try:
        fcntl.flock(descriptor, kind | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:
        return True
    return True

"""What a command costs with all that it starts, also what outlives its parent, as the fork server of a run does."""

import ctypes
import os
import resource
import subprocess
import sys
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

_PR_SET_CHILD_SUBREAPER = 36  # of linux/prctl.h: orphans become children of this process


@dataclass(frozen=True)
class Cost:
    """What a command cost: seconds by the clock, seconds of processor time, MB of the process itself at its peak."""

    wall_s: float
    processor_s: float
    peak_mb: float


def measured(command: Sequence[str], folder: Path, log: Path, environment: Mapping[str, str] | None = None) -> Cost:
    """Run a command in a folder, its messages in a file; what it cost. Ends the benchmark where it fails."""
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(_PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    begun = time.perf_counter()
    with log.open("w") as file:
        process = subprocess.Popen(command, cwd=folder, env=os.environ | (environment or {}), stdout=file, stderr=file)
        _, status, used = os.wait4(process.pid, 0)
    wall_s = time.perf_counter() - begun
    if status:
        sys.exit(log.read_text())
    _wait_for_orphans()
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    processor_s = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return Cost(wall_s, processor_s, used.ru_maxrss / 1024)


def _wait_for_orphans() -> None:
    try:
        while True:
            os.wait()
    except ChildProcessError:
        return

"""The machine that the benchmarks run on, in one line: `python benchmarks/machine.py`."""

import os
import platform
import re
from datetime import UTC, datetime
from pathlib import Path

import numba
import numpy as np


def processor() -> str:
    """The processor's name as the system tells it."""
    information = Path("/proc/cpuinfo")
    found = re.search(r"model name\s*:\s*(.+)", information.read_text()) if information.is_file() else None
    return found.group(1).strip() if found else platform.processor() or platform.machine()


def main() -> None:
    """Print the line."""
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    versions = f"Python {platform.python_version()}, numba {numba.__version__}, numpy {np.__version__}"
    print(f"{processor()}, {cores} cores, {platform.system()}, {versions}, {datetime.now(UTC):%Y-%m-%d}")


if __name__ == "__main__":
    main()

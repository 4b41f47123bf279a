"""The tiny project and a coverage cell on SLURM and locally: the same bytes. `make slurm-test`.

`PYTHONPATH=tests/workflow python tests/slurm --faults` makes the faults alone.
"""

import os
import sys
import tempfile
from pathlib import Path

import cluster
from faults import faults
from project import (
    BY_COMMAND,
    LINEPOSE,
    LOCAL,
    NOT_COMPARED,
    REAL_CELL,
    SLURM,
    TINY_ALONE,
    differences,
    results,
    run,
    tiny,
)

SLOWER_AT_MOST = 1.3  # coverage cell, on SLURM against locally
N_SURVEYS = int(os.environ.get("N_SURVEYS", "200"))  # of the coverage cell


def main() -> None:
    """Run all; prints a line for each thing that holds, ends with one for the first that does not."""
    cluster.install()
    with tempfile.TemporaryDirectory(prefix="slurm-test-") as name:
        folder = Path(name)
        with cluster.running(folder):
            if "--faults" not in sys.argv:
                same_bytes(folder)
            for line in faults(folder):
                tell(line)


def same_bytes(folder: Path) -> None:
    """The whole project in three folders, once by `linepose run`; then a coverage cell alone, which is timed."""
    local, slurm = tiny(folder / "local", N_SURVEYS), tiny(folder / "slurm", N_SURVEYS)
    whole = [run(local, *LOCAL, *TINY_ALONE), run(slurm, *SLURM, *TINY_ALONE)]
    command = tiny(folder / "command", N_SURVEYS)
    by_command = run(command, *BY_COMMAND, program=LINEPOSE)
    if unlike := differences(local, command, of="tiny"):
        sys.exit(f"slurm-test: found other bytes in {', '.join(unlike)} by `linepose run`, expected the local run's")
    tell(f"`linepose run tiny --profile slurm`: the same bytes in {by_command:.0f} s")
    cell = [run(local, *LOCAL, REAL_CELL), run(slurm, *SLURM, REAL_CELL)]
    run(local, *LOCAL, "coverage")
    run(slurm, *SLURM, "coverage")
    unlike = differences(local, slurm)
    if unlike:
        sys.exit(f"slurm-test: found other bytes in {', '.join(unlike)}, expected those of the local run")
    left_out = " and ".join(f"results/{one}" for one in NOT_COMPARED)
    tell(f"{len(results(slurm))} results are the same bytes; {left_out} are not compared")
    tell(f"tiny project: {whole[0]:.0f} s locally, {whole[1]:.0f} s on SLURM")
    times = f"{cell[0]:.0f} s locally, {cell[1]:.0f} s on SLURM, {cell[1] / cell[0]:.2f} times as long"
    tell(f"coverage cell of {N_SURVEYS} surveys: {times}; to reach: {SLOWER_AT_MOST}")


def tell(text: str) -> None:
    """Print a line."""
    print(f"slurm-test: {text}", flush=True)


if __name__ == "__main__":
    main()

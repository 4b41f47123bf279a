"""Snakemake as a child process that ends with the command that started it."""

import contextlib
import os
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Final

from linepose.pipeline.parent_process import COMMAND

_PATIENCE_S: Final = 10.0


def run_snakemake(snakefile: Path, root: Path, arguments: Sequence[str]) -> int:
    """Run a workflow in the project's folder; its exit code. It ends when this process does, however that ends."""
    environment = os.environ | {COMMAND: str(os.getpid())}
    child = subprocess.Popen([*_command(snakefile, root), *arguments], env=environment)
    try:
        return child.wait()
    except KeyboardInterrupt:  # which a terminal sends to the child too
        with contextlib.suppress(subprocess.TimeoutExpired):
            return child.wait(_PATIENCE_S)
        child.kill()
        return child.wait()


def files_of_workflow(snakefile: Path, root: Path, arguments: Sequence[str]) -> set[str]:
    """The files, by their paths in the project, that a run with these arguments would make or find made."""
    summary = [*_command(snakefile, root), *arguments, "--summary"]
    done = subprocess.run(summary, capture_output=True, text=True, check=False)
    return {line.split("\t")[0] for line in done.stdout.splitlines()} if done.returncode == 0 else set()


def _command(snakefile: Path, root: Path) -> list[str]:
    return [sys.executable, "-m", "snakemake", "--snakefile", str(snakefile), "--directory", str(root)]

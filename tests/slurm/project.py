"""The tiny project, run locally and on SLURM, and its results compared."""

import hashlib
import os
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path

from cluster import CORES
from tiny_project import QUICK, ROOT, STUDY, Project

NOT_COMPARED = ("logs",)  # of results/: what was told, and how long it took
CELL = "results/coverage/cells/tiny/white/published.parquet"
REAL_CELL = "results/coverage/cells/ladybird-sim/white/adjustment.parquet"  # surveys of a real one's size
TINY_ALONE = ["--config", 'platforms=["tiny"]']
BASIN = {"basin": {"n_distances": 2, "n_angles": 1, "optimisers": ["powell"]}}
LOCAL = ["--cores", str(CORES)]
PATIENT = ["--latency-wait", "10", "--slurm-init-seconds-before-status-checks", "2"]  # as long as one machine needs
SLURM = [
    *("--profile", str(ROOT / "profiles" / "slurm"), "--cores", str(CORES), "--max-threads", str(CORES)),
    *PATIENT,
]
SNAKEMAKE = [sys.executable, "-m", "snakemake", "--snakefile", str(ROOT / "Snakefile")]
LINEPOSE = [sys.executable, "-c", "from linepose.cli import main; main()"]
BY_COMMAND = ["run", "tiny", "--cores", str(CORES), "--profile", "slurm", "--", "--max-threads", str(CORES), *PATIENT]


def tiny(folder: Path, n_surveys: int) -> Path:
    """A new folder with the tiny project: a platform with a sweep, and a coverage study of it and of a larger one."""
    regimes = {"white": {"white_level": 1.0, "noise_models": ["adjustment", "published"]}}
    study = (
        STUDY
        | {"platforms": ["tiny", "ladybird-sim"]}
        | {"coverage": {"n_surveys": n_surveys, "batch_size": 5, "regimes": regimes}}
    )
    folder.mkdir()
    Project(folder).configure(study, {"tiny": QUICK | {"experiments": {**QUICK["experiments"], **BASIN}}})
    return folder


def start(folder: Path, *arguments: str, program: Sequence[str] = SNAKEMAKE) -> "subprocess.Popen[str]":
    """A program, Snakemake if none is given, begun in a project's folder; its messages go to run.log there."""
    environment = os.environ | {"PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"}
    with (folder / "run.log").open("a") as log:
        return subprocess.Popen([*program, *arguments], cwd=folder, env=environment, stdout=log, stderr=log, text=True)


def run(folder: Path, *arguments: str, program: Sequence[str] = SNAKEMAKE) -> float:
    """Run it there; the time that it took, in seconds. Ends the test where it fails."""
    begun = time.monotonic()
    if start(folder, *arguments, program=program).wait(timeout=3600):
        sys.exit(f"slurm-test: {' '.join(arguments)} failed in {folder}:\n{(folder / 'run.log').read_text()}")
    return time.monotonic() - begun


def results(folder: Path) -> dict[str, str]:
    """Digest of each result by its path."""
    root = folder / "results"
    files = [path for path in sorted(root.rglob("*")) if path.is_file()]
    named = {path.relative_to(root): path for path in files}
    return {
        str(name): hashlib.sha256(path.read_bytes()).hexdigest()
        for name, path in named.items()
        if name.parts[0] not in NOT_COMPARED
    }


def differences(folder: Path, other: Path, of: str = "") -> list[str]:
    """Names of the results that two projects do not have alike; of one platform alone if it is named."""
    one, two = results(folder), results(other)
    names = [name for name in one.keys() | two.keys() if not of or name.startswith(f"{of}/")]
    return sorted(name for name in names if one.get(name) != two.get(name))

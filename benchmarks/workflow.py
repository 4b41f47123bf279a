"""What all of `snakemake` costs on the field data, from clean, environment in place: `python benchmarks/workflow.py`.

In a folder of its own, with the project's configuration but for the simulated platforms; compiled code is made anew.
"""

import os
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from linepose.config.platform import load_platform, read_yaml

ROOT = Path(__file__).resolve().parents[1]
TO_REACH_S = 300


def main() -> None:
    """Print the time."""
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    study = read_yaml(ROOT / "config" / "config.yaml")
    folders = [str((ROOT / folder).resolve()) for folder in study["data_folders"]]
    platforms = [name for name in study["platforms"] if not load_platform(ROOT / "config/platforms", name).simulation]
    with tempfile.TemporaryDirectory() as folder:
        shutil.copytree(ROOT / "config", Path(folder) / "config")
        command = [sys.executable, "-m", "snakemake", "--snakefile", str(ROOT / "Snakefile"), "--cores", str(cores)]
        settings = [f"platforms={platforms}", f"data_folders={folders}"]
        begun = time.perf_counter()
        run = subprocess.run(
            [*command, "--config", *settings],
            cwd=folder,
            env=os.environ | {"NUMBA_CACHE_DIR": str(Path(folder) / "compiled")},
            capture_output=True,
            text=True,
            check=False,
        )
        seconds = time.perf_counter() - begun
    if run.returncode:
        sys.exit(run.stderr)
    spent = resource.getrusage(resource.RUSAGE_CHILDREN)
    processor_s = spent.ru_utime + spent.ru_stime
    print(f"The whole workflow on the field data ({', '.join(platforms)}), from clean, {cores} cores: ", end="")
    print(f"{seconds:.0f} s, {processor_s:.0f} s of processor time; to reach: {TO_REACH_S} s")


if __name__ == "__main__":
    main()

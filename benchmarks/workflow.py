"""What all of `snakemake` costs on the field data, from clean, environment in place: `python benchmarks/workflow.py`.

In a folder of its own, with the project's configuration but for the simulated platforms; compiled code is made anew.
"""

import os
import shutil
import sys
import tempfile
from pathlib import Path

from process_cost import measured

from linepose.config.platform import load_platform, read_yaml
from linepose.config.study import check_study

ROOT = Path(__file__).resolve().parents[1]
TO_REACH_S = 300


def field_study() -> tuple[list[str], list[str]]:
    """The platforms of the project's study that are not simulated, and its data folders."""
    study = check_study(read_yaml(ROOT / "config" / "config.yaml"))
    folder = ROOT / "config" / "platforms"
    names = [name for name in study.platforms if load_platform(folder, name).true_pose is None]
    return names, [str((ROOT / folder).resolve()) for folder in study.data_folders]


def main() -> None:
    """Print the time."""
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    platforms, folders = field_study()
    with tempfile.TemporaryDirectory() as folder:
        shutil.copytree(ROOT / "config", Path(folder) / "config")
        command = [sys.executable, "-m", "snakemake", "--snakefile", str(ROOT / "Snakefile"), "--cores", str(cores)]
        settings = [f"platforms={platforms}", f"data_folders={folders}"]
        environment = {"NUMBA_CACHE_DIR": str(Path(folder) / "compiled")}
        cost = measured([*command, "--config", *settings], Path(folder), Path(folder) / "log.txt", environment)
    print(f"The whole workflow on the field data ({', '.join(platforms)}), from clean, {cores} cores: ", end="")
    print(f"{cost.wall_s:.0f} s, {cost.processor_s:.0f} s of processor time; to reach: {TO_REACH_S} s")


if __name__ == "__main__":
    main()

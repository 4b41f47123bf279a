"""A tiny simulated platform, from scans to the pose, and the workflow run on it as a user does."""

import os
import shutil
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from linepose.experiments.registry import SECTIONS

ROOT = Path(__file__).parents[2]
STUDY = {
    "platforms": ["tiny"],
    "data_folders": ["data"],
    "outliers": {"minimum_observations": 3, "threshold_px": 50.0},
    "sampling": {"n_walkers": 14, "n_burn_in": 5, "n_steps": 12},
    "adjustment": {"n_draws": 10, "n_samples": 50},
}
PASSES = [
    {"north_m": -2.85, "east_m": -0.55, "heading_deg": 21, "speed_m_s": -0.5, "duration_s": 4},
    {"north_m": -1.47, "east_m": -2.49, "heading_deg": 67, "speed_m_s": -0.5, "duration_s": 4},
    {"north_m": 2.86, "east_m": -0.65, "heading_deg": 159, "speed_m_s": -0.5, "duration_s": 4},
    {"north_m": 0.27, "east_m": 2.91, "heading_deg": -102, "speed_m_s": -0.5, "duration_s": 4},
]
TINY = {
    "like": "ladybird-sim",
    "experiments": {
        "basin": {"n_distances": 2, "n_angles": 1, "optimisers": ["powell"]},
        "repeatability": None,
        "sensitivity": None,
        "adjustment_beside": {"n_splits": 1},
    },
    "map": {"geotiff": {"bands": [1]}},
    "simulation": {
        "passes": PASSES,
        "faults": [],
        "transfer_s": 2.0,
        "image": {"supersampling": 2, "margin_share": 0.4},
    },
}
QUICK = TINY | {"experiments": dict.fromkeys(SECTIONS), "map": None}  # without any experiment


@dataclass(frozen=True)
class Project:
    """A folder with a configuration of its own, in which the workflow runs."""

    folder: Path

    def configure(self, study: Mapping[str, Any], platforms: Mapping[str, Mapping[str, Any]]) -> None:
        config = self.folder / "config"
        shutil.copytree(ROOT / "config", config, dirs_exist_ok=True, ignore=shutil.ignore_patterns("paper"))
        (config / "config.yaml").write_text(yaml.safe_dump(dict(study)))
        for name, values in platforms.items():
            (config / "platforms" / f"{name}.yaml").write_text(yaml.safe_dump(dict(values)))

    def start(self, *arguments: str, cores: int = 2, snakefile: Path = ROOT / "Snakefile") -> subprocess.Popen[str]:
        """The workflow, begun in a session of its own, so that all its processes can be killed at once."""
        command = ["-m", "snakemake", "--snakefile", str(snakefile), "--cores", str(cores)]
        return self._start(*command, *arguments)

    def start_linepose(self, *arguments: str) -> subprocess.Popen[str]:
        """A command of linepose, begun likewise."""
        return self._start("-c", "from linepose.cli import main; main()", *arguments)

    def linepose(self, *arguments: str) -> subprocess.CompletedProcess[str]:
        started = self.start_linepose(*arguments)
        output, error = started.communicate(timeout=600)
        return subprocess.CompletedProcess(started.args, started.returncode, output, error)

    def _start(self, *arguments: str) -> subprocess.Popen[str]:
        path = os.pathsep.join([str(ROOT / "src"), os.environ.get("PYTHONPATH", "")])
        return subprocess.Popen(
            [sys.executable, *arguments],
            cwd=self.folder,
            env=os.environ | {"PYTHONPATH": path},
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            start_new_session=True,
        )

    def run(
        self, *arguments: str, cores: int = 2, snakefile: Path = ROOT / "Snakefile"
    ) -> subprocess.CompletedProcess[str]:
        started = self.start(*arguments, cores=cores, snakefile=snakefile)
        output, error = started.communicate(timeout=600)
        return subprocess.CompletedProcess(started.args, started.returncode, output, error)

    def results(self) -> dict[str, bytes]:
        """Every Parquet result by its path."""
        folder = self.folder / "results"
        return {str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.rglob("*.parquet"))}


def lines_with(text: str, error: str) -> list[str]:
    return [line for line in error.splitlines() if text in line]

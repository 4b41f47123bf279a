"""From raw scans of twelve strips of 5,000 lines to the pose: seconds of matching and adjusting.

    python benchmarks/strips.py

The strips are a variant of config/platforms/drone-sim.yaml, simulated and calibrated by `linepose run` in a folder that
is removed; times are those that each job's log ends with.
"""

import re
import subprocess
import sys
import tempfile
from pathlib import Path

import yaml

from linepose.experiments.registry import SECTIONS

ROOT = Path(__file__).parents[1]
DURATION_S, LINE_RATE_HZ = 50, 100
ASKED_S, N_CORES = 120, 2
STAGES = ("extract", "associate", "adjust")
TOOK = re.compile(r"took ([\d.]+) s, ([\d.]+) s of processor time, at most (\d+) MB")


def strips() -> list[dict[str, float]]:
    """Eight there and back at two heights, four across."""
    along = [
        {"north_m": 0, "east_m": 12 * row - 42, "heading_deg": 180 * (row % 2), "height_m": 40 + 20 * (row // 2 % 2)}
        for row in range(8)
    ]
    across = [
        {"north_m": 60 * row - 90, "east_m": 0, "heading_deg": 90 + 180 * (row % 2), "height_m": 40 + 20 * (row % 2)}
        for row in range(4)
    ]
    return [one | {"duration_s": DURATION_S} for one in along + across]


def main() -> None:
    """Simulate, run, and print."""
    values = yaml.safe_load((ROOT / "config" / "platforms" / "drone-sim.yaml").read_text())
    values["flight"]["strips"] = strips()
    values |= {"experiments": dict.fromkeys(SECTIONS), "map": None}
    with tempfile.TemporaryDirectory() as folder:
        config = Path(folder) / "config"
        (config / "platforms").mkdir(parents=True)
        (config / "platforms" / "strips.yaml").write_text(yaml.safe_dump(values))
        (config / "config.yaml").write_text("platforms: [strips]\n")
        linepose = [
            sys.executable,
            "-c",
            "from linepose.cli import main; main()",
            "run",
            "strips",
            "--cores",
            str(N_CORES),
        ]
        ran = subprocess.run(linepose, cwd=folder, capture_output=True, text=True)
        if ran.returncode:
            sys.exit(ran.stderr)
        logs = Path(folder) / "results" / "logs" / "strips"
        print(
            f"twelve strips of {DURATION_S * LINE_RATE_HZ} lines, from raw scans; {N_CORES} cores; asked: {ASKED_S} s"
        )
        total_s = 0.0
        for stage in STAGES:
            took = TOOK.search((logs / f"{stage}.log").read_text())
            assert took is not None
            total_s += float(took[1])
            print(f"{stage:<12}{float(took[1]):8.1f} s wall{float(took[2]):8.1f} s processor{took[3]:>8} MB")
        print(f"{'together':<12}{total_s:8.1f} s wall")


if __name__ == "__main__":
    main()

"""What scans cost: rendering, extraction, detection, association, and memory; `python benchmarks/scans.py`.

Wall and processor seconds of one run with two threads, compiling done before, beside what is asked for. `--large` reads
a scan of 648 pixels x 10,000 lines x 244 bands, for which it needs 3.2 GB of disk; otherwise a tenth of the lines.
"""

import argparse
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import numba
import numpy as np
import pandas as pd

from linepose.config.platform import load_platform
from linepose.inputs.labels.labels import read_labels
from linepose.inputs.navigation.log_file import read_navigation_log
from linepose.inputs.observed_points import detected_points, refined_points, select_scans
from linepose.inputs.targets.refine import METHODS
from linepose.simulation import envi
from linepose.simulation.record import write_survey
from linepose.simulation.render import render
from linepose.survey.navigation_log import associate_poses, interpolated_pose
from linepose.survey.observations import EULER_COLUMNS, POSITION_COLUMNS

PLATFORMS = ("ladybird-sim", "shrimp-sim")
RENDERING_S, EXTRACTION_S, ASSOCIATION_S, READING_MB = 180, 60, 5, 500
N_PIXELS, N_BANDS, N_LINES = 648, 244, 10_000
LOG_RATE_HZ, LOG_S = 200, 3600
START_US = 1_466_000_000_000_000

# in a process of its own, whose peak (as Linux has it) is not that of anything else
READ = """
import sys, time
from pathlib import Path
from linepose.inputs.scans.scan_files import read_scan
def peak_mb():
    status = Path("/proc/self/status").read_text()
    return int(status.split("VmHWM:")[1].split()[0]) / 1024
before, start = peak_mb(), time.perf_counter()
read_scan(Path(sys.argv[1]))
print(f"{time.perf_counter() - start:.1f} {before:.0f} {peak_mb():.0f}")
"""


@contextmanager
def measured(what: str, at_most_s: float | None = None) -> Iterator[None]:
    """Print the wall and processor time of a block."""
    wall, processor = time.perf_counter(), time.process_time()
    yield
    wall, processor = time.perf_counter() - wall, time.process_time() - processor
    limit = "" if at_most_s is None else f"asked: {at_most_s:g} s"
    print(f"{what:<46}{wall:8.1f} s wall{processor:8.1f} s processor   {limit}", flush=True)


def surveys(folder: Path) -> None:
    """Render both simulated platforms, refine their labels, and detect all points without them."""
    platforms = {name: load_platform(Path(__file__).parents[1] / "config" / "platforms", name) for name in PLATFORMS}
    for platform in platforms.values():
        brief = replace(platform.simulation, passes=platform.simulation.passes[:1], faults=())
        render(platform.intrinsics(), replace(brief, image=replace(brief.image, supersampling=1)), 1)
    with measured("both platforms rendered and written", RENDERING_S):
        for name, platform in platforms.items():
            write_survey(folder / name, platform.intrinsics(), platform.simulation)
    with measured("both extracted, with labels and without", EXTRACTION_S):
        for name, platform in platforms.items():
            scans, method = select_scans(folder / name, "scans/*.hdr", []), METHODS[platform.source.refinement]
            labels = read_labels(folder / name / "labels.csv", list(scans))
            n_refined = len(refined_points(scans, labels, method, platform.camera.n_pixels))
            n_detected = len(detected_points(scans, method, platform.camera.n_pixels))
            print(f"  {name}: {n_refined} points from labels, {n_detected} without", flush=True)


def navigation(folder: Path) -> None:
    """Read an hour's log, as CSV and as Parquet, and associate 500 points with it."""
    time_s = np.arange(0, LOG_S, 1 / LOG_RATE_HZ)
    columns = {name: 100 * np.sin(time_s / 50 + k) for k, name in enumerate(POSITION_COLUMNS)}
    columns |= {name: np.sin(time_s / 30 + k) for k, name in enumerate(EULER_COLUMNS)}
    log = pd.DataFrame({"time_us": START_US + np.rint(1e6 * time_s).astype(np.int64)} | columns)
    log.to_parquet(folder / "log.parquet", index=False)
    log.to_csv(folder / "log.csv", index=False)
    times = np.sort(np.random.default_rng(0).integers(log["time_us"].iloc[0], log["time_us"].iloc[-1], 500))
    points = pd.DataFrame({"observation": np.arange(500) // 15, "point": np.arange(500) % 15, "time_us": times})
    for kind in ("parquet", "csv"):
        with measured(f"{len(log)} poses of an hour read and associated, {kind}", ASSOCIATION_S):
            associate_poses(points, read_navigation_log(folder / f"log.{kind}"), interpolated_pose, 0.1)


def memory(folder: Path, n_lines: int) -> None:
    """Read a scan of many bands in a process of its own and print its peak."""
    rng = np.random.default_rng(0)
    block = rng.integers(0, 4096, (100, N_BANDS, N_PIXELS), dtype=np.uint16)
    path = folder / "large"
    envi.write_scan(path, (block for _ in range(n_lines // len(block))), np.linspace(400, 1000, N_BANDS))
    envi.write_line_times(path, START_US + 7519 * np.arange(n_lines))
    size_gb = path.with_suffix(".bil").stat().st_size / 1e9
    command = [sys.executable, "-c", READ, str(path.with_suffix(".hdr"))]
    seconds, before, peak = subprocess.run(command, check=True, capture_output=True, text=True).stdout.split()
    what = f"{N_PIXELS} x {n_lines} lines x {N_BANDS} bands, {size_gb:.1f} GB, read"
    rate = 1e3 * size_gb / float(seconds)
    print(
        f"{what:<46}{float(seconds):8.1f} s, {rate:.0f} MB/s; peak {peak} MB, of which {before} MB before reading; ",
        end="",
    )
    print(f"asked: {READING_MB} MB")


def main() -> None:
    """Print the measurements."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--large", action="store_true", help="read the scan of 3.2 GB")
    large = parser.parse_args().large
    numba.set_num_threads(min(2, numba.config.NUMBA_NUM_THREADS))
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        memory(folder, N_LINES if large else N_LINES // 10)
        navigation(folder)
        surveys(folder)


if __name__ == "__main__":
    main()

"""What the experiments cost on the field data, on all cores: `python benchmarks/experiments.py`.

The share of the kernel is that of processor time, of one search after the other on one core: evaluations times the time
of one, measured at the poses that the searches visit, over all that the searches take.
"""

import os
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from linepose.config.platform import load_platform, read_yaml
from linepose.estimation.likelihood_estimator import LikelihoodEstimator
from linepose.experiments.basin import BASIN, BasinSettings, Sweep
from linepose.experiments.splits import SPLITS, random_splits
from linepose.likelihood.published import PublishedLikelihood
from linepose.pipeline.batches import batch_ranges, run_batches

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))
from unit.likelihood import surveys

ROOT = Path(__file__).resolve().parents[1]
GRIDS = (10, 15, 30)  # cells in each direction; cost should grow with their square
TO_REACH_S = {"splits": 20.0, "powell": 90.0}


def line(*cells: object) -> None:
    """Print one row of the table."""
    print(f"{cells[0]:<10}" + "".join(f"{cell!s:>14}" for cell in cells[1:]))


def kernel_share(sweep: Sweep, likelihood: PublishedLikelihood, cells: range) -> float:
    """Share of the searches' processor time that evaluations take."""
    begun = time.process_time()
    table = sweep.rows("powell", cells)
    total = time.process_time() - begun
    model, poses = (
        likelihood.without_cheirality(),
        table[[name for name in table if name[:2] in ("r_", "th")]].to_numpy(),
    )
    begun, rounds = time.process_time(), 2000 // len(poses)
    for _ in range(rounds):
        for pose in poses:
            model.log_likelihood(pose)
    one = (time.process_time() - begun) / (rounds * len(poses))
    return float(table["n_evaluations"].sum() * one / total)


def main() -> None:
    """Print the table."""
    if not surveys.FIELD_FOLDER.is_dir():
        sys.exit("benchmarks/experiments.py: no field data; run `make reproduce` once, or put it where README.md says")
    platform = load_platform(ROOT / "config" / "platforms", "ladybird")
    inliers = read_yaml(ROOT / "config" / "paper" / "published.yaml")["table3"]["ladybird"]["inliers_16"]
    pose, covariance = np.array(inliers["pose"]), np.diag(np.square(inliers["sigma"]))
    likelihood = PublishedLikelihood(surveys.field_survey().select(list(surveys.INLIERS)), platform.intrinsics())
    likelihood.log_likelihood(pose)
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    share = kernel_share(
        Sweep(LikelihoodEstimator(likelihood), pose, covariance, BasinSettings(n_distances=4, n_angles=5), 1),
        likelihood,
        range(20),
    )
    print(f"Experiments on the 16 inliers; {cores} cores, wall time")
    print(f"(the kernel has {100 * share:.0f} % of the basin's processor time with Powell's method, to reach: 80 %)\n")
    line("", "runs", "seconds", "ms each", "to reach, s")
    with tempfile.TemporaryDirectory() as folder:
        ranges = batch_ranges(200, 10)
        begun = time.perf_counter()
        run_batches(
            lambda name: random_splits(LikelihoodEstimator(likelihood), pose, 8, ranges[name], 1),
            list(ranges),
            Path(folder) / "splits",
            SPLITS,
            cores,
        )
        seconds = time.perf_counter() - begun
        line("splits", 200, f"{seconds:.1f}", f"{5 * seconds:.0f}", TO_REACH_S["splits"])
        for optimiser in ("powell", "wide"):
            for size in GRIDS:
                sweep = Sweep(
                    LikelihoodEstimator(likelihood), pose, covariance, BasinSettings(n_distances=size, n_angles=size), 1
                )
                cells = batch_ranges(size**2, 15)
                begun = time.perf_counter()
                run_batches(
                    lambda name, sweep=sweep, cells=cells, optimiser=optimiser: sweep.rows(optimiser, cells[name]),
                    list(cells),
                    Path(folder) / f"{optimiser}{size}",
                    BASIN,
                    cores,
                )
                seconds = time.perf_counter() - begun
                goal = TO_REACH_S.get(optimiser, "") if size == GRIDS[-1] else ""
                line(optimiser, size**2, f"{seconds:.1f}", f"{1e3 * seconds / size**2:.0f}", goal)


if __name__ == "__main__":
    main()

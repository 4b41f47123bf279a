"""What optimisation and sampling cost on the field data, beside the paper's times: `python benchmarks/pipeline.py`.

Wall time, the least of a few repetitions; compiling is done before.
"""

import sys
import time
from collections.abc import Callable
from pathlib import Path

import numba
import yaml

from linepose.config.platform import load_platform
from linepose.likelihood.published import PublishedLikelihood
from linepose.optimise import optimise
from linepose.outliers import reject_outliers
from linepose.sampling import sample

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests" / "unit" / "likelihood"))
import surveys

ROOT = Path(__file__).resolve().parents[1]
TARGETS_S = {16: (0.10, 1.5), 25: (None, 2.6)}
PAPER = {16: "inliers_16", 25: "all_25"}
HEAD = ("observations", "seconds", "to reach", "evaluations", "paper, min", "times faster")


def least_seconds(function: Callable[[], object], repetitions: int) -> float:
    """Least wall time of a call."""
    seconds = []
    for _ in range(repetitions):
        start = time.perf_counter()
        function()
        seconds.append(time.perf_counter() - start)
    return min(seconds)


def line(name: str, *cells: object) -> None:
    """Print one row of the table."""
    print(f"{name:<16}" + "".join(f"{cell!s:>14}" for cell in cells))


def main() -> None:
    """Print the table."""
    if not surveys.FIELD_FOLDER.is_dir():
        sys.exit("benchmarks/pipeline.py: no field data; run `make reproduce` once, or put it where README.md says")
    platform = load_platform(ROOT / "config" / "platforms", "ladybird")
    runtime = yaml.safe_load((ROOT / "config" / "published.yaml").read_text())["section4"]["runtime_min"]["ladybird"]
    survey, start = surveys.field_survey(), platform.start_pose()
    print(f"{numba.get_num_threads()} threads; wall time, least of a few repetitions\n")
    line("", *HEAD)
    for numbers in (surveys.INLIERS, range(1, 26)):
        likelihood = PublishedLikelihood(survey.select(list(numbers)), platform.intrinsics())
        n = likelihood.survey.n_observations
        optimum = optimise(likelihood, start)
        sample(likelihood, optimum.parameters, seed=0)
        goals, minutes = TARGETS_S[n], runtime[PAPER[n]]
        powell_s = least_seconds(lambda likelihood=likelihood: optimise(likelihood, start), 10)
        chain_s = least_seconds(lambda likelihood=likelihood, o=optimum: sample(likelihood, o.parameters, seed=0), 3)
        count = 250 * 201
        line(
            "Powell",
            n,
            f"{powell_s:.3f}",
            goals[0],
            optimum.n_evaluations,
            minutes[0],
            f"{60 * minutes[0] / powell_s:.0f}",
        )
        line("MCMC", n, f"{chain_s:.2f}", goals[1], count, minutes[1], f"{60 * minutes[1] / chain_s:.0f}")
    whole = PublishedLikelihood(survey, platform.intrinsics())
    begun = time.perf_counter()
    stages = reject_outliers(whole, start, 10)
    seconds = time.perf_counter() - begun
    count = sum(stage.optimum.n_evaluations for stage in stages)
    line("outlier removal", "25 to 10", f"{seconds:.2f}", "", count, "", "")


if __name__ == "__main__":
    main()

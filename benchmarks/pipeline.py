"""What optimisation and sampling cost on the field data, beside the paper's times: `python benchmarks/pipeline.py`.

Wall time, the least of a few repetitions; compiling is done before. The plain reference's time is that of one of its
evaluations times their number.
"""

import sys
import time
from collections.abc import Callable
from pathlib import Path

import numba
import yaml

from linepose.config.platform import load_platform
from linepose.estimation.optimise import optimise
from linepose.estimation.outliers import reject_outliers
from linepose.estimation.sampling import sample
from linepose.likelihood.published import PublishedLikelihood

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))
from unit.likelihood import reference, surveys

ROOT = Path(__file__).resolve().parents[1]
GOALS_S = {16: (0.05, 0.8), 25: ("", 1.5)}
PAPER = {16: "inliers_16", 25: "all_25"}
HEAD = ("observations", "seconds", "goal", "evaluations", "plain, h", "paper, min", "plain/s", "paper/s")


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
    print(f"{name:<16}" + "".join(f"{cell!s:>13}" for cell in cells))


def main() -> None:
    """Print the table."""
    if not surveys.FIELD_FOLDER.is_dir():
        sys.exit("benchmarks/pipeline.py: no field data; run `make reproduce` once, or put it where README.md says")
    platform = load_platform(ROOT / "config" / "platforms", "ladybird")
    runtime = yaml.safe_load((ROOT / "config" / "paper" / "published.yaml").read_text())["section4"]["runtime_min"][
        "ladybird"
    ]
    survey, start = surveys.field_survey(), platform.start_pose()
    print(f"Optimisation and sampling; {numba.get_num_threads()} threads, wall time, least of a few repetitions\n")
    line("", *HEAD)
    for numbers in (surveys.INLIERS, range(1, 26)):
        likelihood = PublishedLikelihood(survey.select(list(numbers)), platform.intrinsics())
        n = likelihood.survey.n_observations
        optimum = optimise(likelihood, start)
        sample(likelihood, optimum.parameters, seed=0)
        begun = time.perf_counter()
        reference.evaluate(likelihood.survey, platform.intrinsics(), optimum.parameters)
        plain_s = time.perf_counter() - begun
        powell_s = least_seconds(lambda likelihood=likelihood: optimise(likelihood, start), 10)
        chain_s = least_seconds(lambda likelihood=likelihood, o=optimum: sample(likelihood, o.parameters, seed=0), 3)
        measured = (("Powell", powell_s, optimum.n_evaluations), ("MCMC", chain_s, 250 * 201))
        for (name, seconds, count), goal, minutes in zip(measured, GOALS_S[n], runtime[PAPER[n]], strict=True):
            ratios = (f"{count * plain_s / seconds:.0f}", f"{60 * minutes / seconds:.0f}")
            line(name, n, f"{seconds:.3f}", goal, count, f"{count * plain_s / 3600:.0f}", minutes, *ratios)
    whole = PublishedLikelihood(survey, platform.intrinsics())
    begun = time.perf_counter()
    stages = reject_outliers(whole, start, 10)
    seconds = time.perf_counter() - begun
    count = sum(stage.optimum.n_evaluations for stage in stages)
    line("outlier removal", "25 to 10", f"{seconds:.3f}", "", count, "", "", "", "")


if __name__ == "__main__":
    main()

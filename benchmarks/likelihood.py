"""What one evaluation of the published likelihood costs, as a plain text table: `python benchmarks/likelihood.py`.

Every figure is the least of many short repetitions, because others may share the machine; the peak is measured in
between them, so that a ratio holds at the clock rate of the moment.
"""

import sys
import time
from collections.abc import Callable
from pathlib import Path

import numba
import numpy as np
from numba import njit

from linepose.geometry.camera import Camera
from linepose.likelihood.published import PublishedLikelihood
from linepose.survey.observations import Survey

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))
from operations import floating_point_operations
from unit.likelihood import reference, surveys

POSE = np.array([0.189, -0.142, -0.794, -0.822, 0.738, -1.429])
GOALS_MS = {16: (0.022, 0.011), 25: (0.046, 0.023)}  # single, batched on two cores
PAPER_MIN = {16: 240, 25: 420}  # MCMC
PAPER_EVALUATIONS = 250 * 201
ROWS = 125  # what emcee asks for at once with 250 walkers
CHAIN = 24  # long enough to hide loads, short enough for several chains to be in flight at once
OBSERVATIONS = (8, 16, 25, 50, 100, 200)
POINTS = (1, 4, 16, 32, 64, 128, 200)


@njit(error_model="numpy", fastmath={"contract"})
def _chains(values: np.ndarray, factor: float, term: float, rounds: int) -> None:
    for _ in range(rounds):
        for k in range(values.shape[0]):
            value = values[k]
            for _step in range(CHAIN):
                value = value * factor + term
            values[k] = value


def peak_flops() -> Callable[[], float]:
    """A function that measures the double-precision FMA peak of one core: products plus sums per second."""
    values, rounds = np.linspace(0, 1, 256), 100

    def measure() -> float:
        seconds = least_seconds(lambda: _chains(values, 0.999, 1e-3, rounds), repetitions=100)
        return 2 * CHAIN * rounds * len(values) / seconds

    _chains(values, 0.999, 1e-3, 1)
    assembly = "".join(_chains.inspect_asm().values())
    if not any("fm" in line and ("ymm" in line or "zmm" in line) for line in assembly.splitlines()):
        print("note: the peak loop was not compiled to vector FMA on this machine; shares of the peak are too high")
    return measure


def least_seconds(function: Callable[[], object], repetitions: int) -> float:
    """Least wall time of one call."""
    seconds = []
    for _ in range(repetitions):
        start = time.perf_counter()
        function()
        seconds.append(time.perf_counter() - start)
    return min(seconds)


def single_seconds(likelihood: PublishedLikelihood, pose: np.ndarray, budget_s: float = 0.3) -> float:
    """Least time of one evaluation, call from Python included."""
    once = least_seconds(lambda: likelihood.log_likelihood(pose), 3)
    calls = max(1, int(1e-3 / once))

    def run() -> None:
        for _ in range(calls):
            likelihood.log_likelihood(pose)

    return least_seconds(run, max(3, int(budget_s / (calls * once)))) / calls


def batched_seconds(likelihood: PublishedLikelihood, repetitions: int = 200) -> float:
    """Least time of one evaluation within a batch on all threads."""
    poses = POSE + np.random.default_rng(0).normal(0, 1e-3, (ROWS, 6))
    likelihood.log_likelihoods(poses)
    return least_seconds(lambda: likelihood.log_likelihoods(poses), repetitions) / ROWS


def field_survey() -> Survey:
    """The Ladybird survey where the field data is at hand, else a synthetic one of its size."""
    if surveys.FIELD_FOLDER.is_dir():
        return surveys.field_survey()
    print("no field data found: figures are those of a synthetic survey of the same size")
    return surveys.synthetic_survey(25, 15, seed=0, camera=surveys.FIELD_CAMERA)


def evaluation_table(survey: Survey, camera: Camera) -> None:
    """Print milliseconds, share of the peak, and how much faster that is than the plain reference and the paper."""
    threads, measure_peak = numba.get_num_threads(), peak_flops()
    print(f"One evaluation of the likelihood; {threads} threads, wall time, least of many repetitions")
    print(
        "(plain: Eq. 11-22 as written, with complex-step Jacobians; paper: its MCMC over the evaluations that takes)\n"
    )
    head = (
        "observations",
        "ms",
        "goal",
        "GFLOP/s",
        "FMA peak",
        "share",
        "plain ms",
        "paper ms",
        "plain/ms",
        "paper/ms",
    )
    print(f"{'':<8}" + "".join(f"{name:>12}" for name in head))
    for numbers in (surveys.INLIERS, range(1, 26)):
        chosen = survey.select(list(numbers))
        likelihood = PublishedLikelihood(chosen, camera)
        n, m = chosen.n_observations, chosen.n_points
        operations = floating_point_operations(n, m)
        likelihood.log_likelihood(POSE)
        plain = least_seconds(lambda chosen=chosen: reference.evaluate(chosen, camera, POSE), 1)
        paper = 60 * PAPER_MIN[n] / PAPER_EVALUATIONS
        peak, single, batched = 0.0, np.inf, np.inf
        for _ in range(5):
            peak = max(peak, measure_peak())
            single = min(single, single_seconds(likelihood, POSE))
            batched = min(batched, batched_seconds(likelihood))
        goal_single, goal_batched = GOALS_MS[n]
        rows = (("single", single, goal_single, peak), ("batched", batched, goal_batched, peak * threads))
        for name, seconds, goal, ceiling in rows:
            rate = operations / seconds
            cells = (
                f"{n}",
                f"{1e3 * seconds:.4f}",
                f"{goal:.3f}",
                f"{rate / 1e9:.1f}",
                f"{ceiling / 1e9:.1f}",
                f"{rate / ceiling:.0%}",
                f"{1e3 * plain:.0f}",
                f"{1e3 * paper:.0f}",
                f"{plain / seconds:.0f}",
                f"{paper / seconds:.0f}",
            )
            print(f"{name:<8}" + "".join(f"{cell:>12}" for cell in cells))


def scaling_table(title: str, sizes: tuple[int, ...], likelihoods: Callable[[int], PublishedLikelihood]) -> None:
    """Print the cost of one evaluation against a size, and the exponent with which the larger half of it grows."""
    milliseconds = []
    for size in sizes:
        likelihood = likelihoods(size)
        likelihood.log_likelihood(surveys.SYNTHETIC_POSE)
        milliseconds.append(1e3 * single_seconds(likelihood, surveys.SYNTHETIC_POSE))
    half = len(sizes) // 2
    upper = np.polyfit(np.log(sizes[half:]), np.log(milliseconds[half:]), 1)[0]
    print(f"\n{title:<14}" + "".join(f"{size:>10}" for size in sizes))
    print(f"{'ms':<14}" + "".join(f"{each:>10.4f}" for each in milliseconds), end="")
    print(f"   grows with the power {upper:.2f} from {sizes[half]} up")


def main() -> None:
    """Print all tables."""
    evaluation_table(field_survey(), surveys.FIELD_CAMERA)

    def synthetic(n_observations: int, n_points: int) -> PublishedLikelihood:
        return PublishedLikelihood(surveys.synthetic_survey(n_observations, n_points, 0), surveys.DISTORTED_CAMERA)

    scaling_table("observations", OBSERVATIONS, lambda n: synthetic(n, 15))
    scaling_table("points", POINTS, lambda m: synthetic(16, m))


if __name__ == "__main__":
    main()

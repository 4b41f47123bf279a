"""The adjustment measured: time of a pass and of a survey, how time grows with measurements, other programs.

And how far halves of the field data lie apart.

    python benchmarks/adjustment.py            # the first three
    python benchmarks/adjustment.py speed
    python benchmarks/adjustment.py growth --measurements 1000 10000 100000
    python benchmarks/adjustment.py prior-art
    python benchmarks/adjustment.py halves --surveys 200 --seed 1

Processor time beside wall time, because only the former is repeatable on a busy machine. Seeds that were used while
building must not be reported.
"""

import argparse
import resource
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from scipy.special import chdtri

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

from prior_art import prior_art
from unit.adjustment import strips, timed_survey
from unit.likelihood import field_data

from linepose.adjustment import AdjustmentSettings, adjust
from linepose.adjustment.estimate import unit_weights
from linepose.adjustment.gradient import slopes_of_density
from linepose.adjustment.levels import Levels
from linepose.adjustment.measurements import measurements_from_survey
from linepose.adjustment.solve import model_at, pass_at
from linepose.adjustment.start import start_points
from linepose.adjustment.state import Knowledge, state_at
from linepose.geometry.distance import mahalanobis_between

HAND_MEASURED = np.array([0.200, 0.000, -0.800, -0.762, 0.762, -1.433])
LEVELS = Levels(0.8, 0.05, 0.4, 0.25, 0.6, 15.0, 0.5)


def milliseconds(function: Callable[[], object], repeats: int) -> tuple[float, float]:
    """Wall and thread time of one call, the best of five rounds."""
    function()
    wall, thread = [], []
    for _ in range(5):
        wall_start, thread_start = time.perf_counter(), time.thread_time()
        for _ in range(repeats):
            function()
        wall.append((time.perf_counter() - wall_start) / repeats)
        thread.append((time.thread_time() - thread_start) / repeats)
    return 1e3 * min(wall), 1e3 * min(thread)


def speed() -> None:
    """A pass, its gradient, a linearisation and a whole survey of 16 views of 15 points."""
    if field_data.PRESENT:
        survey, camera, pose = field_data.reverse_views().select(field_data.INLIERS), field_data.CAMERA, HAND_MEASURED
    else:
        survey, camera, pose = timed_survey.make_survey(16, 15), timed_survey.CAMERA, timed_survey.POSE
    measurements, knowledge = measurements_from_survey(survey, camera), Knowledge(camera, None)
    state = state_at(pose, camera, start_points(measurements, camera, pose), measurements)
    weights, structure = unit_weights(measurements), measurements.structure
    model = model_at(measurements, knowledge, state)
    if model is None:
        raise SystemExit("a point lies behind the camera at the start")
    process, done = pass_at(measurements, model, LEVELS, weights)
    for name, function, repeats in (
        ("linearisation", lambda: model_at(measurements, knowledge, state), 100),
        ("pass", lambda: pass_at(measurements, model, LEVELS, weights), 100),
        ("gradient", lambda: slopes_of_density(structure, model.image, process, LEVELS, weights, done), 100),
        ("survey", lambda: adjust(survey, camera, pose), 1),
    ):
        wall, thread = milliseconds(function, repeats)
        print(f"{name:14s} {wall:9.3f} ms wall {thread:9.3f} ms thread")


def growth(counts: list[int]) -> None:
    """Seconds and memory of whole adjustments of flights in strips, as measurements grow."""
    settings = AdjustmentSettings(line_period_s=strips.LINE_S)
    for count in counts:
        n_strips = 50 if count >= 10_000 else 10
        survey = strips.make_flight(n_strips, max(count // 12, 20))
        adjust(survey, strips.CAMERA, strips.POSE, settings=settings.replaced(n_draws=10))  # compiles
        wall, processor = time.perf_counter(), time.process_time()
        adjust(survey, strips.CAMERA, strips.POSE, settings=settings)
        wall, processor = time.perf_counter() - wall, time.process_time() - processor
        memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20
        print(
            f"{np.isfinite(survey.u_px).sum():8d} measurements, {survey.n_points:6d} points: {wall:.1f} s, "
            f"{processor:.1f} s of one core, at most {memory:.2f} GiB",
            flush=True,
        )


def halves(n_splits: int, seed: int) -> None:
    """How far random disjoint halves of the field data lie apart, in units of what is stated."""
    reverse, forward = field_data.reverse_views(), field_data.forward_views()
    sets = {
        "16 accepted": reverse.select(list(field_data.INLIERS)),
        "all 25": reverse,
        "25 forward views": forward,
    }
    settings = AdjustmentSettings(hand_measured_prior=False)
    for name, survey in sets.items():
        random, squares = np.random.default_rng(seed), []
        for _ in range(n_splits):
            order = random.permutation(survey.number)
            first, second = (
                adjust(survey.select(sorted(half.tolist())), field_data.CAMERA, HAND_MEASURED, settings=settings)
                for half in np.array_split(order, 2)
            )
            squares.append(mahalanobis_between(first.pose, first.covariance, second.pose, second.covariance) ** 2 / 6)
        root, median = np.sqrt(np.mean(squares)), np.sqrt(np.median(squares) * 6 / chdtri(6, 0.5))
        print(f"{name}, {n_splits} splits: {root:.3f} times as far apart as stated (root mean square), ", end="")
        print(f"{median:.3f} by the median", flush=True)


def main() -> None:
    """Measure what is asked for; halves only if asked, because they take long."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("what", nargs="?", choices=("speed", "growth", "prior-art", "halves"))
    parser.add_argument("--surveys", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--measurements", type=int, nargs="+", default=[1000, 10_000, 100_000])
    asked = parser.parse_args()
    if asked.what in (None, "speed"):
        print("The adjustment of 16 observations of 15 points, one core; to reach: a pass 0.15 ms, a survey 100 ms\n")
        speed()
    if asked.what in (None, "growth"):
        print("\nWhole adjustments of flights in strips; to reach: 100,000 measurements in 30 s, under 2 GB\n")
        growth(asked.measurements)
    if asked.what in (None, "prior-art"):
        print("\nOther programs on the same problem at the same levels\n")
        prior_art()
    if asked.what == "halves":
        halves(asked.surveys, asked.seed)


if __name__ == "__main__":
    main()

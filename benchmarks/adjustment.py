"""The adjustment measured: time of a pass and of a survey, how time grows with measurements, halves of the field data.

    python benchmarks/adjustment.py speed
    python benchmarks/adjustment.py growth --measurements 1000 10000 100000
    python benchmarks/adjustment.py halves --surveys 200 --seed 1

Processor time beside wall time, because only the former is repeatable on a busy machine. Seeds that were used while
building must not be reported.
"""

import argparse
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

from unit.adjustment import timed_survey
from unit.likelihood import field_data

from linepose.adjustment import AdjustmentSettings, adjust
from linepose.adjustment.estimate import unit_weights
from linepose.adjustment.gradient import slopes_of_density
from linepose.adjustment.iterative import blocks, conjugate_gradients, equations
from linepose.adjustment.levels import Levels
from linepose.adjustment.linearise import empty_linearised, linearise
from linepose.adjustment.measurements import Measurements, measurements_from_survey
from linepose.adjustment.process import components, error_image
from linepose.adjustment.solve import model_at, pass_at
from linepose.adjustment.start import start_points
from linepose.adjustment.state import Knowledge, State, state_at
from linepose.adjustment.whitening import factorise
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
    state = state_at(pose, camera, start_points(measurements, camera, pose), len(measurements.u_px))
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
    """Seconds to factor the error process and to solve the normal equations, as measurements grow."""
    for count in counts:
        n_views = max(count // 2000, 4)
        survey = timed_survey.make_survey(n_views, count // n_views, seed=1, gap_s=60.0)
        camera, pose = timed_survey.CAMERA, timed_survey.POSE
        measurements, knowledge = measurements_from_survey(survey, camera), Knowledge(camera, None)
        state = state_at(pose, camera, start_points(measurements, camera, pose), len(measurements.u_px))
        seconds, iterations = _solved(measurements, knowledge, state)
        print(
            f"{len(measurements.u_px):8d} measurements, {measurements.n_points:6d} points: "
            f"{seconds:.2f} s of one core, {iterations} iterations",
            flush=True,
        )


def _solved(measurements: Measurements, knowledge: Knowledge, state: State) -> tuple[float, int]:
    weights, structure = unit_weights(measurements), measurements.structure
    linearised = empty_linearised(len(measurements.u_px))
    optics = state.optics(knowledge.camera)
    for _ in range(2):  # the first compiles
        start = time.process_time()
        body, rates = state.body_poses(measurements), knowledge.rates(measurements)
        linearise(measurements.u_px, body, rates, measurements.point, state.points_m, optics, linearised)
        process = components(structure, error_image(structure, linearised), LEVELS, weights)
        factor = factorise(process, structure.view_of, structure.begins)
        system = equations(linearised, measurements.point, factor, knowledge.prior(state, measurements))
        right = system.right_side(linearised.residual_px.ravel())
        _, iterations = conjugate_gradients(system, blocks(system), right, 1e-7)
        seconds = time.process_time() - start
    return seconds, iterations


def halves(n_splits: int, seed: int) -> None:
    """How far random disjoint halves of the field's inliers lie apart, in units of what is stated."""
    survey, random = field_data.reverse_views(), np.random.default_rng(seed)
    settings, squares = AdjustmentSettings(hand_measured_prior=False), []
    for _ in range(n_splits):
        order = random.permutation(field_data.INLIERS)
        first, second = (
            adjust(survey.select(sorted(half)), field_data.CAMERA, HAND_MEASURED, settings=settings)
            for half in (order[:8], order[8:])
        )
        squares.append(mahalanobis_between(first.pose, first.covariance, second.pose, second.covariance) ** 2 / 6)
    print(f"{n_splits} splits: halves lie {np.sqrt(np.mean(squares)):.3f} times as far apart as stated")


def main() -> None:
    """Measure what is asked for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("what", choices=("speed", "growth", "halves"))
    parser.add_argument("--surveys", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--measurements", type=int, nargs="+", default=[1000, 10_000, 100_000])
    asked = parser.parse_args()
    if asked.what == "speed":
        speed()
    elif asked.what == "growth":
        growth(asked.measurements)
    else:
        halves(asked.surveys, asked.seed)


if __name__ == "__main__":
    main()

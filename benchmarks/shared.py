"""Speed of the shared-error models: ms an evaluation, ratio to dense matrices, seconds to a converged chain.

On the Ladybird field data where present, otherwise on a simulated survey of the same size. Processor time of the
thread beside wall time, because only the former is repeatable on a busy machine. Asked for: at most 0.5 ms an
evaluation of 16 observations, and in 60 s on two cores a chain with a split R-hat below 1.01 and 2,000 effective
samples.
"""

import argparse
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

from unit.likelihood import field_data, small_survey

from linepose.arrays import Floats
from linepose.estimation.diagnostics import diagnose_samples
from linepose.estimation.noise_models import BALANCED, ROBUST, SHARED, likelihood_of
from linepose.estimation.optimise import optimise
from linepose.estimation.sampling import IndependenceSettings, sample
from linepose.geometry.camera import Camera
from linepose.likelihood.balanced import BalancedLikelihood
from linepose.likelihood.robust import RobustSharedLikelihood
from linepose.likelihood.shared import SharedLikelihood
from linepose.likelihood.shared_kernel import empty_lines, levels_at, linearise, optics_at
from linepose.likelihood.shared_marginal import initial_points
from linepose.survey.observations import Survey

HAND_MEASURED = np.array([0.200, 0.000, -0.800, -0.762, 0.762, -1.433])
SCALE = np.array([*[0.05] * 3, *[0.01] * 3, *[0.5] * 3, 0.6, 3e-5])
SEED = 1


def survey_and_camera() -> tuple[Survey, Camera, Floats, tuple[int, ...]]:
    """The survey, its camera, the pose to start from, and the numbers of sixteen observations."""
    if field_data.PRESENT:
        return field_data.reverse_views(), field_data.CAMERA, HAND_MEASURED, field_data.INLIERS
    survey = small_survey.make_survey(25, 15, small_survey.Truth(0.5, 0.05, 1.5), seed=SEED)
    return survey, small_survey.CAMERA, small_survey.POSE, tuple(range(1, 17))


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


def dense_evaluation(likelihood: SharedLikelihood, vector: Floats) -> Callable[[], float]:
    """The same two steps with covariances of all lines of a view, stacked to one dense matrix (2 L, 2 L)."""
    arrays, count = likelihood._arrays, len(likelihood._points)
    optics, levels = optics_at(vector, likelihood._fixed), levels_at(vector)
    lines = empty_lines(len(arrays.u_px))
    rows = 2 * len(arrays.u_px)
    same_view = np.repeat(np.repeat(arrays.line_view[:, None] == arrays.line_view, 2, axis=0), 2, axis=1)

    def evaluate() -> float:
        _, points = initial_points(arrays, optics, count)
        for _ in range(2):
            linearise(arrays, optics, levels, points, lines)
            shared = lines.by_shared.reshape(rows, 6)
            covariance = np.where(same_view, shared @ shared.T, 0.0)
            design = np.zeros((rows, 3 * count))
            for line, point in enumerate(arrays.line_point):
                pair = slice(2 * line, 2 * line + 2)
                design[pair, 3 * point : 3 * point + 3] = lines.by_point[line]
                uu, uv, vv = lines.precision[line]
                covariance[pair, pair] += np.linalg.inv([[uu, uv], [uv, vv]])
            residual = lines.residual_px.ravel()
            solved = np.linalg.solve(covariance, np.column_stack([design, residual]))
            information = design.T @ solved[:, :-1]
            move = np.linalg.solve(information, design.T @ solved[:, -1])
            points = points + move.reshape(count, 3)
        chi_squared = residual @ solved[:, -1] - move @ information @ move
        return -0.5 * (chi_squared + np.linalg.slogdet(covariance)[1] + np.linalg.slogdet(information)[1])

    return evaluate


def chain(likelihood: SharedLikelihood, vector: Floats) -> str:
    """Draw a chain as the workflow does; what it took and gave, and what its diagnostics ask for."""
    wall, processor = time.perf_counter(), time.process_time()
    found = diagnose_samples(sample(likelihood, vector, SEED, IndependenceSettings()).parameters)
    wall, processor = time.perf_counter() - wall, time.process_time() - processor
    return (
        f"{wall:.1f} s wall, {processor:.1f} s processor; split R-hat {found.split_r_hat.max():.4f}, "
        f"effective samples {found.effective_sample_size.min():.0f}; {found.warning or 'converged'}"
    )


def report(likelihood: SharedLikelihood, pose: Floats, draw_chain: bool) -> None:
    """Print the measurements of one model of one survey."""
    begun, processor = time.perf_counter(), time.process_time()
    found = optimise(likelihood, pose)
    wall, processor = time.perf_counter() - begun, time.process_time() - processor
    vector = found.parameters
    print(f"{type(likelihood).__name__}, {likelihood.survey.n_observations} observations")
    print(f"  optimum            {wall:8.3f} s wall, {processor:8.3f} s processor, {found.n_evaluations} evaluations")
    single, thread = milliseconds(lambda: likelihood.log_likelihood(vector), 50)
    print(f"  one evaluation     {single:8.3f} ms wall, {thread:8.3f} ms thread")
    rows = vector + 0.1 * SCALE * np.random.default_rng(SEED).normal(size=(256, 11))
    batch, _ = milliseconds(lambda: likelihood.log_likelihoods(rows), 1)
    print(f"  one of a batch     {batch / len(rows):8.3f} ms wall")
    if not isinstance(likelihood, BalancedLikelihood | RobustSharedLikelihood):
        dense, dense_thread = milliseconds(dense_evaluation(likelihood, vector), 2)
        print(f"  dense matrices     {dense:8.3f} ms wall, {dense_thread:8.3f} ms thread")
        print(f"  ratio              {dense_thread / thread:8.0f}")
    if draw_chain:
        print(f"  converged chain    {chain(likelihood, vector)}", flush=True)


def main() -> None:
    """Print the measurements of the models with levels, on sixteen and on all observations."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--robust-chain", action="store_true", help="draw the robust model's chains too")
    with_robust = parser.parse_args().robust_chain
    survey, camera, pose, sixteen = survey_and_camera()
    print("field data" if field_data.PRESENT else "simulated survey")
    for name in (SHARED.name, BALANCED.name, ROBUST.name):
        for numbers in (sixteen, tuple(int(number) for number in survey.number)):
            likelihood = likelihood_of(name, survey.select(numbers), camera, pose)
            assert isinstance(likelihood, SharedLikelihood)
            report(likelihood, pose, name != ROBUST.name or with_robust)


if __name__ == "__main__":
    main()

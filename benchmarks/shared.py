"""Speed of the shared-error models: ms an evaluation, ratio to dense matrices, seconds to a converged chain.

On the Ladybird field data where present, otherwise on a simulated survey of the same size. Processor time of the
thread beside wall time, because only the former is repeatable on a busy machine. `--chain` draws the chains too.
"""

import argparse
import sys
import time
from collections.abc import Callable
from pathlib import Path

import emcee
import numpy as np
from scipy.optimize import minimize

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "unit" / "likelihood"))

import field_data
import small_survey

from linepose.camera import Camera
from linepose.likelihood.robust import RobustSharedLikelihood
from linepose.likelihood.shared import SharedLikelihood
from linepose.likelihood.shared_kernel import empty_lines, levels_at, linearise, optics_at
from linepose.likelihood.shared_marginal import initial_points
from linepose.moves import independence_move
from linepose.observations import Survey
from linepose.rotations import Floats

HAND_MEASURED = np.array([0.200, 0.000, -0.800, -0.762, 0.762, -1.433])
SCALE = np.array([*[0.05] * 3, *[0.01] * 3, *[0.5] * 3, 0.6, 3e-5])
WALKERS, WARM_UP, KEPT = 64, 400, 800
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


def optimum(likelihood: SharedLikelihood, pose: Floats) -> Floats:
    """Parameters at the optimum."""
    start = likelihood.start(pose)
    found = minimize(lambda step: -likelihood.log_likelihood(start + step * SCALE), np.zeros(11), method="BFGS")
    return start + found.x * SCALE


def split_r_hat(chain: Floats) -> float:
    """Largest split R-hat of a chain (steps, walkers, P), each walker a chain."""
    half = len(chain) // 2
    halves = np.concatenate([chain[:half], chain[half : 2 * half]], axis=1)
    within, between = halves.var(axis=0, ddof=1).mean(axis=0), halves.mean(axis=0).var(axis=0, ddof=1)
    return float(np.sqrt((half - 1) / half + between / within).max())


def chain(likelihood: SharedLikelihood, vector: Floats) -> str:
    """Warm up with differential evolution, then propose from the warm-up's Gaussian; what it took and gave."""
    differential = [(emcee.moves.DEMove(), 0.8), (emcee.moves.DESnookerMove(), 0.2)]
    wall, processor = time.perf_counter(), time.process_time()
    state: emcee.State | Floats = vector + likelihood.scatter(0.01, 0.003) * np.random.default_rng(SEED).normal(
        size=(WALKERS, 11)
    )
    moves = differential
    for steps in (WARM_UP, KEPT):
        sampler = emcee.EnsembleSampler(WALKERS, 11, likelihood.log_likelihoods, vectorize=True, moves=moves)
        sampler.random_state = np.random.RandomState(SEED).get_state()
        state = sampler.run_mcmc(state, steps).coords
        samples = sampler.get_chain()[-steps // 2 :].reshape(-1, 11)
        independence = independence_move(samples.mean(axis=0), np.cov(samples.T))
        moves = [(independence, 0.8), *((move, 0.2 * share) for move, share in differential)]
    wall, processor = time.perf_counter() - wall, time.process_time() - processor
    kept = sampler.get_chain()
    tau = emcee.autocorr.integrated_time(kept, tol=0).max()
    return (
        f"{wall:.1f} s wall, {processor:.1f} s processor; split R-hat {split_r_hat(kept):.4f}, "
        f"effective samples {kept.shape[0] * WALKERS / tau:.0f}"
    )


def report(likelihood: SharedLikelihood, pose: Floats, draw_chain: bool) -> None:
    """Print the measurements of one model of one survey."""
    vector = optimum(likelihood, pose)
    print(f"{type(likelihood).__name__}, {likelihood.survey.n_observations} observations")
    single, thread = milliseconds(lambda: likelihood.log_likelihood(vector), 50)
    print(f"  one evaluation     {single:8.3f} ms wall, {thread:8.3f} ms thread")
    rows = vector + 0.1 * SCALE * np.random.default_rng(SEED).normal(size=(256, 11))
    batch, _ = milliseconds(lambda: likelihood.log_likelihoods(rows), 1)
    print(f"  one of a batch     {batch / len(rows):8.3f} ms wall")
    if not isinstance(likelihood, RobustSharedLikelihood):
        dense, dense_thread = milliseconds(dense_evaluation(likelihood, vector), 2)
        print(f"  dense matrices     {dense:8.3f} ms wall, {dense_thread:8.3f} ms thread")
        print(f"  ratio              {dense_thread / thread:8.0f}")
    if draw_chain:
        print(f"  converged chain    {chain(likelihood, vector)}", flush=True)


def main() -> None:
    """Print the measurements of both models, on sixteen and on all observations."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--chain", action="store_true", help="draw the chains too")
    draw_chain = parser.parse_args().chain
    survey, camera, pose, sixteen = survey_and_camera()
    print("field data" if field_data.PRESENT else "simulated survey")
    for model in (SharedLikelihood, RobustSharedLikelihood):
        for numbers in (sixteen, tuple(int(number) for number in survey.number)):
            report(model(survey.select(numbers), camera), pose, draw_chain)


if __name__ == "__main__":
    main()

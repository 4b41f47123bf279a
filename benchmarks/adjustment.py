"""The adjustment measured: time of a pass and of a survey, how time grows with measurements, coverage, faults, halves.

    python benchmarks/adjustment.py speed
    python benchmarks/adjustment.py growth --measurements 1000 10000 100000
    python benchmarks/adjustment.py coverage --surveys 200 --seed 1 [--prior]
    python benchmarks/adjustment.py faults --surveys 20 --seed 1
    python benchmarks/adjustment.py halves --surveys 200 --seed 1

Processor time beside wall time, because only the former is repeatable on a busy machine. Seeds that were used while
building must not be reported.
"""

import argparse
import sys
import time
import zlib
from collections.abc import Callable
from pathlib import Path

import numpy as np
from scipy.stats import kstest

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

from unit.adjustment import timed_survey
from unit.likelihood import field_data

from linepose.adjustment import Adjustment, AdjustmentSettings, adjust
from linepose.adjustment.estimate import unit_weights
from linepose.adjustment.gradient import slopes_of_density
from linepose.adjustment.iterative import blocks, conjugate_gradients, equations
from linepose.adjustment.levels import Levels
from linepose.adjustment.linearise import empty_linearised, linearise
from linepose.adjustment.measurements import Measurements, measurements_from_survey
from linepose.adjustment.process import components, error_image
from linepose.adjustment.settings import default_hand_covariance
from linepose.adjustment.solve import model_at, pass_at
from linepose.adjustment.start import start_points
from linepose.adjustment.state import Knowledge, State, state_at
from linepose.adjustment.whitening import factorise
from linepose.arrays import Floats
from linepose.config.platform import load_platform
from linepose.errors import LineposeError
from linepose.geometry.distance import mahalanobis_between, pose_difference
from linepose.geometry.pose import POSE_COLUMNS
from linepose.geometry.rotations import matrix_from_rotation_vector, rotation_vector_from_matrix
from linepose.simulation.noise_levels import NoiseLevels
from linepose.simulation.noisy_survey import draw_survey
from linepose.simulation.survey import faulty_observations, simulate_survey

HAND_MEASURED = np.array([0.200, 0.000, -0.800, -0.762, 0.762, -1.433])
PLATFORMS = ("ladybird-sim", "shrimp-sim")
FOLDER = Path(__file__).parents[1] / "config" / "platforms"
REGIMES = {
    "white": NoiseLevels(white_level=1.0),
    "shared": NoiseLevels(shared_level=1.0),
    "mixed": NoiseLevels(shared_level=0.7071, white_level=0.7071),
    **{f"Gauss-Markov {t} s": NoiseLevels(correlated_level=1.0, correlation_time_s=t) for t in (5, 15, 60, 600)},
    "Gauss-Markov + white": NoiseLevels(correlated_level=0.7071, white_level=0.7071),
}
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


def credibility(found: Adjustment, truth: Floats) -> float:
    """Share of the posterior nearer to its mean than the truth, in Mahalanobis distance."""
    steps = pose_difference(found.samples[list(POSE_COLUMNS)].to_numpy().copy(), found.pose)
    mean, root = steps.mean(axis=0), np.linalg.cholesky(np.cov(steps.T))
    distance = np.linalg.norm(np.linalg.solve(root, (steps - mean).T), axis=0)
    own = np.linalg.norm(np.linalg.solve(root, pose_difference(truth, found.pose) - mean))
    return float(np.mean(distance < own))


def coverage(n_surveys: int, seed: int, prior: bool) -> None:
    """Share of 68 and 95 % regions that hold the truth, and error in sigmas, of every regime and platform."""
    all_credibility, all_scaled, failed = [], [], 0
    for regime, levels in REGIMES.items():
        for name in PLATFORMS:
            platform = load_platform(FOLDER, name)
            camera, simulation = platform.intrinsics(), platform.simulation
            held, errors, sigmas = [], [], []
            for index in range(n_surveys):
                random = np.random.default_rng([seed, zlib.crc32(f"{regime} {name}".encode()), index])
                survey, truth = draw_survey(camera, simulation, levels, random)
                pose = _drawn_hand(truth, random) if prior else platform.start_pose()
                settings = AdjustmentSettings(
                    hand_measured_prior=prior, line_period_s=1 / simulation.image.line_rate_hz
                )
                try:
                    found = adjust(survey, camera, pose, settings=settings)
                except LineposeError as error:
                    print(f"{regime} {name} {index} failed: {error}")
                    failed += 1
                    continue
                held.append(credibility(found, truth))
                errors.append(pose_difference(found.pose, truth))
                sigmas.append(np.sqrt(np.diag(np.cov(_steps(found).T))))
            scaled = np.array(errors) / np.array(sigmas)
            millimetres = 1e3 * np.sqrt(np.mean(np.array(errors)[:, :3] ** 2, axis=0))
            print(
                f"{regime:22s} {name:14s} {np.mean(np.array(held) < 0.68):.2f}/{np.mean(np.array(held) < 0.95):.2f} "
                f"ratio {np.sqrt(np.mean(scaled**2)):.2f} RMSE {millimetres.round().tolist()} mm",
                flush=True,
            )
            all_credibility += held
            all_scaled.append(scaled)
    pooled = np.array(all_credibility)
    print(
        f"all {len(pooled)}: {np.mean(pooled < 0.68):.3f}/{np.mean(pooled < 0.95):.3f}, "
        f"ratio {np.sqrt(np.mean(np.concatenate(all_scaled) ** 2)):.3f}, "
        f"uniform p {kstest(pooled, 'uniform').pvalue:.3f}, failed {failed}"
    )


def _steps(found: Adjustment) -> Floats:
    return pose_difference(found.samples[list(POSE_COLUMNS)].to_numpy().copy(), found.pose)


def _drawn_hand(truth: Floats, random: np.random.Generator) -> Floats:
    error = random.standard_normal(6) * np.sqrt(np.diag(default_hand_covariance()))
    turned = matrix_from_rotation_vector(error[3:]) @ matrix_from_rotation_vector(truth[3:])
    return np.concatenate([truth[:3] + error[:3], rotation_vector_from_matrix(turned)])


def faults(n_surveys: int, seed: int) -> None:
    """Position error with gross faults left in, beside that of an oracle that removes them."""
    for name in PLATFORMS:
        platform = load_platform(FOLDER, name)
        camera, simulation = platform.intrinsics(), platform.simulation
        settings = AdjustmentSettings(hand_measured_prior=False, line_period_s=1 / simulation.image.line_rate_hz)
        errors: dict[str, list[Floats]] = {"all": [], "oracle": []}
        scaled = []
        for index in range(n_surveys):
            survey, truth = simulate_survey(camera, simulation, seed + index)
            good = survey.select([n for n in survey.number if n not in faulty_observations(simulation)])
            for kind, one in (("all", survey), ("oracle", good)):
                found = adjust(one, camera, platform.start_pose(), settings=settings)
                errors[kind].append(found.pose[:3] - truth.pose[:3])
                if kind == "all":
                    scaled.append((found.pose - truth.pose) / found.sigma)
        with_all, oracle = (1e3 * np.sqrt(np.mean(np.sum(np.square(errors[k]), axis=1))) for k in ("all", "oracle"))
        print(f"{name}: {with_all:.0f} mm, oracle {oracle:.0f} mm, in sigmas {np.sqrt(np.mean(np.square(scaled))):.2f}")


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
    parser.add_argument("what", choices=("speed", "growth", "coverage", "faults", "halves"))
    parser.add_argument("--surveys", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--prior", action="store_true", help="hand measurement drawn from its prior, and counted")
    parser.add_argument("--measurements", type=int, nargs="+", default=[1000, 10_000, 100_000])
    asked = parser.parse_args()
    if asked.what == "speed":
        speed()
    elif asked.what == "growth":
        growth(asked.measurements)
    elif asked.what == "coverage":
        coverage(asked.surveys, asked.seed, asked.prior)
    elif asked.what == "faults":
        faults(asked.surveys, asked.seed)
    else:
        halves(asked.surveys, asked.seed)


if __name__ == "__main__":
    main()

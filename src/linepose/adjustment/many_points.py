"""Surveys of many points: levels from some of the points, the pose from all of them.

Levels are properties of the navigation system and the camera, which a few hundred points tell as well as ten thousand;
their density needs determinants, for which the dense normal equations of those few are formed. With the levels so found
the pose is the minimum of chi squared over all measurements, by conjugate gradients.

Levels that are a little off pull the pose by an amount that does not shrink with the number of points, as its sigma
does. So the spread over the draws of the levels is that of all measurements too: the pose is found again with each
level moved, and follows the draws linearly. The covariance given levels and the curvature are the few's, in units of
the covariance that all have.
"""

from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from linepose.adjustment.estimate import unit_weights
from linepose.adjustment.iterative import Equations, Preconditioner, blocks, conjugate_gradients, equations, smooth
from linepose.adjustment.levels import Levels, levels_from_log
from linepose.adjustment.measurements import Measurements
from linepose.adjustment.normal import N_POSE
from linepose.adjustment.posterior import Mixture
from linepose.adjustment.process import Weights, components, corrections, error_image
from linepose.adjustment.start import behind_at_start
from linepose.adjustment.state import Knowledge, State, camera_step, linearised_at
from linepose.adjustment.thresholds import DEGREES_OF_FREEDOM, MEASUREMENT_DIMENSION
from linepose.adjustment.whitening import factorise, unwhiten, whiten_residual
from linepose.arrays import Floats
from linepose.survey.observations import Survey

MANY_POINTS: Final = 150  # above which the normal equations are not formed as a matrix
FEW_POINTS: Final = 60  # that then tell the levels
_TOLERANCE: Final = 1e-6  # of chi squared
_PRECISION: Final = 1e-3  # of a step, in the preconditioner's norm; what is left the next step takes
_COVARIANCE_PRECISION: Final = 1e-4
_MOST_STEPS: Final = 30
_LARGEST_MOVE: Final = 0.3  # of a point, in distances from the nearest body
_LOOSE: Final = 1e-2  # of chi squared, where weights move
_WEIGHT_TOLERANCE: Final = 0.1  # of a logarithm
_LEAST_SPREAD: Final = 1e-6  # of a level's logarithm, below which it was not estimated
_WEIGHT_SUM: Final = DEGREES_OF_FREEDOM + MEASUREMENT_DIMENSION


@dataclass(frozen=True)
class ManySolution:
    """A minimum of chi squared over all measurements.

    camera_covariance (10 + C, 10 + C): of the camera's columns; whitened (L, 2):
    residuals; z (L, 6), q (N, 6): the process; weights: of the tails; chi_squared; n_steps; converged.
    """

    state: State
    camera_covariance: Floats
    whitened: Floats
    z: Floats
    q: Floats
    weights: Weights
    chi_squared: float
    n_steps: int
    converged: bool


def some_points(survey: Survey, seed: int, always: np.ndarray | None = None) -> Survey:
    """The survey of as many points as determinants are formed for, drawn from those that most views have.

    always (M,): points that are taken beside these, of which something is known, but no more than as many again.
    """
    count = np.isfinite(survey.u_px).sum(axis=0)
    often = np.flatnonzero(count >= max(np.median(count[count > 0]), 2))
    random = np.random.default_rng([seed, 2])
    chosen = random.choice(often, size=min(FEW_POINTS, len(often)), replace=False)
    left = np.ones(survey.n_points, dtype=bool)
    left[chosen] = False
    if always is not None:
        seen = np.flatnonzero(always & left & (count > 0))
        left[random.permutation(seen)[: MANY_POINTS - FEW_POINTS]] = False
    u_px = survey.u_px.copy()
    u_px[:, left] = np.nan
    return replace(survey, u_px=u_px)


def solve_many(
    measurements: Measurements,
    knowledge: Knowledge,
    start: State,
    levels: Levels,
    weights: Weights,
    *,
    tails: bool = False,
    covariance: bool = True,
) -> ManySolution:
    """The minimum of chi squared near a start, by Gauss-Newton; memory and time are linear in the measurements.

    With `tails` every step weighs each measurement by its two whitened residuals, w = 6 / (4 + d); without `covariance`
    that of the camera is NaN, which saves a third of the time. Raises EstimationError where a point is behind the
    camera, or the normal equations cannot be solved.
    """
    structure = measurements.structure
    state, steps, displacements = start, 0, None
    while True:
        linearised = linearised_at(measurements, knowledge, state)
        if linearised is None:
            raise behind_at_start(measurements, state.pose, state.points_m)
        process = components(structure, error_image(structure, linearised), levels, weights)
        factor = factorise(process, structure.view_of, structure.begins)
        system = equations(linearised, measurements.point, factor, knowledge.prior(state, measurements))
        displacements = displacements or smooth(system, state.points_m)
        inverse = Preconditioner(blocks(system), displacements)
        residual = linearised.residual_px + np.einsum("lri,li->lr", linearised.by_body, state.correction)
        right = system.right_side(residual)
        step, _ = conjugate_gradients(system, inverse, right, _PRECISION)
        gain = float(right @ step)
        whitened = whiten_residual(factor, residual - system.times_design(step))
        dual = unwhiten(factor, whitened)
        correction, z, q = corrections(structure, process, linearised, levels, weights, dual)
        before = weights.of_measurement
        if tails:
            squares = np.sum(whitened**2, axis=1) / before
            weights = weights._replace(of_measurement=_WEIGHT_SUM / (DEGREES_OF_FREEDOM + squares))
        settled = bool(np.max(np.abs(np.log(weights.of_measurement / before))) < _WEIGHT_TOLERANCE)
        converged = gain < (_LOOSE if tails else _TOLERANCE) and settled
        if converged or steps >= _MOST_STEPS:
            break
        state, steps = state.moved(_held(step, state, measurements), correction), steps + 1
    chi_squared = float(np.sum(whitened**2)) + system.prior.chi_squared
    nothing = np.full(system.prior.camera.shape, np.nan)
    known = _camera_covariance(system, inverse) if covariance else nothing
    return ManySolution(state, known, whitened, z, q, weights, chi_squared, steps, converged)


def _held(step: Floats, state: State, measurements: Measurements) -> Floats:
    """The step (3 K + 10 + C,) with no point moved by more than a share of its distance from the nearest body.

    Of two nearly parallel rays, one of which is a wrong match, the linear model throws the point behind the camera
    before the match has lost its weight.
    """
    away = np.linalg.norm(state.points_m[measurements.point] - measurements.body_pose[:, :3], axis=1)
    nearest = np.full(measurements.n_points, np.inf)
    np.minimum.at(nearest, measurements.point, away)
    n = 3 * measurements.n_points
    points = step[:n].reshape(-1, 3)
    length = np.linalg.norm(points, axis=1)
    share = np.minimum(1.0, _LARGEST_MOVE * nearest / np.maximum(length, np.finfo(float).tiny))
    return np.concatenate([(share[:, None] * points).ravel(), step[n:]])


def covariance_of_many(measurements: Measurements, knowledge: Knowledge, state: State, levels: Levels) -> Floats:
    """Covariance (10 + C, 10 + C) of the camera's columns at a state and levels, which need not be a minimum.

    Raises EstimationError where a point lies behind the camera, or the normal equations cannot be solved.
    """
    linearised = linearised_at(measurements, knowledge, state)
    if linearised is None:
        raise behind_at_start(measurements, state.pose, state.points_m)
    structure = measurements.structure
    process = components(structure, error_image(structure, linearised), levels, unit_weights(measurements))
    factor = factorise(process, structure.view_of, structure.begins)
    system = equations(linearised, measurements.point, factor, knowledge.prior(state, measurements))
    return _camera_covariance(system, Preconditioner(blocks(system), smooth(system, state.points_m)))


def _camera_covariance(system: Equations, inverse: Preconditioner) -> Floats:
    """Covariance (10 + C, 10 + C) of the camera's columns."""
    n_points, n_camera = 3 * system.n_points, len(system.prior.camera)
    covariance = np.empty((n_camera, n_camera))
    for i in range(n_camera):
        unit = np.zeros(n_points + n_camera)
        unit[n_points + i] = 1.0
        covariance[i] = conjugate_gradients(system, inverse, unit, _COVARIANCE_PRECISION)[0][n_points:]
    return (covariance + covariance.T) / 2


def spread_of_many(few: Mixture, few_covariance: Floats, covariance: Floats, mode: Floats, slopes: Floats) -> Mixture:
    """The mixture of few points as that of many, whose covariance is (S, S), from that of few.

    slopes (7, S): of the sought columns by the logarithms of the levels, whose mode is (7,).
    """
    scale = np.linalg.cholesky(covariance) @ np.linalg.inv(np.linalg.cholesky(few_covariance))
    known = np.isfinite(mode)
    off = np.where(known, few.log_levels, 0.0) - np.where(known, mode, 0.0)
    return replace(few, mean=off @ slopes, covariance=scale @ few.covariance @ scale.T)


def slopes_by_levels(
    measurements: Measurements, knowledge: Knowledge, found: ManySolution, few: Mixture, log_levels: Floats
) -> Floats:
    """How the sought columns (7, S) follow the logarithms of the levels, each moved by its sigma among the draws.

    The weights of measurements are held. Zero for levels that are not estimated.
    """
    draws = np.where(np.isfinite(log_levels), few.log_levels, 0.0)
    sigma = np.sqrt(few.weight @ (draws - few.weight @ draws) ** 2)
    slopes = np.zeros((len(log_levels), knowledge.n_sought))
    for index in np.flatnonzero(sigma > _LEAST_SPREAD):
        moved = log_levels.copy()
        moved[index] += sigma[index]
        there = solve_many(
            measurements, knowledge, found.state, levels_from_log(moved), found.weights, covariance=False
        )
        slopes[index] = camera_step(found.state, there.state)[-knowledge.n_sought :] / sigma[index]
    return slopes


def normalised_of_many(solution: ManySolution, n_points: int) -> Floats:
    """Whitened residuals (L, 2) divided by the sigma that all have on the mean."""
    redundancy = 1 - (3 * n_points + N_POSE) / solution.whitened.size
    return solution.whitened / np.sqrt(max(redundancy, 1e-3))

"""An adjustment of all measurements at once, where their normal equations are small: fit, curvature and posterior."""

from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from linepose.adjustment.contradictions import UNCOUNTED, KnownPointsFit, fit_of_known
from linepose.adjustment.curvature import Curvature, curvature
from linepose.adjustment.estimate import Estimate, unit_weights
from linepose.adjustment.hand_measured import HandMeasuredPrior, ran_off
from linepose.adjustment.heavy_tailed import with_tails
from linepose.adjustment.measurements import Measurements
from linepose.adjustment.normal import point_covariances, trailing_inverse
from linepose.adjustment.posterior import Mixture, mixture
from linepose.adjustment.process import Weights
from linepose.adjustment.residuals import normalised_residuals
from linepose.adjustment.settings import AdjustmentSettings
from linepose.adjustment.solve import Solution, solve
from linepose.adjustment.start import start_points
from linepose.adjustment.state import Knowledge, State, state_at
from linepose.arrays import Floats
from linepose.errors import EstimationError

_TURNS: Final = 6  # of estimate and weights of known points
_SETTLED: Final = 0.2  # of the logarithm of a weight
_TOLERANCE: Final = 1e-4  # of chi squared, where only weights of known points are asked for


@dataclass(frozen=True)
class Fit:
    """The minimum of chi squared over all measurements.

    z (L, 6), q (N, 6): the process; weights: of the tails; normalised (L, 2): residuals; chi_squared; converged;
    point_covariance (K, 3, 3): NaN where it is not known; camera_covariance (10 + C, 10 + C): of the camera's columns,
    at the levels' mode.
    """

    state: State
    z: Floats
    q: Floats
    weights: Weights
    normalised: Floats
    chi_squared: float
    converged: bool
    point_covariance: Floats
    camera_covariance: Floats


@dataclass(frozen=True)
class AllAtOnce:
    """fit, found, curved and spread of the adjustment; known: how known points fit (K,)."""

    fit: Fit
    found: Estimate
    curved: Curvature
    spread: Mixture
    known: KnownPointsFit


def adjust_all(
    measurements: Measurements,
    knowledge: Knowledge,
    start_pose: Floats,
    hand: HandMeasuredPrior,
    settings: AdjustmentSettings,
) -> AllAtOnce:
    """The adjustment from a start pose (6,); raises EstimationError where there is no estimate."""
    known = measurements.known
    points = start_points(measurements, knowledge.camera, start_pose)
    points = known.on_its_board(points, np.bincount(measurements.point, minlength=measurements.n_points))
    start = state_at(start_pose, knowledge.camera, points, measurements)
    guided = replace(knowledge, hand=hand)
    weight = _first_weights(measurements, guided, start, settings)
    for _ in range(_TURNS):
        counted = replace(measurements, known=known.weighted(weight))
        found = with_tails(counted, knowledge, guided, start, settings)
        fitted = _fit(measurements, weight, found.solution)
        if np.max(np.abs(np.log(fitted.counted / weight)), initial=0.0) < _SETTLED:
            break
        weight = fitted.counted
    curved = curvature(counted, knowledge, found.solution, found.levels, found.weights)
    spread = mixture(found.restricted, found.log_levels, curved.stretch, settings.n_draws, settings.seed)
    solution = found.solution
    fit = Fit(
        solution.state,
        solution.z,
        solution.q,
        found.weights,
        normalised_residuals(solution.done),
        solution.done.chi_squared,
        found.converged and not ran_off(hand, solution.state.position_m),
        point_covariances(solution.done.upper, known.shifts),
        trailing_inverse(solution.done.upper, len(solution.model.prior.camera)),
    )
    return AllAtOnce(fit, found, curved, spread, fitted)


def _first_weights(
    measurements: Measurements, knowledge: Knowledge, start: State, settings: AdjustmentSettings
) -> Floats:
    """Weights (K,) of known points against an adjustment in which none of them counts; one where there is none."""
    apart = measurements.known.apart
    weight = np.where(apart, UNCOUNTED, 1.0)
    if not np.any(apart):
        return weight
    without = replace(measurements, known=measurements.known.weighted(weight))
    levels = settings.start if measurements.timed else settings.start._replace(drift=0.0)
    try:
        solution = solve(without, knowledge, start, levels, unit_weights(without), tolerance=_TOLERANCE)
    except EstimationError:
        return np.ones(len(weight))
    return _fit(measurements, weight, solution).counted


def _fit(measurements: Measurements, weight: Floats, solution: Solution) -> KnownPointsFit:
    """How known points fit a solution in which they had weights (K,)."""
    known = measurements.known
    if not np.any(known.apart):
        nothing = np.full(len(weight), np.nan)
        return KnownPointsFit(nothing, nothing)
    covariance = point_covariances(solution.done.upper, known.shifts)
    return fit_of_known(known, weight, solution.state.points_m, covariance)

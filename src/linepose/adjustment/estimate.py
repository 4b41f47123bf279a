"""The estimate: Gauss-Newton at fixed levels and levels at a fixed linearisation, in turn, until neither moves."""

from dataclasses import dataclass
from typing import Final

import numpy as np

from linepose.adjustment.levels import LEVEL_NAMES, Levels, levels_from_log, log_from_levels
from linepose.adjustment.measurements import Measurements
from linepose.adjustment.process import Weights
from linepose.adjustment.reml import Restricted, most_likely, shortened
from linepose.adjustment.settings import AdjustmentSettings
from linepose.adjustment.solve import Solution, solve
from linepose.adjustment.state import Knowledge, State
from linepose.arrays import Floats

LEVEL_TOLERANCE: Final = 0.02  # of a logarithm, in one round
_SLOPES: Final = (0.2, 0.01)  # of the levels' density where their search ends, in the first round and later
_TIGHT, _LOOSE = 1e-6, 1e-4  # of chi squared, at the end and while levels move
_OF_DRIFT: Final = ("drift", "correlation_time_s")


@dataclass(frozen=True)
class Estimate:
    """Solution at the most likely levels.

    log_levels (F,): of those that are free; restricted: their density there; weights: of the tails; log_evidence: the
    density at the levels, for weights with what they add to it.
    """

    solution: Solution
    levels: Levels
    log_levels: Floats
    restricted: Restricted
    weights: Weights
    log_evidence: float
    n_rounds: int
    n_passes: int
    converged: bool


def free_levels(measurements: Measurements) -> tuple[int, ...]:
    """Indices of the levels that the measurements can tell: without times there is no drift."""
    return tuple(i for i, name in enumerate(LEVEL_NAMES) if measurements.timed or name not in _OF_DRIFT)


def unit_weights(measurements: Measurements) -> Weights:
    """No tails: every weight one."""
    return Weights(np.ones(measurements.n_views), np.ones(len(measurements.u_px)))


def estimate(
    measurements: Measurements,
    knowledge: Knowledge,
    start: State,
    levels: Levels,
    weights: Weights,
    settings: AdjustmentSettings,
    *,
    damping: float = 0.0,
) -> Estimate:
    """The estimate from a start; raises EstimationError as `solve` does."""
    free = free_levels(measurements)
    logs = log_from_levels(levels)
    if not measurements.timed:
        logs[LEVEL_NAMES.index("drift")] = -np.inf
        levels = levels_from_log(logs)
    state, passes, settled, rounds, share, last = start, 0, False, 0, 1.0, None
    while True:
        ends = settled or rounds >= settings.max_rounds
        tolerance = _TIGHT if ends else _LOOSE
        solution = solve(measurements, knowledge, state, levels, weights, damping=damping, tolerance=tolerance)
        restricted = Restricted(measurements, solution.model, weights, settings.priors, free, logs)
        before = restricted.start(levels)
        if ends:
            break
        after, count = most_likely(restricted, before, _SLOPES[min(rounds, 1)])
        rounds, passes = rounds + 1, passes + count
        move = after - before
        share, last = shortened(share, move, last), move
        logs = restricted.log_levels(before + share * move)
        levels, state = levels_from_log(logs), solution.state
        settled = bool(np.max(np.abs(move)) < LEVEL_TOLERANCE)
    evidence = -restricted.negative_log_density(before)
    return Estimate(
        solution, levels, before, restricted, weights, evidence, rounds, passes, settled and solution.converged
    )

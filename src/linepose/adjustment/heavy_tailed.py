"""The estimate under heavy tails, and whether they are there at all."""

from dataclasses import replace
from typing import Final

import numpy as np

from linepose.adjustment.estimate import Estimate, estimate, free_levels, unit_weights
from linepose.adjustment.levels import Levels, levels_from_log, log_from_levels
from linepose.adjustment.measurements import Measurements
from linepose.adjustment.process import Weights
from linepose.adjustment.reml import Restricted, most_likely
from linepose.adjustment.settings import Settings
from linepose.adjustment.solve import solve
from linepose.adjustment.state import Knowledge, State
from linepose.adjustment.tails import bound_of_weights, expected_squares, expected_weights
from linepose.errors import EstimationError

SCREEN_NATS: Final = 10.0  # by which heavy tails may look worse at the normal model's estimate and are yet tried
_WEIGHT_TOLERANCE: Final = 0.03  # of a logarithm
_LEVEL_TOLERANCE: Final = 0.02  # of a logarithm
_SWEEPS: Final = 6  # of weights at fixed levels
_ROUNDS: Final = 10
_LOOSE: Final = 1e-3  # of chi squared, while weights move


def with_tails(
    measurements: Measurements,
    knowledge: Knowledge,
    guided: Knowledge,
    start: State,
    settings: Settings,
) -> Estimate:
    """The better of the normal model and the heavy-tailed one, by evidence.

    `guided` knows the hand measurement whatever the settings say: where many views are bad, the weights are found with
    its help before the pose is let go. Raises EstimationError where neither model has an estimate.
    """
    normal, failure = None, None
    try:
        normal = estimate(measurements, knowledge, start, settings.start, unit_weights(measurements), settings)
    except EstimationError as error:
        failure = error
    if not settings.tails or (normal is not None and normal.converged and _hopeless(normal)):
        if normal is None:
            raise failure or EstimationError("adjustment: no estimate")
        return normal
    try:
        first = _heavy_tailed(measurements, guided, start, settings.start, unit_weights(measurements), settings)
        heavy = _heavy_tailed(measurements, knowledge, first.solution.state, first.levels, first.weights, settings)
    except EstimationError as error:
        if normal is None:
            raise failure or error from error
        return normal
    return heavy if normal is None or heavy.log_evidence > normal.log_evidence else normal


def _hopeless(normal: Estimate) -> bool:
    """Whether heavy tails are so much worse at the normal model's estimate that they need not be tried."""
    weights, restricted = normal.weights, normal.restricted
    levels, measurements = normal.levels, restricted.measurements
    for _ in range(3):
        squares = expected_squares(measurements, restricted.knowledge, normal.solution.model, levels, weights)
        weights = expected_weights(squares)
    density = replace(restricted, weights=weights).negative_log_density(normal.log_levels)
    return bool(bound_of_weights(weights) - density < normal.log_evidence - SCREEN_NATS)


def _heavy_tailed(
    measurements: Measurements,
    knowledge: Knowledge,
    state: State,
    levels: Levels,
    weights: Weights,
    settings: Settings,
) -> Estimate:
    """Weights, solution and levels in turn; the evidence is the lower bound."""
    free, logs = free_levels(measurements), log_from_levels(levels)
    if not measurements.timed:
        logs[0] = -np.inf
        levels = levels_from_log(logs)
    passes, settled = 0, False
    for rounds in range(1, _ROUNDS + 1):
        moved = np.inf
        for _ in range(_SWEEPS):
            solution = solve(measurements, knowledge, state, levels, weights, tolerance=_LOOSE)
            state = solution.state
            after = expected_weights(expected_squares(measurements, knowledge, solution.model, levels, weights))
            moved = _change(after, weights)
            weights = after
            if moved < _WEIGHT_TOLERANCE:
                break
        restricted = Restricted(measurements, knowledge, solution.model, weights, settings.priors, free, logs)
        before = restricted.start(levels)
        log_levels, count = most_likely(restricted, before)
        passes += count
        logs = restricted.log_levels(log_levels)
        levels = levels_from_log(logs)
        settled = bool(np.max(np.abs(log_levels - before)) < _LEVEL_TOLERANCE and moved < _WEIGHT_TOLERANCE)
        if settled:
            break
    solution = solve(measurements, knowledge, state, levels, weights)
    restricted = Restricted(measurements, knowledge, solution.model, weights, settings.priors, free, logs)
    evidence = bound_of_weights(weights) - restricted.negative_log_density(log_levels)
    return Estimate(
        solution, levels, log_levels, restricted, weights, evidence, rounds, passes, settled and solution.converged
    )


def _change(after: Weights, before: Weights) -> float:
    """The largest change of a weight's logarithm."""
    return float(
        max(
            np.max(np.abs(np.log(after.of_view / before.of_view))),
            np.max(np.abs(np.log(after.of_measurement / before.of_measurement))),
        )
    )

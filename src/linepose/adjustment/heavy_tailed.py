"""The estimate under heavy tails, and whether they are there at all."""

from dataclasses import replace
from typing import Final, NamedTuple

import numpy as np

from linepose.adjustment.estimate import Estimate, estimate, free_levels, unit_weights
from linepose.adjustment.hand_measured import ran_off
from linepose.adjustment.levels import Levels, levels_from_log, log_from_levels
from linepose.adjustment.measurements import Measurements
from linepose.adjustment.reml import Restricted, most_likely, shortened
from linepose.adjustment.settings import AdjustmentSettings
from linepose.adjustment.solve import solve
from linepose.adjustment.state import Knowledge, State
from linepose.adjustment.tails import (
    TailKind,
    TailWeights,
    bound_of_weights,
    expected_weights,
    unit_tail_weights,
    with_gross_errors,
)
from linepose.errors import EstimationError

SCREEN_NATS: Final = {  # by which heavy tails may look worse at the normal model's estimate and are yet tried
    TailKind.CONSTANTS: 4.0,
    TailKind.VIEWS: 10.0,
    TailKind.MEASUREMENTS: 10.0,
    TailKind.GROSS_ERRORS: 10.0,  # at the estimate with tails of single measurements
}
_OF_NOISE: Final = ("white", "pixel", "lateness")  # levels that single measurements have of their own
_GROWN: Final = 4.0  # times the level that is started from
_TRIED: Final = (TailKind.CONSTANTS, TailKind.VIEWS, TailKind.MEASUREMENTS)
SINGLE_NATS: Final = 40.0  # by which tails of single measurements must win: their many weights are taken for known
_WEIGHT_TOLERANCE: Final = 0.03  # of a logarithm
_LEVEL_TOLERANCE: Final = 0.02  # of a logarithm
_SWEEPS: Final = 6  # of weights at fixed levels
_SCREEN_SWEEPS: Final = 3
_ROUNDS: Final = 20
_RESUMED: Final = 4  # times that an estimate which would be the best goes on for so many rounds
_SLOPE: Final = 0.03  # of the levels' density by their logarithms
_TIGHT, _LOOSE = 1e-6, 1e-3  # of chi squared, at the end and while weights move


def with_tails(
    measurements: Measurements,
    knowledge: Knowledge,
    guided: Knowledge,
    start: State,
    settings: AdjustmentSettings,
) -> Estimate:
    """The best of the normal model, and of tails of constants, of views and of single measurements, by evidence.

    `guided` knows the hand measurement whatever the settings say: where many views are bad, the weights are found with
    its help before the pose is let go. Raises EstimationError where neither model has an estimate.
    """
    normal, failure = None, None
    try:
        normal = estimate(measurements, knowledge, start, settings.start, unit_weights(measurements), settings)
    except EstimationError as error:
        failure = error
    if not settings.tails:
        if normal is None:
            raise failure or EstimationError("adjustment: no estimate")
        return normal
    starts = _starts(measurements, normal, guided, start, settings)
    heavy, failed = _heavy_candidates(measurements, knowledge, guided, starts, settings)
    candidates = [*([normal] if normal is not None else []), *(one for one, _ in heavy)]
    if not candidates:
        raise failure or failed or EstimationError("adjustment: no estimate")
    best = _best(candidates, guided)
    for one, tails in heavy:  # where many are bad, weights and levels take long to settle
        if not one.converged and _preference(one) > _preference(best):
            candidates.append(_settled(measurements, knowledge, one, tails, settings))
    return _best(candidates, guided)


class _Start(NamedTuple):
    """Where the search of a heavy-tailed estimate begins."""

    state: State
    levels: Levels
    tails: TailWeights


def _starts(
    measurements: Measurements, normal: Estimate | None, guided: Knowledge, state: State, settings: AdjustmentSettings
) -> list[_Start]:
    """The tails that the normal model's estimate does not rule out, from the start; all where it is none or unsound."""
    sound = normal is not None and _is_sound(normal, guided)
    kinds = _promising(normal) if normal is not None and sound else _TRIED
    starts = [_Start(state, settings.start, unit_tail_weights(measurements, kind)) for kind in kinds]
    if normal is None or not sound or _noise_has_grown(normal, settings.start):
        as_stated = settings.start._replace(**dict.fromkeys(_OF_NOISE, 1.0))
        gross = with_gross_errors(unit_tail_weights(measurements, TailKind.MEASUREMENTS))
        starts.append(_Start(state, as_stated, gross))
    return starts


def _heavy_candidates(
    measurements: Measurements,
    knowledge: Knowledge,
    guided: Knowledge,
    starts: list[_Start],
    settings: AdjustmentSettings,
) -> tuple[list[tuple[Estimate, TailWeights]], EstimationError | None]:
    """Heavy-tailed estimates, of gross errors also from that with single tails; and the first failure, if any."""
    found: list[tuple[Estimate, TailWeights]] = []
    failure = None
    while starts:
        state, levels, tails = starts.pop(0)
        try:
            one, tails = _heavy_tailed(measurements, guided, state, levels, tails, settings)
            if knowledge.hand is not guided.hand:
                one, tails = _heavy_tailed(measurements, knowledge, one.solution.state, one.levels, tails, settings)
        except EstimationError as error:
            failure = failure or error
            continue
        found.append((one, tails))
        if tails.kind == TailKind.MEASUREMENTS and _is_promising(one, gross := with_gross_errors(tails)):
            starts.append(_Start(one.solution.state, one.levels, gross))
    return found, failure


def _best(candidates: list[Estimate], guided: Knowledge) -> Estimate:
    """The sound one of most evidence."""
    return max(candidates, key=lambda one: (_is_sound(one, guided), _preference(one)))


def _settled(
    measurements: Measurements, knowledge: Knowledge, one: Estimate, tails: TailWeights, settings: AdjustmentSettings
) -> Estimate:
    """A heavy-tailed estimate whose search goes on until it settles, or for long."""
    for _ in range(_RESUMED):
        try:
            one, tails = _heavy_tailed(measurements, knowledge, one.solution.state, one.levels, tails, settings)
        except EstimationError:
            break
        if one.converged:
            break
    return one


def _is_sound(one: Estimate, guided: Knowledge) -> bool:
    """Whether an estimate has converged, not beyond what a tape measure explains."""
    return one.converged and not ran_off(guided.hand, one.solution.state.position_m)


def _preference(one: Estimate) -> float:
    """Evidence, less what tails of single measurements must win by."""
    weights, view = one.weights.of_measurement, one.restricted.measurements.view
    alone = bool(np.any(weights != weights[np.searchsorted(view, view)]))
    return one.log_evidence - SINGLE_NATS * alone


def _promising(normal: Estimate) -> list[TailKind]:
    """The tails that are not so much worse at the normal model's estimate that they need not be tried."""
    measurements = normal.restricted.measurements
    return [kind for kind in _TRIED if _is_promising(normal, unit_tail_weights(measurements, kind))]


def _is_promising(one: Estimate, tails: TailWeights) -> bool:
    """Whether other weights, at the pose and levels of an estimate, have nearly its evidence or more."""
    measurements, nats = one.restricted.measurements, SCREEN_NATS[tails.kind]
    for _ in range(_SCREEN_SWEEPS):
        tails = expected_weights(measurements, one.solution.model, one.levels, tails)
    weighted = replace(one.restricted, weights=tails.applied(measurements))
    evidence = bound_of_weights(measurements, tails) - weighted.negative_log_density(one.log_levels)
    return evidence > one.log_evidence - nats


def _noise_has_grown(normal: Estimate, start: Levels) -> bool:
    """Whether the normal model's noise is so large that it may be many gross errors, which it cannot tell apart."""
    return any(getattr(normal.levels, name) > _GROWN * getattr(start, name) for name in _OF_NOISE)


def _heavy_tailed(
    measurements: Measurements,
    knowledge: Knowledge,
    state: State,
    levels: Levels,
    tails: TailWeights,
    settings: AdjustmentSettings,
) -> tuple[Estimate, TailWeights]:
    """Weights, solution and levels in turn; the evidence is the lower bound."""
    free, logs = free_levels(measurements), log_from_levels(levels)
    if not measurements.timed:
        logs[0] = -np.inf
        levels = levels_from_log(logs)
    passes, rounds, settled, share, last = 0, 0, False, 1.0, None
    while True:
        rounds += 1
        for _ in range(_SWEEPS):
            solution = solve(measurements, knowledge, state, levels, tails.applied(measurements), tolerance=_LOOSE)
            state, before = solution.state, tails
            tails = expected_weights(measurements, solution.model, levels, before)
            moved = _change(tails, before)
            if moved < _WEIGHT_TOLERANCE:
                break
        weights = tails.applied(measurements)
        restricted = Restricted(measurements, solution.model, weights, settings.priors, free, logs)
        start = restricted.start(levels)
        likeliest, count = most_likely(restricted, start, _SLOPE)
        passes, move = passes + count, likeliest - start
        share, last = shortened(share, move, last), move
        log_levels = start + share * move
        logs = restricted.log_levels(log_levels)
        levels = levels_from_log(logs)
        settled = bool(np.max(np.abs(move)) < _LEVEL_TOLERANCE and moved < _WEIGHT_TOLERANCE)
        if settled or rounds >= _ROUNDS:
            break
    solution = solve(measurements, knowledge, state, levels, weights, tolerance=_TIGHT)
    restricted = Restricted(measurements, solution.model, weights, settings.priors, free, logs)
    evidence = bound_of_weights(measurements, tails) - restricted.negative_log_density(log_levels)
    found = Estimate(
        solution, levels, log_levels, restricted, weights, evidence, rounds, passes, settled and solution.converged
    )
    return found, tails


def _change(after: TailWeights, before: TailWeights) -> float:
    """The largest change of a weight's logarithm."""
    pairs = ((after.constant, before.constant), (after.noise, before.noise), (after.single, before.single))
    return float(max(np.max(np.abs(np.log(one / other))) for one, other in pairs))

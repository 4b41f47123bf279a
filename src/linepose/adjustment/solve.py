"""Gauss-Newton over points, camera and body poses at fixed levels, with Levenberg's damping of the camera's step.

All is linearised anew at the corrected body poses, so what is minimised is

    chi^2 = sum of the squared unit errors of the process + squared pixel noise + priors

and nothing else: no determinant decides on the pose. The body poses are incidental parameters; in the parametrisation
that is orthogonal to the pose, integrating them out leaves the profile likelihood without any.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np

from linepose.adjustment.levels import Levels
from linepose.adjustment.linearise import Linearised
from linepose.adjustment.measurements import Measurements
from linepose.adjustment.normal import N_POSE, Pass, Prior, design, one_pass, solve_step, whitened_residual
from linepose.adjustment.process import Components, ErrorImage, Weights, components, corrections, error_image
from linepose.adjustment.start import behind_at_start
from linepose.adjustment.state import Knowledge, State, linearised_at
from linepose.adjustment.whitening import unwhiten
from linepose.arrays import Floats
from linepose.errors import EstimationError

_LARGEST_DAMPING: Final = 1e8
_LARGEST_TURN_RAD: Final = 0.3
_LARGEST_SHIFT_M: Final = 1.0
_FREE_STEPS: Final = 2  # in which chi squared may rise, as the first corrections bend the linear model
_ALLOWED_RISE: Final = 0.1
_SETTLING: Final = 2  # linearisations until corrections belong to their camera and points


@dataclass(frozen=True)
class Model:
    """The linear model at a state: what a pass needs at any levels.

    image: of unit errors; rows (2 L, n): all columns; prior: about the state.
    """

    state: State
    linearised: Linearised
    image: ErrorImage
    rows: Floats
    prior: Prior


@dataclass(frozen=True)
class Solution:
    """A minimum of chi squared at fixed levels.

    model, process, done: where it was last linearised, and the pass there; dual (L, 2): `C^-1 e` at the minimum;
    z (L, 6), q (N, 6): the process there; n_steps; converged.
    """

    model: Model
    process: Components
    done: Pass
    dual: Floats
    z: Floats
    q: Floats
    n_steps: int
    converged: bool

    @property
    def state(self) -> State:
        """The state at the minimum."""
        return self.model.state


def model_at(measurements: Measurements, knowledge: Knowledge, state: State) -> Model | None:
    """The linear model at a state; None where a point is not in front of the camera."""
    linearised = linearised_at(measurements, knowledge, state)
    if linearised is None:
        return None
    rows = design(linearised, state.correction, measurements.point, measurements.n_points)
    image = error_image(measurements.structure, linearised)
    return Model(state, linearised, image, rows, knowledge.prior(state, measurements))


def pass_at(measurements: Measurements, model: Model, levels: Levels, weights: Weights) -> tuple[Components, Pass]:
    """The error process at these levels, and one pass of the linear model with it."""
    structure = measurements.structure
    process = components(structure, model.image, levels, weights)
    return process, one_pass(model.rows, process, structure.view_of, structure.begins, model.prior)


def solve(
    measurements: Measurements,
    knowledge: Knowledge,
    start: State,
    levels: Levels,
    weights: Weights,
    *,
    tolerance: float = 1e-9,
    max_steps: int = 60,
    damping: float = 0.0,
    n_held: int = 0,
) -> Solution:
    """The minimum of chi squared near a start.

    It has converged when a step would lower chi squared by less than `tolerance`, and chi squared moves by less than
    that when it is linearised anew. Where full steps rise, the camera's is damped, and chi squared is judged with the
    corrections that belong to the step: with those of the step before it need not fall however short the step. The
    last `n_held` columns, of the pose and what else is sought, keep their start. Raises EstimationError where a point
    is behind the camera at the start, or the normal equations are singular.
    """
    model = model_at(measurements, knowledge, start)
    if model is None:
        raise behind_at_start(measurements, start.pose, start.points_m)
    process, done = pass_at(measurements, model, levels, weights)
    floor, steps, converged = damping, 0, False
    structure = measurements.structure
    while True:
        if not np.isfinite(done.log_determinant):
            raise EstimationError(
                "adjustment: singular normal equations; add observations from other directions, or drop points that "
                "are seen from one direction only"
            )
        step = _step(done, 3 * measurements.n_points, damping, n_held)
        dual = unwhiten(done.factor, whitened_residual(done, step))
        correction, z, q = corrections(structure, process, model.linearised, levels, weights, dual)
        near = done.chi_squared_before - _after(done, step) < tolerance / (1 + damping)
        if steps >= max_steps or (converged and near):
            break
        trial = model_at(measurements, knowledge, model.state.moved(_held(step), correction))
        steps += 1
        if trial is not None and damping > floor:
            trial = _with_its_corrections(measurements, knowledge, trial, levels, weights)
        if trial is not None:
            trial_process, trial_done = pass_at(measurements, trial, levels, weights)
            change = trial_done.chi_squared_before - done.chi_squared_before
            if change <= max(tolerance, _ALLOWED_RISE * done.chi_squared_before if steps <= _FREE_STEPS else 0.0):
                converged = near and abs(change) < tolerance
                model, process, done = trial, trial_process, trial_done
                damping = max(floor, damping / 10) if damping > 1e-7 else 0.0
                continue
        if damping > _LARGEST_DAMPING:
            break
        if damping <= floor:
            model = _with_its_corrections(measurements, knowledge, model, levels, weights) or model
            process, done = pass_at(measurements, model, levels, weights)
        damping = max(10 * damping, 1e-3)
    return Solution(model, process, done, dual, z, q, steps, converged)


def _with_its_corrections(
    measurements: Measurements, knowledge: Knowledge, model: Model, levels: Levels, weights: Weights
) -> Model | None:
    """The model linearised at the corrections that belong to its camera and points; None where one is behind it."""
    settled: Model | None = model
    for _ in range(_SETTLING):
        if settled is None:
            break
        process, done = pass_at(measurements, settled, levels, weights)
        still = np.zeros(len(done.upper) - 1)
        dual = unwhiten(done.factor, whitened_residual(done, still))
        correction, _, _ = corrections(measurements.structure, process, settled.linearised, levels, weights, dual)
        settled = model_at(measurements, knowledge, settled.state.moved(still, correction))
    return settled


def _after(done: Pass, step: Floats) -> float:
    """Chi squared of the linear model after a step."""
    upper = done.upper
    n = len(step)
    return float(done.chi_squared + np.sum((upper[:n, n] - upper[:n, :n] @ step) ** 2))


def _held(step: Floats) -> Floats:
    """The step, shortened where the camera's part is longer than the linear model can mean."""
    camera = np.abs(step[-N_POSE:])
    share = max(camera[:3].max() / _LARGEST_SHIFT_M, camera[3:].max() / _LARGEST_TURN_RAD, 1.0)
    return step / share


def _step(done: Pass, first_free: int, damping: float, n_held: int) -> Floats:
    n = len(done.upper) - 1
    if n_held == 0:
        return solve_step(done.upper, first_free, damping)
    inner = n - n_held
    cut = done.upper[:inner, [*range(inner), n]]
    square = np.vstack([cut, np.zeros(inner + 1)])
    return np.concatenate([solve_step(square, first_free, damping), np.zeros(n_held)])

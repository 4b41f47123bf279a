"""The curvature of chi squared in what is sought, and what it does to the covariance.

Body poses are estimated with the camera's (errors in variables), and the normal equations N are built at the estimates,
whose noise inflates them: N is the variance of the score, but the slope of the score is the Hessian H in what is sought
(the pose, and the clock offset where it is estimated) of

    psi = 1/2 min over points, body poses, principal point and focal length of chi^2

so that its covariance is `H^-1 N H^-1`: the normal posterior's N^-1 mapped by `M = H^-1 N` on both sides.
H by central differences of psi's gradient, which the envelope theorem gives: of what is minimised only the
normal equations of what is sought are left.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np

from linepose.adjustment.levels import Levels
from linepose.adjustment.measurements import Measurements
from linepose.adjustment.normal import Pass, trailing_inverse
from linepose.adjustment.process import Weights
from linepose.adjustment.solve import Solution, solve
from linepose.adjustment.state import Knowledge, State
from linepose.arrays import Floats
from linepose.errors import EstimationError
from linepose.geometry import rotations

HELD: Final = (0.25, 4.0)  # range in which the eigenvalues of H in units of N are held
STEP_SIGMAS: Final = 0.3
_TOLERANCE: Final = 1e-5


@dataclass(frozen=True)
class Curvature:
    """stretch (S, S): M of the S sought columns, pose last; eigenvalues (S,): of H in units of N, ascending."""

    stretch: Floats
    eigenvalues: Floats

    @property
    def least_eigenvalue(self) -> float:
        """The least curvature in units of the normal equations'; NaN where there is none to be had."""
        return float(self.eigenvalues[0])


def curvature(
    measurements: Measurements, knowledge: Knowledge, solution: Solution, levels: Levels, weights: Weights
) -> Curvature:
    """The curvature at a solution; the identity with NaN eigenvalues where a neighbour has no solution."""
    n = knowledge.n_sought
    covariance = trailing_inverse(solution.done.upper, n)
    lower = np.linalg.cholesky(np.linalg.inv(covariance))
    directions = np.linalg.inv(lower)  # rows: steps of one sigma
    hessian = np.empty((n, n))
    try:
        for i, direction in enumerate(directions):
            scores = [
                _score(measurements, knowledge, solution, levels, weights, sign * STEP_SIGMAS * direction)
                for sign in (1.0, -1.0)
            ]
            hessian[i] = directions @ (scores[0] - scores[1]) / (2 * STEP_SIGMAS)
    except EstimationError:
        return Curvature(np.eye(n), np.full(n, np.nan))
    values, vectors = np.linalg.eigh((hessian + hessian.T) / 2)
    held = np.clip(values, *HELD)
    stretch = directions.T @ (vectors / held) @ vectors.T @ lower.T
    return Curvature(stretch, values)


def _score(
    measurements: Measurements,
    knowledge: Knowledge,
    solution: Solution,
    levels: Levels,
    weights: Weights,
    step: Floats,
) -> Floats:
    """Gradient (S,) of psi at a step (S,) of what is sought from the solution, by that step."""
    full = np.concatenate([_response(solution.done, step), step])
    state: State = solution.state.moved(full, solution.state.correction)
    near = solve(measurements, knowledge, state, levels, weights, tolerance=_TOLERANCE, max_steps=12, n_held=len(step))
    gradient = trailing_gradient(near.done, len(step))
    gradient[-3:] = rotations.left_jacobian_so3(step[-3:]).T @ gradient[-3:]
    return gradient


def trailing_gradient(done: Pass, size: int) -> Floats:
    """Gradient (size,) of half the least chi squared at fixed last columns, by a step of those."""
    n = len(done.upper) - 1
    block = done.upper[n - size : n, n - size : n]
    return -np.triu(block).T @ done.upper[n - size : n, n]


def _response(done: Pass, step: Floats) -> Floats:
    """How all other columns follow a step (S,) of the last, by the linear model."""
    n = len(done.upper) - 1
    inner = n - len(step)
    right = -done.upper[:inner, inner:n] @ step
    out = np.zeros(inner)
    for i in range(inner - 1, -1, -1):
        out[i] = (right[i] - done.upper[i, i + 1 : inner] @ out[i + 1 :]) / done.upper[i, i]
    return out

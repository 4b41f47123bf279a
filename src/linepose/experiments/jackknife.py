"""Sigmas from leaving out one observation at a time: they need no noise model.

An error that all points of an observation share shows in them, whatever the noise model takes points for.
"""

from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from linepose.arrays import Floats
from linepose.errors import EstimationError
from linepose.likelihood.base import Likelihood

_STEP: Final = 0.1  # sigmas
_LEAST: Final = 0.3  # of the whole's curvature


def jackknife_sigma(likelihood: Likelihood, optimum: ArrayLike, covariance: ArrayLike) -> Floats:
    """Sigma of each parameter (P,) at the optimum (P,) of all observations, of which (P, P) is the covariance.

    Each observation less moves the optimum by one Newton step, along axes in which the covariance is the identity.
    There the curvature of the rest is about one; where it is bent below `_LEAST`, as a level's may be, the step is that
    of `_LEAST`. Raises EstimationError where the likelihood is undefined nearby.
    """
    centre = np.asarray(optimum, dtype=float)
    axes = np.linalg.cholesky(np.asarray(covariance, dtype=float))
    numbers = likelihood.survey.number.tolist()
    without = []
    for left_out in numbers:
        reduced = likelihood.select([number for number in numbers if number != left_out])
        gradient, hessian = derivatives(reduced, centre, axes)
        curvature, directions = np.linalg.eigh(hessian)
        without.append(centre - axes @ directions @ (directions.T @ gradient / np.maximum(curvature, _LEAST)))
    spread = np.sum((np.array(without) - np.mean(without, axis=0)) ** 2, axis=0)
    return np.sqrt((len(numbers) - 1) / len(numbers) * spread)


def derivatives(likelihood: Likelihood, centre: Floats, axes: Floats) -> tuple[Floats, Floats]:
    """Gradient (P,) and second derivatives (P, P) of -log L along the columns of `axes` (P, P), in units of them.

    Central differences in one batch; raises EstimationError where the likelihood is undefined nearby.
    """
    n = len(centre)
    pairs = [(i, j) for i in range(n) for j in range(i)]
    steps = _STEP * axes.T
    moves = [np.zeros(n), *steps, *-steps]
    moves += [a * steps[i] + b * steps[j] for i, j in pairs for a in (1, -1) for b in (1, -1)]
    values = -likelihood.log_likelihoods(centre + np.array(moves))
    if not np.all(np.isfinite(values)):
        raise EstimationError("derivatives of the likelihood: it is undefined near the optimum")
    middle, up, down = values[0], values[1 : n + 1], values[n + 1 : 2 * n + 1]
    hessian = np.diag(up - 2 * middle + down)
    for (i, j), (pp, pm, mp, mm) in zip(pairs, values[2 * n + 1 :].reshape(-1, 4), strict=True):
        hessian[i, j] = hessian[j, i] = (pp - pm - mp + mm) / 4
    return (up - down) / (2 * _STEP), hessian / _STEP**2

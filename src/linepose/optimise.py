"""The most likely pose: Powell's method in bounded parameters, and the covariance that the curvature there gives."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import minimize

from linepose.errors import EstimationError
from linepose.likelihood.base import Likelihood
from linepose.pose import check_pose
from linepose.rotations import Floats

_UNDEFINED = 1e300  # Powell's line search needs a number where the likelihood is zero
_STEPS = np.array([1.0, -1.0])


@dataclass(frozen=True)
class Search:
    """How the optimum is searched: the range around the start, and Powell's tolerances (the paper's by default)."""

    half_width_m: float = 2.0
    half_width_rad: float = float(np.pi)
    x_tolerance: float = 1e-5
    f_tolerance: float = 1e-8


@dataclass(frozen=True)
class Optimum:
    """Where a search ended: parameters (P,), the pose's six first, -log L there, and what it took."""

    parameters: Floats
    neg_log_likelihood: float
    n_evaluations: int
    converged: bool


def bounded(unbounded: ArrayLike, centre: ArrayLike, half_width: ArrayLike) -> Floats:
    """Parameters within `centre +- half_width` from unbounded ones, `centre + half_width sin(p)`; (P,) each.

    This is `lo + (sin p + 1)(hi - lo)/2`; it stretches the search near the centre and decides the basin of attraction.
    """
    return np.asarray(centre, dtype=float) + np.asarray(half_width, dtype=float) * np.sin(unbounded)


def optimise(likelihood: Likelihood, start: ArrayLike, search: Search | None = None) -> Optimum:
    """The optimum that Powell's method reaches from a start pose (6,), the ranges centred on it (section 3.5).

    Raises InputError for a start that is not finite.
    """
    search = search or Search()
    first = likelihood.start(check_pose(start, "start pose"))
    return optimise_within(
        likelihood, first, first, likelihood.half_widths(search.half_width_m, search.half_width_rad), search
    )


def optimise_within(
    likelihood: Likelihood, start: Floats, centre: Floats, half_width: Floats, search: Search
) -> Optimum:
    """The optimum that Powell's method reaches from parameters (P,), within `centre +- half_width` (P,) each."""
    log_likelihood = likelihood.log_likelihood

    def objective(unbounded: Floats) -> float:
        value = -log_likelihood(centre + half_width * np.sin(unbounded))
        return value if value < _UNDEFINED else _UNDEFINED

    found = minimize(
        objective,
        np.arcsin(np.clip((start - centre) / half_width, -1, 1)),
        method="Powell",
        options={"xtol": search.x_tolerance, "ftol": search.f_tolerance},
    )
    return Optimum(
        parameters=bounded(found.x, centre, half_width),
        neg_log_likelihood=float(found.fun),
        n_evaluations=int(found.nfev),
        converged=bool(found.success) and found.fun < _UNDEFINED,
    )


def laplace_covariance(likelihood: Likelihood, optimum: ArrayLike) -> Floats:
    """Covariance (P, P) from the curvature of -log L at its minimum (P,).

    Central differences twice: first along the parameters with a step of 1e-6, good for a fraction of a per cent, then
    along the principal axes that this gave with a hundredth of each axis's sigma. There the rounding error is 1e-9 and
    the truncation error 1e-4 of the fourth derivative's share; along the parameters themselves such a step would leave
    the minimum's neighbourhood, because they are strongly correlated.
    Raises EstimationError where the likelihood is undefined, or the curvature is not positive definite: a direction
    that the data leave open.
    """
    parameters = np.asarray(optimum, dtype=float)
    axes = 1e-6 * np.eye(len(parameters))
    for scale, lowest in ((1e-2, 0.0), (1.0, 0.1 * 1e-2**2)):  # the second time each curvature is about 1e-2 squared
        curvature, directions = np.linalg.eigh(_hessian(likelihood, parameters, axes))
        if curvature[0] <= lowest:
            raise EstimationError(
                "Laplace covariance: the curvature of the likelihood at the optimum is not positive definite; "
                "the observations leave a direction of the pose open: add views from other sides or with other tilts"
            )
        axes = scale * axes @ directions / np.sqrt(curvature)
    return axes @ axes.T


def _hessian(likelihood: Likelihood, centre: Floats, axes: Floats) -> Floats:
    """Second derivatives of -log L by steps along the columns of `axes` (P, P), in units of them, in one batch."""
    n = len(centre)
    pairs = [(i, j) for i in range(n) for j in range(i, n)]
    offsets = [a * axes[:, i] + b * axes[:, j] for i, j in pairs for a in _STEPS for b in _STEPS]
    values = -likelihood.log_likelihoods(centre + np.array(offsets))
    if not np.all(np.isfinite(values)):
        raise EstimationError(
            "Laplace covariance: the likelihood is undefined at the optimum or beside it, where a point lies behind "
            "the camera; check the hand-measured pose and the observations"
        )
    quads = values.reshape(-1, 4)
    hessian = np.empty((n, n))
    for (i, j), (pp, pm, mp, mm) in zip(pairs, quads, strict=True):
        hessian[i, j] = hessian[j, i] = (pp - pm - mp + mm) / 4
    return hessian

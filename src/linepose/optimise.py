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
    """The optimum that Powell's method reaches from a start pose (6,) (section 3.5).

    Raises InputError for a start that is not finite.
    """
    search = search or Search()
    centre = likelihood.start(check_pose(start, "start pose"))
    half_width = likelihood.half_widths(search.half_width_m, search.half_width_rad)
    log_likelihood = likelihood.log_likelihood

    def objective(unbounded: Floats) -> float:
        value = -log_likelihood(centre + half_width * np.sin(unbounded))
        return value if value < _UNDEFINED else _UNDEFINED

    found = minimize(
        objective,
        np.zeros(len(centre)),
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

    Central differences, first with a fixed step, then with a hundredth of the sigma that this gave: there the
    truncation error is 1e-4 of the fourth derivative's share and the rounding error 1e-10.
    Raises EstimationError where the likelihood is undefined, or the curvature is not positive definite: a parameter
    that the data leave open.
    """
    parameters = np.asarray(optimum, dtype=float)
    step = np.full(len(parameters), 1e-4)
    for _ in range(2):
        covariance = np.asarray(np.linalg.pinv(_hessian(likelihood, parameters, step), hermitian=True), dtype=float)
        variance = np.diag(covariance)
        if not np.all(np.isfinite(variance)) or np.any(variance <= 0):
            break
        step = 1e-2 * np.sqrt(variance)
    eigenvalues = np.linalg.eigvalsh(covariance) if np.all(np.isfinite(covariance)) else np.array([-1.0])
    if eigenvalues[0] <= 0:
        raise EstimationError(
            "Laplace covariance: the curvature of the likelihood at the optimum is not positive definite; "
            "the observations leave a direction of the pose open: add views from other sides or with other tilts"
        )
    return covariance


def _hessian(likelihood: Likelihood, centre: Floats, step: Floats) -> Floats:
    """Second derivatives of -log L by central differences, in one batch; (P,), (P,) to (P, P)."""
    n = len(centre)
    pairs = [(i, j) for i in range(n) for j in range(i, n)]
    signs = [(a, b) for a in _STEPS for b in _STEPS]
    points = np.tile(centre, (len(pairs) * 4 + 1, 1))
    for k, (i, j) in enumerate(pairs):
        for m, (a, b) in enumerate(signs):
            points[4 * k + m, i] += a * step[i]
            points[4 * k + m, j] += b * step[j]
    values = -likelihood.log_likelihoods(points)
    if not np.all(np.isfinite(values)):
        raise EstimationError(
            "Laplace covariance: the likelihood is undefined at the optimum or beside it, where a point lies behind "
            "the camera; check the hand-measured pose and the observations"
        )
    quads = values[:-1].reshape(-1, 4)
    hessian = np.empty((n, n))
    for (i, j), (pp, pm, mp, mm) in zip(pairs, quads, strict=True):
        hessian[i, j] = hessian[j, i] = (pp - pm - mp + mm) / (4 * step[i] * step[j])
    return hessian

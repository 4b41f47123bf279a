"""The most likely pose: Powell's method in bounded parameters, and the covariance that the curvature there gives.

A likelihood with parameters of its own (a clock offset) is searched in two steps: Powell, coarsely, over the pose, then
BFGS over everything. BFGS also goes from the start itself, and the better end inside the range counts.
"""

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike
from pydantic import Field, PositiveFloat

from linepose.arrays import Floats
from linepose.errors import EstimationError
from linepose.geometry.pose import N_PARAMETERS, check_pose
from linepose.settings import Settings

if TYPE_CHECKING:  # configuration has the search's settings and must be read quickly
    from linepose.likelihood.base import Likelihood

_UNDEFINED = 1e300  # Powell's line search needs a number where the likelihood is zero
_STEPS = np.array([1.0, -1.0])
_COARSE_X, _COARSE_F = 1e-2, 1e-4
_UNIT = 0.1  # of the half widths for 0.5 m and 0.1 rad: about a sigma of each parameter, BFGS's unit
_UNIT_M, _UNIT_RAD = 0.5, 0.1
_EDGE = 0.999  # of the pose's range: what ends there is no optimum, a pose that gross errors have driven away
_DIFFERENCE = 1e-3  # in those units
_GRADIENT = 1e-3  # in -log L per unit, where BFGS ends: some thousandths of a sigma from the optimum
_FLAT = 2e-2  # where rounding may end it: some hundredths


class Search(Settings):
    """How the optimum is searched: the range around the start, and Powell's tolerances (the paper's by default).

    Examples
    --------
    >>> import linepose
    >>> linepose.Search(half_width_m=0.5).half_width_rad
    3.141592653589793
    """

    half_width_m: PositiveFloat = Field(2.0, description="Each coordinate is searched within +- this (m).")
    half_width_deg: PositiveFloat = Field(180.0, description="Each rotation component within +- this (deg).")
    x_tolerance: PositiveFloat = Field(1e-5, description="Powell's relative tolerance of the parameters.")
    f_tolerance: PositiveFloat = Field(1e-8, description="Powell's relative tolerance of -log L.")

    @property
    def half_width_rad(self) -> float:
        """Each rotation component is searched within +- this (rad)."""
        return float(np.deg2rad(self.half_width_deg))


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


def optimise(likelihood: "Likelihood", start: ArrayLike, search: Search | None = None) -> Optimum:
    """The optimum from a start pose (6,): by Powell's method (section 3.5), then by gradients where the model has more.

    All ranges are centred on the start. Raises InputError for a start that is not finite.
    """
    search = search or Search()
    first = likelihood.start(check_pose(start, "start pose"))
    half_width = likelihood.half_widths(search.half_width_m, search.half_width_rad)
    return optimise_within(likelihood, first, first, half_width, search)


def optimise_within(
    likelihood: "Likelihood", start: Floats, centre: Floats, half_width: Floats, search: Search
) -> Optimum:
    """The same from parameters (P,), within `centre +- half_width` (P,) each."""
    if likelihood.n_parameters == N_PARAMETERS:
        return _powell(likelihood, start, centre, half_width, search)
    coarse = search.replaced(x_tolerance=_COARSE_X, f_tolerance=_COARSE_F)
    first = _powell(likelihood, start, centre, half_width, coarse)
    ends = [_bfgs(likelihood, parameters, centre, half_width) for parameters in (start, first.parameters)]
    best = min(ends, key=lambda end: (not end.converged, end.neg_log_likelihood))
    return replace(best, n_evaluations=first.n_evaluations + sum(end.n_evaluations for end in ends))


def _powell(likelihood: "Likelihood", start: Floats, centre: Floats, half_width: Floats, search: Search) -> Optimum:
    """Powell's method over the pose, parameters beyond it kept at the start's."""
    from scipy.optimize import minimize

    unbounded = np.arcsin(np.clip((start - centre) / half_width, -1.0, 1.0))
    log_likelihood = likelihood.log_likelihood

    def objective(pose: Floats) -> float:
        unbounded[:N_PARAMETERS] = pose
        value = -log_likelihood(centre + half_width * np.sin(unbounded))
        return value if value < _UNDEFINED else _UNDEFINED

    found = minimize(
        objective,
        unbounded[:N_PARAMETERS].copy(),
        method="Powell",
        options={"xtol": search.x_tolerance, "ftol": search.f_tolerance},
    )
    unbounded[:N_PARAMETERS] = found.x
    return Optimum(
        parameters=bounded(unbounded, centre, half_width),
        neg_log_likelihood=float(found.fun),
        n_evaluations=int(found.nfev),
        converged=bool(found.success) and found.fun < _UNDEFINED,
    )


def minimise(
    likelihood: "Likelihood", parameters: ArrayLike, start: ArrayLike, search: Search | None = None
) -> Optimum:
    """The optimum that BFGS reaches from parameters (P,) near it, within the same range around a start pose (6,).

    Gradients are central differences, in one batch. Raises InputError for a start that is not finite.
    """
    search = search or Search()
    half_width = likelihood.half_widths(search.half_width_m, search.half_width_rad)
    centre = likelihood.start(check_pose(start, "start pose"))
    return _bfgs(likelihood, np.asarray(parameters, dtype=float), centre, half_width)


def _bfgs(likelihood: "Likelihood", first: Floats, centre: Floats, half_width: Floats) -> Optimum:
    from scipy.optimize import minimize

    origin = np.arcsin(np.clip((first - centre) / half_width, -1.0, 1.0))
    unit = _UNIT * likelihood.half_widths(_UNIT_M, _UNIT_RAD) / half_width
    moves = _DIFFERENCE * np.vstack([np.eye(len(unit)), -np.eye(len(unit))])

    def values(steps: Floats) -> Floats:
        found = -likelihood.log_likelihoods(bounded(origin + unit * steps, centre, half_width))
        return np.where(found < _UNDEFINED, found, _UNDEFINED)

    def objective(step: Floats) -> float:
        return float(values(step[None])[0])

    def gradient(step: Floats) -> Floats:
        up, down = values(step + moves).reshape(2, -1)
        return (up - down) / (2 * _DIFFERENCE)

    found = minimize(objective, np.zeros(len(unit)), jac=gradient, method="BFGS", options={"gtol": _GRADIENT})
    end = bounded(origin + unit * found.x, centre, half_width)
    inside = np.abs(end - centre)[:N_PARAMETERS] < _EDGE * half_width[:N_PARAMETERS]
    return Optimum(
        parameters=end,
        neg_log_likelihood=float(found.fun),
        n_evaluations=int(found.nfev + len(moves) * found.njev),
        converged=bool(np.max(np.abs(found.jac)) < _FLAT and np.all(inside)) and found.fun < _UNDEFINED,
    )


def laplace_covariance(likelihood: "Likelihood", optimum: ArrayLike) -> Floats:
    """Covariance (P, P) from the curvature of -log L at its minimum (P,).

    Central differences twice: first along the parameters, the pose's with a step of 1e-5 and each other with a
    hundredth of its initial walker sigma (1e-5 of a pixel would drown in rounding), good for a fraction of a per cent;
    then along the principal axes that this gave with a hundredth of each axis's sigma. There the rounding error is
    1e-9 and the truncation error 1e-4 of the fourth derivative's share; along the parameters themselves such a step
    would leave the minimum's neighbourhood, because they are strongly correlated.
    Raises EstimationError where the likelihood is undefined, or the curvature is not positive definite: a direction
    that the data leave open.
    """
    parameters = np.asarray(optimum, dtype=float)
    axes = 1e-2 * np.diag(likelihood.initial_walker_sigma(1e-3, 1e-3))
    for scale, lowest in ((1e-2, 0.0), (1.0, 0.1 * 1e-2**2)):  # the second time each curvature is about 1e-2 squared
        curvature, directions = np.linalg.eigh(_hessian(likelihood, parameters, axes))
        if curvature[0] <= lowest:
            raise EstimationError(
                "Laplace covariance: the curvature of the likelihood at the optimum is not positive definite; "
                "the observations leave a direction of the pose open: add views from other sides or with other tilts"
            )
        axes = scale * axes @ directions / np.sqrt(curvature)
    return axes @ axes.T


def _hessian(likelihood: "Likelihood", centre: Floats, axes: Floats) -> Floats:
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

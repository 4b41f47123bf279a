"""Heavy tails: weights of every view's constant, of every view's noise, and of every measurement's noise.

A bad view is one whose constant comes from far out in the tail (a clock that is off), or whose measurements all err
more than others' (a jump, labels of another view); a bad measurement is one that errs alone (a label). All three are
multivariate Student-t with nu degrees of freedom, written as normal with random weights: of d numbers x with sigma one,
`x ~ N(0, I / w)`, `w ~ Gamma(nu / 2, nu / 2)`; a measurement's noise has its own weight times its view's. By
expectation maximisation

    E[w] = (nu + d) / (nu + E[x^T x]),    d = 6 of a constant, 2 of a measurement, 2 n of a view with n of them,

where the expectation of the squares holds the posterior covariance: what the data do not tell keeps weight one.

Whether tails are there is a question of evidence, not of thresholds on residuals: with q(w) Gamma, the density of the
levels becomes a lower bound of the heavy-tailed model's evidence,

    -1/2 (chi^2 + log|C| + log|N|)_w + log prior + sum [ d/2 (E log w - log E w) - KL(q(w) | prior) ],

which compares with the normal model's own, and tells tails of constants from those of whole views and of single
measurements too. The bound of fewer weights is the tighter one. Where
the normal model explains the data as well, it stands, and no sigma is lost to weights that nothing asks for.
Where many measurements are bad, `gross_errors` has another distribution of their single weights.
"""

from dataclasses import dataclass, replace
from enum import IntEnum
from typing import Final

import numpy as np
from scipy.special import digamma, gammaln

from linepose.adjustment.gradient import slopes_of_density
from linepose.adjustment.gross_errors import (
    GrossErrors,
    bound_of_gross_errors,
    expected_gross_errors,
    first_gross_errors,
)
from linepose.adjustment.levels import Levels
from linepose.adjustment.measurements import Measurements
from linepose.adjustment.process import Weights
from linepose.adjustment.solve import Model, pass_at
from linepose.adjustment.thresholds import DEGREES_OF_FREEDOM, MEASUREMENT_DIMENSION
from linepose.arrays import Floats

CONSTANT_DIMENSION: Final = 6


class TailKind(IntEnum):
    """What has heavy tails: a view's constant; its noise too; each measurement's noise too, or many gross errors."""

    CONSTANTS = 0
    VIEWS = 1
    MEASUREMENTS = 2
    GROSS_ERRORS = 3


@dataclass(frozen=True)
class TailWeights:
    """Expected weights: of each view's constant (N,) and of its noise (N,), of each measurement alone (L,).

    kind: what has tails; the weights of all else are one. gross: what single weights are made of, with gross errors.
    """

    constant: Floats
    noise: Floats
    single: Floats
    kind: TailKind
    gross: GrossErrors | None = None

    def applied(self, measurements: Measurements) -> Weights:
        """As the error process takes them."""
        return Weights(self.constant, self.noise[measurements.view] * self.single)


def unit_tail_weights(measurements: Measurements, kind: TailKind) -> TailWeights:
    """Every weight one."""
    of_views = np.ones(measurements.n_views)
    return TailWeights(of_views, of_views, np.ones(len(measurements.u_px)), kind)


def with_gross_errors(tails: TailWeights) -> TailWeights:
    """The weights, from which on those of single measurements follow gross errors."""
    return replace(tails, kind=TailKind.GROSS_ERRORS, gross=first_gross_errors(len(tails.single)))


def expected_weights(measurements: Measurements, model: Model, levels: Levels, before: TailWeights) -> TailWeights:
    """One step of expectation maximisation at a linear model."""
    weights = before.applied(measurements)
    process, done = pass_at(measurements, model, levels, weights)
    slopes = slopes_of_density(measurements.structure, model.image, process, levels, weights, done)
    of_constant = np.maximum(CONSTANT_DIMENSION - slopes.by_view, 0.0) / weights.of_view
    of_noise = np.maximum(MEASUREMENT_DIMENSION - slopes.by_measurement, 0.0) / weights.of_measurement
    view, nu = measurements.view, DEGREES_OF_FREEDOM
    together = np.bincount(view, weights=before.single * of_noise, minlength=measurements.n_views)
    noise, single, gross = before.noise, before.single, before.gross
    if before.kind >= TailKind.VIEWS:
        noise = (nu + MEASUREMENT_DIMENSION * _counts(measurements)) / (nu + together)
    if gross is not None:
        gross = expected_gross_errors(noise[view] * of_noise, gross)
        single = gross.weight
    elif before.kind == TailKind.MEASUREMENTS:
        single = (nu + MEASUREMENT_DIMENSION) / (nu + noise[view] * of_noise)
    return TailWeights((nu + CONSTANT_DIMENSION) / (nu + of_constant), noise, single, before.kind, gross)


def bound_of_weights(measurements: Measurements, weights: TailWeights) -> float:
    """What the weights add to the logarithm of the evidence's lower bound."""
    of_views = _bound(weights.constant, np.full(measurements.n_views, CONSTANT_DIMENSION))
    if weights.kind >= TailKind.VIEWS:
        of_views += _bound(weights.noise, MEASUREMENT_DIMENSION * _counts(measurements))
    if weights.kind < TailKind.MEASUREMENTS:
        return of_views
    if weights.gross is not None:
        return of_views + bound_of_gross_errors(weights.gross)
    return of_views + _bound(weights.single, np.full(len(weights.single), MEASUREMENT_DIMENSION))


def _counts(measurements: Measurements) -> Floats:
    """Number of measurements of each view (N,)."""
    return np.bincount(measurements.view, minlength=measurements.n_views).astype(float)


def _bound(weight: Floats, dimension: Floats) -> float:
    """Sum of `d/2 (E log w - log E w) - KL`, q(w) = Gamma(alpha, beta) with mean `weight` (B,).

    dimension (B,): d of each.
    """
    prior = DEGREES_OF_FREEDOM / 2
    alpha = (DEGREES_OF_FREEDOM + dimension) / 2
    beta = alpha / weight
    expected_log = digamma(alpha) - np.log(beta)
    divergence = (
        alpha * np.log(beta)
        - gammaln(alpha)
        - prior * np.log(prior)
        + gammaln(prior)
        + (alpha - prior) * expected_log
        - (beta - prior) * weight
    )
    return float(np.sum(0.5 * dimension * (expected_log - np.log(weight)) - divergence))

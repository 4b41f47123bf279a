"""Heavy tails: a weight for the constant of every view and for the noise of every measurement.

A bad view is one whose constant comes from far out in the tail, a bad measurement one whose own noise does. Both are
multivariate Student-t with nu degrees of freedom, written as normal with a random weight: q_v ~ N(0, I / w_v),
w_v ~ Gamma(nu / 2, nu / 2), and the same of a measurement's two numbers. By expectation maximisation

    E[w] = (nu + d) / (nu + E[x^T x]),    d = 6 of a view, 2 of a measurement,

where the expectation of the squares holds the posterior covariance: what the data do not tell keeps weight one.

Whether tails are there is a question of evidence, not of thresholds on residuals: with q(w) Gamma, the density of the
levels becomes a lower bound of the heavy-tailed model's evidence,

    -1/2 (chi^2 + log|C| + log|N|)_w + log prior + sum [ d/2 (E log w - log E w) - KL(q(w) | prior) ],

which compares with the normal model's own. Where the normal model explains the data as well, it stands, and no sigma
is lost to weights that nothing asks for.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.special import digamma, gammaln

from linepose.adjustment.gradient import slopes_of_density
from linepose.adjustment.levels import Levels
from linepose.adjustment.measurements import Measurements
from linepose.adjustment.process import Weights
from linepose.adjustment.solve import Model, pass_at
from linepose.adjustment.state import Knowledge
from linepose.rotations import Floats

DEGREES_OF_FREEDOM: Final = 4.0
VIEW_DIMENSION: Final = 6
MEASUREMENT_DIMENSION: Final = 2


@dataclass(frozen=True)
class Squares:
    """Expected squares, in units of the levels without weights: of each view's constant (N,), of each noise (L,)."""

    of_view: Floats
    of_measurement: Floats


def expected_squares(
    measurements: Measurements, knowledge: Knowledge, model: Model, levels: Levels, weights: Weights
) -> Squares:
    """What expectation maximisation weighs by, at a linear model and weights."""
    process, done = pass_at(measurements, knowledge, model, levels, weights)
    slopes = slopes_of_density(measurements.structure, model.image, process, levels, weights, done)
    return Squares(
        np.maximum(VIEW_DIMENSION - slopes.by_view, 0.0) / weights.of_view,
        np.maximum(MEASUREMENT_DIMENSION - slopes.by_measurement, 0.0) / weights.of_measurement,
    )


def expected_weights(squares: Squares) -> Weights:
    """Expected weights given the expected squares."""
    nu = DEGREES_OF_FREEDOM
    return Weights(
        (nu + VIEW_DIMENSION) / (nu + squares.of_view),
        (nu + MEASUREMENT_DIMENSION) / (nu + squares.of_measurement),
    )


def bound_of_weights(weights: Weights) -> float:
    """What the weights add to the logarithm of the evidence's lower bound."""
    return _bound(weights.of_view, VIEW_DIMENSION) + _bound(weights.of_measurement, MEASUREMENT_DIMENSION)


def _bound(weight: Floats, dimension: int) -> float:
    """Sum of `d/2 (E log w - log E w) - KL`, q(w) = Gamma(alpha, beta) with mean `weight` (B,)."""
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

"""Gross errors of single measurements: a share of them errs by a multiple k of what all others do.

Student-t tails follow large errors as long as these are few: beyond one in `nu + 2` their scale grows with them. Where
more are bad, as of features that were matched wrongly, each measurement's noise is of one of two kinds,

    x ~ (1 - share) N(0, I) + share N(0, k^2 I),

both unknown. The probability r that a measurement is good follows from its expected squares s = E[x^T x], and with it
its weight E[w] = r + (1 - r) / k^2; share and k are those that all r make most likely. The sum

    E[log p(w)] - E[log q(w)] + d/2 (E log w - log E w)

is what the weights add to the bound of the evidence, as `tails` has it for Student-t.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.special import expit, xlogy

from linepose.adjustment.thresholds import MEASUREMENT_DIMENSION
from linepose.arrays import Floats

_FIRST_SHARE, _FIRST_FACTOR = 0.3, 10.0
_LARGEST_SHARE: Final = 0.6
_LEAST_FACTOR: Final = 3.0


@dataclass(frozen=True)
class GrossErrors:
    """good (L,): probability that a measurement is good; share of those that are not, factor k of their errors."""

    good: Floats
    share: float
    factor: float

    @property
    def weight(self) -> Floats:
        """Expected weights (L,)."""
        return self.good + (1 - self.good) / self.factor**2


def first_gross_errors(n_measurements: int) -> GrossErrors:
    """All good, before any is looked at."""
    return GrossErrors(np.ones(n_measurements), _FIRST_SHARE, _FIRST_FACTOR)


def expected_gross_errors(squares: Floats, before: GrossErrors) -> GrossErrors:
    """One step of expectation maximisation from expected squares (L,) of measurements' noise in sigmas."""
    log_odds = np.log((1 - before.share) / before.share) + MEASUREMENT_DIMENSION * np.log(before.factor)
    good = expit(log_odds - 0.5 * squares * (1 - before.factor**-2))
    bad = np.sum(1 - good)
    share = float(np.clip(bad / len(good), 1 / (len(good) + 1), _LARGEST_SHARE))
    factor = np.sqrt(np.sum((1 - good) * squares) / (MEASUREMENT_DIMENSION * bad)) if bad > 0 else before.factor
    return GrossErrors(good, share, float(max(factor, _LEAST_FACTOR)))


def bound_of_gross_errors(gross: GrossErrors) -> float:
    """What the weights add to the logarithm of the evidence's lower bound."""
    good, bad = gross.good, 1 - gross.good
    divergence = xlogy(good, good / (1 - gross.share)) + xlogy(bad, bad / gross.share)
    of_weights = -2 * bad * np.log(gross.factor) - np.log(gross.weight)
    return float(np.sum(0.5 * MEASUREMENT_DIMENSION * of_weights - divergence))

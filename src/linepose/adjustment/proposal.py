"""Where levels are drawn from: a multivariate Student-t with a scale of its own on either side of the mode.

The density of the levels' logarithms falls slowly towards small levels, which the data do not tell from none, and fast
towards large ones. Along each axis of the curvature the two scales are those at which the density itself falls
(Geweke 1989, split-t).
"""

from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.special import gammaln

from linepose.adjustment.reml import Restricted
from linepose.arrays import Floats

DEGREES_OF_FREEDOM: Final = 5
_DIFFERENCE: Final = 0.1  # of a logarithm, for the curvature
_PROBED_SIGMAS: Final = (1.0, 2.0)  # at which the density's fall is looked at
_SCALE_RANGE: Final = (0.5, 6.0)
_LEAST_SHARE: Final = 1e-6  # of a probability, kept from zero and one


@dataclass(frozen=True)
class Proposal:
    """Student-t about a centre (F,); root (F, F) symmetric; below, above (F,): factors of the scale on either side."""

    centre: Floats
    root: Floats
    below: Floats
    above: Floats

    def draw(self, count: int, seed: int) -> Floats:
        """Draws (count, F) from a scrambled Sobol sequence: evener than chance."""
        from scipy.stats import chi2, norm, qmc  # slow to import

        n = len(self.centre)
        power = int(np.ceil(np.log2(max(count, 2))))
        uniform = qmc.Sobol(n + 1, rng=np.random.default_rng(seed)).random_base2(power)[:count]
        uniform = np.clip(uniform, _LEAST_SHARE, 1 - _LEAST_SHARE)
        radius = np.sqrt(DEGREES_OF_FREEDOM / chi2.ppf(uniform[:, -1], DEGREES_OF_FREEDOM))
        unit = norm.ppf(uniform[:, :-1]) * radius[:, None]
        return self.centre + (unit * np.where(unit > 0, self.above, self.below)) @ self.root

    def log_density(self, logs: Floats) -> Floats:
        """Logarithm of the density (D,) at logarithms of levels (D, F)."""
        scaled = (logs - self.centre) @ np.linalg.inv(self.root)
        scale = np.where(scaled > 0, self.above, self.below)
        n = len(self.centre)
        half = 0.5 * (DEGREES_OF_FREEDOM + n)
        unit = -half * np.log1p(np.sum((scaled / scale) ** 2, axis=1) / DEGREES_OF_FREEDOM)
        norm = gammaln(half) - gammaln(0.5 * DEGREES_OF_FREEDOM) - 0.5 * n * np.log(DEGREES_OF_FREEDOM * np.pi)
        return np.asarray(unit + norm - np.sum(np.log(scale), axis=1) - np.linalg.slogdet(self.root)[1])

    def fitted(self, logs: Floats, weight: Floats) -> "Proposal":
        """The symmetric one with mean and covariance of weighted draws (D, F), drawn to this one if they are few."""
        effective = 1 / np.sum(weight**2)
        share = effective / (effective + len(self.centre))
        mean = weight @ logs
        off = logs - mean
        covariance = share * (weight[:, None] * off).T @ off + (1 - share) * self.root @ self.root
        return symmetric(share * mean + (1 - share) * self.centre, covariance)


def symmetric(centre: Floats, covariance: Floats) -> Proposal:
    """The Student-t about a centre (F,) with a scale matrix (F, F)."""
    values, vectors = np.linalg.eigh(covariance)
    one = np.ones(len(centre))
    return Proposal(centre, (vectors * np.sqrt(np.maximum(values, 0.0))) @ vectors.T, one, one)


def split_at_mode(restricted: Restricted, mode: Floats) -> Proposal:
    """The proposal at the mode (F,) of the free levels' logarithms.

    What the data do not curve has at most the prior's sigma: eigenvalues are in units of the prior's precision.
    """
    sigma = np.asarray(restricted.priors.log_sigma)[list(restricted.free)]
    scaled = restricted.hessian(mode, _DIFFERENCE) * np.outer(sigma, sigma)
    values, vectors = np.linalg.eigh(scaled)
    covariance = (vectors / np.maximum(values, 1.0)) @ vectors.T * np.outer(sigma, sigma)
    proposal = symmetric(mode, covariance)
    centre = restricted.negative_log_density(mode)
    scales = np.empty((2, len(mode)))
    for side, sign in enumerate((-1.0, 1.0)):
        for axis, direction in enumerate(proposal.root):
            falls = [
                (step, restricted.negative_log_density(mode + sign * step * direction) - centre)
                for step in _PROBED_SIGMAS
            ]
            scales[side, axis] = max(step / np.sqrt(2 * max(fall, 1e-3)) for step, fall in falls)
    scales = np.clip(scales, *_SCALE_RANGE)
    return Proposal(mode, proposal.root, scales[0], scales[1])

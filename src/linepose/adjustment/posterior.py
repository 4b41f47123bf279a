"""The posterior of the pose: a mixture over draws of the levels.

Levels are drawn around the REML optimum from a multivariate Student-t with the curvature there, and weighted by the
REML density over it. Given levels, the pose is normal about its linearised value with the covariance of the normal
equations; the curvature's stretch M maps mean and covariance of each about the mode.
"""

from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np
from scipy.stats import chi2, multivariate_t, norm, qmc

from linepose.adjustment.importance import smoothed_weights
from linepose.adjustment.normal import N_POSE, trailing_inverse
from linepose.adjustment.reml import Restricted
from linepose.rotations import Floats

DEGREES_OF_FREEDOM: Final = 5
FIRST_SHARE: Final = 0.35  # of the draws, from which the proposal is fitted anew
DIFFERENCE: Final = 0.1  # of a logarithm, for the curvature


@dataclass(frozen=True)
class Mixture:
    """D components of the pose's posterior, as steps of position and small rotation from the mode.

    weight (D,), mean (D, 6), covariance (D, 6, 6); log_levels (D, 7); negative_log_density (D,): of the levels;
    pareto_shape: of the weights' tail.
    """

    weight: Floats
    mean: Floats
    covariance: Floats
    log_levels: Floats
    negative_log_density: Floats
    pareto_shape: float

    @property
    def effective_size(self) -> float:
        """How many draws of equal weight are worth as much."""
        return float(1 / np.sum(self.weight**2))

    def moments(self) -> tuple[Floats, Floats]:
        """Mean (6,) and covariance (6, 6) of the step from the mode."""
        mean = self.weight @ self.mean
        off = self.mean - mean
        return mean, np.einsum("d,dij->ij", self.weight, self.covariance + off[:, :, None] * off[:, None, :])

    def draw(self, random: np.random.Generator, count: int) -> tuple[Floats, np.ndarray]:
        """Steps (count, 6), and the component (count,) of each; components in proportion to their weights."""
        edges = np.cumsum(self.weight)
        index = np.searchsorted(edges / edges[-1], (np.arange(count) + random.random()) / count).clip(0, len(edges) - 1)
        roots = np.linalg.cholesky(self.covariance)
        steps = self.mean[index] + np.einsum("nij,nj->ni", roots[index], random.standard_normal((count, N_POSE)))
        order = random.permutation(count)
        return steps[order], index[order]


def mixture(restricted: Restricted, mode: Floats, stretch: Floats, n_draws: int, seed: int) -> Mixture:
    """The pose's posterior, from the mode of the free levels' logarithms (F,) and the curvature's stretch (6, 6).

    A first share of the draws comes from the curvature at the mode, the rest from a proposal fitted to those; all count
    as of the mixture of both.
    """
    n_first = int(FIRST_SHARE * n_draws)
    first = Proposal(mode, proposal_covariance(restricted, mode))
    drawn = [_components(restricted, first.draw(n_first, seed))]
    weight, _ = smoothed_weights(-drawn[0].density - first.log_density(drawn[0].logs))
    second = first.fitted(drawn[0].logs, weight)
    drawn.append(_components(restricted, second.draw(n_draws - n_first, seed + 1)))
    logs, density, mean, covariance = (np.concatenate([part[i] for part in drawn]) for i in range(4))
    shares = np.log([n_first / n_draws, 1 - n_first / n_draws])
    proposed = np.logaddexp(shares[0] + first.log_density(logs), shares[1] + second.log_density(logs))
    weight, shape = smoothed_weights(-density - proposed)
    return Mixture(
        weight=weight,
        mean=mean @ stretch.T,
        covariance=stretch @ covariance @ stretch.T,
        log_levels=np.array([restricted.log_levels(row) for row in logs]),
        negative_log_density=density,
        pareto_shape=shape,
    )


def proposal_covariance(restricted: Restricted, mode: Floats) -> Floats:
    """Covariance (F, F) of the free levels' logarithms from the curvature at the mode.

    What the data do not curve has at most the prior's sigma: eigenvalues are in units of the prior's precision.
    """
    sigma = np.asarray(restricted.priors.log_sigma)[list(restricted.free)]
    scaled = restricted.hessian(mode, DIFFERENCE) * np.outer(sigma, sigma)
    values, vectors = np.linalg.eigh(scaled)
    return (vectors / np.maximum(values, 1.0)) @ vectors.T * np.outer(sigma, sigma)


class _Drawn(NamedTuple):
    """Logarithms of levels (D, F), their negative log-density (D,), and the pose's mean (D, 6) and covariance there."""

    logs: Floats
    density: Floats
    mean: Floats
    covariance: Floats


def _components(restricted: Restricted, logs: Floats) -> _Drawn:
    count = len(logs)
    density, mean, covariance = np.empty(count), np.empty((count, N_POSE)), np.empty((count, N_POSE, N_POSE))
    for k, row in enumerate(logs):
        done = restricted.done(row)
        density[k] = restricted.negative_log_density_of(done, row)
        n = len(done.upper) - 1
        block = np.triu(done.upper[n - N_POSE : n, n - N_POSE : n])
        covariance[k] = trailing_inverse(done.upper, N_POSE)
        mean[k] = covariance[k] @ (block.T @ done.upper[n - N_POSE : n, n])
    return _Drawn(logs, density, mean, covariance)


@dataclass(frozen=True)
class Proposal:
    """A multivariate Student-t of levels' logarithms: centre (F,), scale (F, F)."""

    centre: Floats
    scale: Floats

    def draw(self, count: int, seed: int) -> Floats:
        """Draws (count, F) from a scrambled Sobol sequence: evener than chance."""
        n = len(self.centre)
        power = int(np.ceil(np.log2(max(count, 2))))
        uniform = qmc.Sobol(n + 1, rng=np.random.default_rng(seed)).random_base2(power)[:count]
        uniform = np.clip(uniform, 1e-9, 1 - 1e-9)
        radius = np.sqrt(DEGREES_OF_FREEDOM / chi2.ppf(uniform[:, -1], DEGREES_OF_FREEDOM))
        return self.centre + (norm.ppf(uniform[:, :-1]) * radius[:, None]) @ np.linalg.cholesky(self.scale).T

    def log_density(self, logs: Floats) -> Floats:
        """Logarithm of the density (D,) at logarithms (D, F)."""
        return np.atleast_1d(multivariate_t(self.centre, self.scale, df=DEGREES_OF_FREEDOM).logpdf(logs))

    def fitted(self, logs: Floats, weight: Floats) -> "Proposal":
        """The proposal with the mean and covariance of weighted draws (D, F), drawn towards this one as they are few."""
        effective = 1 / np.sum(weight**2)
        share = effective / (effective + len(self.centre))
        mean = weight @ logs
        off = logs - mean
        covariance = (weight[:, None] * off).T @ off
        return Proposal(
            share * mean + (1 - share) * self.centre, share * covariance + (1 - share) * self.scale
        )

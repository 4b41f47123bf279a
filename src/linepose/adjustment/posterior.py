"""The posterior of the pose: a mixture over draws of the levels.

Levels are drawn around the REML optimum from a multivariate Student-t with the curvature there, and weighted by the
REML density over it. Given levels, the pose is normal about its linearised value with the covariance of the normal
equations; the curvature's stretch M maps mean and covariance of each about the mode.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.stats import multivariate_t, norm, qmc

from linepose.adjustment.importance import smoothed_weights
from linepose.adjustment.normal import N_POSE, trailing_inverse
from linepose.adjustment.reml import Restricted
from linepose.rotations import Floats

DEGREES_OF_FREEDOM: Final = 5
_LEAST_PRECISION, _LARGEST_PRECISION = 0.05, 1e4  # of a level's logarithm, in the proposal
_STEP_SIGMAS: Final = 0.5


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


def curvature_of_levels(restricted: Restricted, mode: Floats) -> Floats:
    """Precision (F, F) of the free levels' logarithms at the mode, by differences over about half a sigma."""
    n = len(mode)
    centre = restricted.negative_log_density(mode)
    prior = 1 / np.asarray(restricted.priors.log_sigma)[list(restricted.free)] ** 2

    def pair(width: Floats) -> tuple[Floats, Floats]:
        ahead = np.array([restricted.negative_log_density(mode + row) for row in np.diag(width)])
        behind = np.array([restricted.negative_log_density(mode - row) for row in np.diag(width)])
        return ahead, behind

    width = np.full(n, 0.1)
    ahead, behind = pair(width)
    second = np.clip((ahead + behind - 2 * centre) / width**2, prior, _LARGEST_PRECISION)
    width = _STEP_SIGMAS / np.sqrt(second)
    ahead, behind = pair(width)
    precision = np.diag(np.clip((ahead + behind - 2 * centre) / width**2, _LEAST_PRECISION, _LARGEST_PRECISION))
    for i in range(n):
        for j in range(i):
            step = np.zeros(n)
            step[i], step[j] = width[i], width[j]
            both = restricted.negative_log_density(mode + step) + restricted.negative_log_density(mode - step)
            off = both - ahead[i] - behind[i] - ahead[j] - behind[j] + 2 * centre
            precision[i, j] = precision[j, i] = off / (2 * width[i] * width[j])
    scale = np.sqrt(np.diag(precision))
    values, vectors = np.linalg.eigh(precision / np.outer(scale, scale))
    return (vectors * np.maximum(values, 0.1)) @ vectors.T * np.outer(scale, scale)


def mixture(restricted: Restricted, mode: Floats, stretch: Floats, n_draws: int, seed: int) -> Mixture:
    """The pose's posterior, from the mode of the free levels' logarithms (F,) and the curvature's stretch (6, 6)."""
    precision = curvature_of_levels(restricted, mode)
    scale = np.linalg.inv(precision)
    proposal = multivariate_t(mode, scale, df=DEGREES_OF_FREEDOM)
    draws = _student_draws(mode, np.linalg.cholesky(scale), n_draws, seed)
    density, means, covariances = np.empty(n_draws), np.empty((n_draws, N_POSE)), np.empty((n_draws, N_POSE, N_POSE))
    for k, logs in enumerate(draws):
        done = restricted.done(logs)
        density[k] = restricted.negative_log_density_of(done, logs)
        n = len(done.upper) - 1
        covariances[k] = trailing_inverse(done.upper, N_POSE)
        block = np.triu(done.upper[n - N_POSE : n, n - N_POSE : n])
        means[k] = covariances[k] @ (block.T @ done.upper[n - N_POSE : n, n])
    weight, shape = smoothed_weights(-density - proposal.logpdf(draws))
    return Mixture(
        weight=weight,
        mean=means @ stretch.T,
        covariance=stretch @ covariances @ stretch.T,
        log_levels=np.array([restricted.log_levels(logs) for logs in draws]),
        negative_log_density=density,
        pareto_shape=shape,
    )


def _student_draws(mode: Floats, root: Floats, n_draws: int, seed: int) -> Floats:
    """Draws (D, F) of the proposal, from a scrambled Sobol sequence: evener than chance."""
    n = len(mode)
    power = int(np.ceil(np.log2(n_draws)))
    uniform = qmc.Sobol(n + 1, rng=np.random.default_rng(seed)).random_base2(power)[:n_draws]
    uniform = np.clip(uniform, 1e-9, 1 - 1e-9)
    from scipy.stats import chi2

    radius = np.sqrt(DEGREES_OF_FREEDOM / chi2.ppf(uniform[:, -1], DEGREES_OF_FREEDOM))
    return mode + (norm.ppf(uniform[:, :-1]) * radius[:, None]) @ root.T

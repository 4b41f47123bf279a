"""Independent samples of a posterior without a chain: draws around the optimum, weighted by what they miss.

Draws come from a multivariate Student-t at the optimum, whose tails are heavier than a posterior's, and are weighted by
posterior over proposal. From the first part the proposal is fitted anew, for a posterior that is skewed or wider than
its curvature says; all draws count as of the mixture of both. The largest weights are replaced by the quantiles of a
generalised Pareto distribution (Vehtari, Simpson, Gelman, Yao, Gabry 2024), whose shape k tells whether the weights can
be trusted: below 0.7 they can. For a likelihood of some tenths of a millisecond this takes under a second.
"""

from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import logsumexp
from scipy.stats import multivariate_t

from linepose.arrays import Floats
from linepose.errors import EstimationError
from linepose.likelihood.base import Likelihood

DEGREES_OF_FREEDOM: Final = 5
FIRST_SHARE: Final = 0.25  # of the draws, from which the proposal is fitted anew
TRUSTED_SHAPE: Final = 0.7
_PRIOR_SHAPE, _PRIOR_COUNT = 0.5, 10.0  # a weak prior of the shape, for short tails


@dataclass(frozen=True)
class WeightedSamples:
    """Draws (S, P) with weights (S,) that sum to one, and the Pareto shape k of the weights' tail."""

    parameters: Floats
    weights: Floats
    pareto_shape: float

    @property
    def effective_sample_size(self) -> float:
        """How many independent draws are worth as much, `1 / sum w^2`."""
        return float(1 / np.sum(self.weights**2))

    def mean(self) -> Floats:
        """Posterior mean (P,)."""
        return np.asarray(self.weights @ self.parameters)

    def covariance(self) -> Floats:
        """Posterior covariance (P, P)."""
        return np.cov(self.parameters.T, aweights=self.weights)

    def resample(self, random: np.random.Generator, count: int) -> Floats:
        """Draws (count, P) of equal weight."""
        return self.parameters[random.choice(len(self.weights), size=count, p=self.weights)]


def importance_samples(
    likelihood: Likelihood, optimum: ArrayLike, covariance: ArrayLike, random: np.random.Generator, n_draws: int = 2000
) -> WeightedSamples:
    """Weighted samples of the posterior, from its optimum (P,) and its covariance there (P, P).

    Raises EstimationError where the density is zero at all draws.
    """
    centre, factor = np.asarray(optimum, dtype=float), np.linalg.cholesky(np.asarray(covariance, dtype=float))
    n_first = int(FIRST_SHARE * n_draws)

    def log_density(draws: Floats) -> Floats:
        return likelihood.log_likelihoods(centre + draws @ factor.T)

    first: Any = multivariate_t(np.zeros(len(centre)), np.eye(len(centre)), df=DEGREES_OF_FREEDOM)
    draws = first.rvs(n_first, random_state=random)
    density = log_density(draws)
    second = _fitted(draws, density - first.logpdf(draws), first)
    more = second.rvs(n_draws - n_first, random_state=random)
    draws, density = np.concatenate([draws, more]), np.concatenate([density, log_density(more)])
    shares = np.array([n_first, n_draws - n_first]) / n_draws
    proposal = logsumexp([first.logpdf(draws), second.logpdf(draws)], axis=0, b=shares[:, None])
    log_weights, shape = pareto_smoothed(density - proposal)
    return WeightedSamples(centre + draws @ factor.T, np.exp(log_weights), shape)


def pareto_smoothed(log_ratios: ArrayLike) -> tuple[Floats, float]:
    """Normalised log-weights (S,) from log importance ratios (S,), and the Pareto shape k of their tail.

    The tail is the largest `min(S/5, 3 sqrt S)` ratios. Raises EstimationError where no ratio is above zero.
    """
    ratios = np.asarray(log_ratios, dtype=float)
    if not np.any(np.isfinite(ratios)):
        raise EstimationError("no importance weights: the density is zero at all draws; start from another optimum")
    logs = ratios - ratios.max()
    n_tail = int(min(len(logs) / 5, 3 * np.sqrt(len(logs))))
    order = np.argsort(logs, kind="stable")
    tail, cut = order[len(logs) - n_tail :], logs[order[len(logs) - n_tail - 1]]
    excess = np.exp(logs[tail]) - np.exp(cut)
    shape = np.inf
    if n_tail >= 5 and excess[0] > 0:
        shape, scale = generalised_pareto(excess)
        share = (np.arange(n_tail) + 0.5) / n_tail
        quantiles = -scale * np.log1p(-share) if shape == 0 else scale * np.expm1(-shape * np.log1p(-share)) / shape
        logs[tail] = np.minimum(np.log(np.exp(cut) + quantiles), 0.0)
    return logs - logsumexp(logs), float(shape)


def generalised_pareto(excess: Floats) -> tuple[float, float]:
    """Shape and scale of a generalised Pareto distribution from ascending excesses (n,).

    The estimate of Zhang and Stephens (2009): the likelihood in `theta = -shape / scale` averaged over a grid, with a
    weak prior that draws the shape towards 1/2.
    """
    count = len(excess)
    grid = 30 + int(np.sqrt(count))
    quartile = excess[int(count / 4 + 0.5) - 1]
    theta = 1 / excess[-1] + (1 - np.sqrt(grid / (np.arange(grid) + 0.5))) / (3 * quartile)
    shapes = -np.log1p(-theta[:, None] * excess).mean(axis=1)
    profile = count * (np.log(theta / shapes) + shapes - 1)
    best = float(np.exp(profile - logsumexp(profile)) @ theta)
    shape = -float(np.log1p(-best * excess).mean())
    scale = shape / best
    shape = -shape
    return (count * shape + _PRIOR_COUNT * _PRIOR_SHAPE) / (count + _PRIOR_COUNT), scale


def _fitted(draws: Floats, log_ratios: Floats, before: Any) -> Any:
    """A proposal with mean and covariance of the weighted draws; the one before where too few of them count."""
    log_weights, _ = pareto_smoothed(log_ratios)
    samples = WeightedSamples(draws, np.exp(log_weights), np.nan)
    if samples.effective_sample_size < 5 * draws.shape[1]:
        return before
    return multivariate_t(samples.mean(), samples.covariance(), df=DEGREES_OF_FREEDOM)

"""The posterior of what is sought, the pose and perhaps the clock offset: a mixture over draws of the levels.

Levels are drawn around the REML optimum from a multivariate Student-t with the curvature there, and weighted by the
REML density over it. Given levels, what is sought is normal about its linearised value with the covariance of the
normal equations; the curvature's stretch M maps mean and covariance of each about the mode.
"""

from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np
from scipy.special import logsumexp

from linepose.adjustment.importance import smoothed_weights
from linepose.adjustment.proposal import Proposal, split_at_mode
from linepose.adjustment.reml import Restricted
from linepose.arrays import Floats

STAGE_SHARES: Final = (0.25, 0.25, 0.5)  # of the draws


@dataclass(frozen=True)
class Mixture:
    """D components of the posterior of the S last columns, as steps from the mode: position and small rotation last.

    weight (D,), mean (D, S), covariance (D, S, S); log_levels (D, 7); negative_log_density (D,): of the levels;
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
        """Mean (S,) and covariance (S, S) of the step from the mode."""
        mean = self.weight @ self.mean
        off = self.mean - mean
        return mean, np.einsum("d,dij->ij", self.weight, self.covariance + off[:, :, None] * off[:, None, :])

    def draw(self, random: np.random.Generator, count: int) -> tuple[Floats, np.ndarray]:
        """Steps (count, S), and the component (count,) of each; components in proportion to their weights."""
        edges = np.cumsum(self.weight)
        index = np.searchsorted(edges / edges[-1], (np.arange(count) + random.random()) / count).clip(0, len(edges) - 1)
        roots = np.linalg.cholesky(self.covariance)
        steps = self.mean[index] + np.einsum(
            "nij,nj->ni", roots[index], random.standard_normal((count, self.mean.shape[1]))
        )
        order = random.permutation(count)
        return steps[order], index[order]


def mixture(restricted: Restricted, mode: Floats, stretch: Floats, n_draws: int, seed: int) -> Mixture:
    """The posterior, from the mode of the free levels' logarithms (F,) and the curvature's stretch (S, S).

    The first draws come from the proposal at the mode, later ones from a proposal fitted to all before; each counts as
    of the mixture of all (deterministic mixture, Owen and Zhou 2000).
    """
    stages = [max(int(share * n_draws), 1) for share in STAGE_SHARES]
    stages[-1] = n_draws - sum(stages[:-1])
    base = split_at_mode(restricted, mode)
    proposals, drawn = [base], [_components(restricted, base.draw(stages[0], seed), len(stretch))]
    for stage, count in enumerate(stages[1:], start=1):
        weight, _ = _weights(proposals, stages[:stage], drawn)
        proposals.append(base.fitted(np.concatenate([part.logs for part in drawn]), weight))
        drawn.append(_components(restricted, proposals[-1].draw(count, seed + stage), len(stretch)))
    weight, shape = _weights(proposals, stages, drawn)
    logs, density, mean, covariance = (np.concatenate([part[i] for part in drawn]) for i in range(4))
    return Mixture(
        weight=weight,
        mean=mean @ stretch.T,
        covariance=stretch @ covariance @ stretch.T,
        log_levels=np.array([restricted.log_levels(row) for row in logs]),
        negative_log_density=density,
        pareto_shape=shape,
    )


class _Component(NamedTuple):
    """Logarithms of levels (D, F), their negative log-density (D,), mean (D, S) and covariance there."""

    logs: Floats
    density: Floats
    mean: Floats
    covariance: Floats


def _components(restricted: Restricted, logs: Floats, size: int) -> _Component:
    density, drawn = restricted.drawn(logs, size)
    return _Component(logs, density, drawn.mean, drawn.covariance)


def _weights(proposals: list[Proposal], counts: list[int], drawn: list[_Component]) -> tuple[Floats, float]:
    """Weights of all draws against the mixture of their proposals, and the Pareto shape."""
    logs = np.concatenate([part.logs for part in drawn])
    shares = np.log(np.array(counts) / sum(counts))
    proposed = logsumexp([share + one.log_density(logs) for share, one in zip(shares, proposals, strict=True)], axis=0)
    return smoothed_weights(-np.concatenate([part.density for part in drawn]) - proposed)

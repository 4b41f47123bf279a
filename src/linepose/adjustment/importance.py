"""Weights of draws, and whether they can be trusted: Pareto smoothing (Vehtari, Simpson, Gelman, Yao, Gabry 2024)."""

from typing import Final

import numpy as np
from scipy.special import logsumexp

from linepose.arrays import Floats

TRUSTED_SHAPE: Final = 0.7  # of the Pareto tail, above which the weights cannot be trusted
_FEWEST_IN_TAIL: Final = 5
_PRIOR_SHAPE, _PRIOR_COUNT = 0.5, 10.0  # a weak prior of the shape, for short tails


def smoothed_weights(log_ratios: Floats) -> tuple[Floats, float]:
    """Weights (S,) that sum to one from logarithms (S,) of target over proposal, and the shape of their tail.

    The largest `min(S/5, 3 sqrt S)` ratios are replaced by the quantiles of the generalised Pareto distribution that
    fits them.
    """
    logs = log_ratios - log_ratios.max()
    n_tail = int(min(len(logs) / 5, 3 * np.sqrt(len(logs))))
    shape = np.inf
    if n_tail >= _FEWEST_IN_TAIL:
        order = np.argsort(logs, kind="stable")
        tail, cut = order[len(logs) - n_tail :], logs[order[len(logs) - n_tail - 1]]
        excess = np.exp(logs[tail]) - np.exp(cut)
        if excess[0] > 0:
            shape, scale = generalised_pareto(excess)
            share = (np.arange(n_tail) + 0.5) / n_tail
            quantiles = -scale * np.log1p(-share) if shape == 0 else scale * np.expm1(-shape * np.log1p(-share)) / shape
            logs = logs.copy()
            logs[tail] = np.minimum(np.log(np.exp(cut) + quantiles), 0.0)
    return np.exp(logs - logsumexp(logs)), float(shape)


def generalised_pareto(excess: Floats) -> tuple[float, float]:
    """Shape and scale of a generalised Pareto distribution from ascending excesses (n,).

    The estimate of Zhang and Stephens (2009), with a weak prior that draws the shape towards 1/2.
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
    return (-count * shape + _PRIOR_COUNT * _PRIOR_SHAPE) / (count + _PRIOR_COUNT), scale

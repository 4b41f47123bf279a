"""Weights of draws, and whether they can be trusted: Pareto smoothing (Vehtari, Simpson, Gelman, Yao, Gabry 2024)."""

from typing import Final

import numpy as np
from scipy.special import softmax

from linepose.arrays import Floats

_FEWEST_DRAWS: Final = 25  # of which a fifth are a tail long enough to fit


def smoothed_weights(log_ratios: Floats) -> tuple[Floats, float]:
    """Weights (S,) that sum to one from logarithms (S,) of target over proposal, and the shape of their tail.

    The largest `min(S/5, 3 sqrt S)` ratios are replaced by the quantiles of the generalised Pareto distribution that
    fits them; where they are too few or all alike the weights stay as they are and the shape is infinite.
    """
    from arviz_stats.base import array_stats

    if len(log_ratios) < _FEWEST_DRAWS or np.ptp(log_ratios) == 0:
        return softmax(log_ratios), np.inf
    logs, shape = array_stats.psislw(log_ratios.max() - log_ratios)  # it takes the negative
    return np.exp(np.asarray(logs)), float(shape)

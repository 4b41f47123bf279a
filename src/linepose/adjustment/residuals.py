"""Residuals normalised by the model: what should be standard normal numbers if the error process is right."""

import numpy as np
from scipy.linalg import solve_triangular

from linepose.adjustment.normal import Pass, whitened_residual
from linepose.arrays import Floats

_LEAST_REDUNDANCY = 1e-6  # below which a residual is nothing but rounding


def normalised_residuals(done: Pass) -> Floats:
    """Whitened residuals (L, 2) at the minimum, each divided by its sigma `sqrt(1 - leverage)`; NaN where that is zero.

    The leverage is what the estimated points and camera take of it.
    """
    n = len(done.upper) - 1
    upper = np.triu(done.upper)
    step = solve_triangular(upper[:n, :n], upper[:n, n])
    residual = whitened_residual(done, step)
    taken = solve_triangular(upper[:n, :n], done.whitened[:, :n].T, trans="T")
    redundancy = (1 - np.sum(taken**2, axis=0)).reshape(-1, 2)
    return np.where(redundancy > _LEAST_REDUNDANCY, residual / np.sqrt(np.maximum(redundancy, 1e-300)), np.nan)

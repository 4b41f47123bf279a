"""The compiled log-likelihood of the shared-error model, of one row of parameters and of many."""

import numpy as np
from numba import njit, prange

from linepose.arrays import Floats
from linepose.likelihood.shared_arrays import SharedArrays
from linepose.likelihood.shared_kernel import FixedOptics, levels_at, optics_at
from linepose.likelihood.shared_marginal import marginal


@njit(cache=True, error_model="numpy")
def log_prior(parameters: Floats, centre: Floats, sigma: Floats) -> float:
    """Log-density of the Gaussian priors of all parameters but the pose (11,), up to a constant; centre, sigma (5,)."""
    total = 0.0
    for i in range(centre.shape[0]):
        total -= 0.5 * ((parameters[6 + i] - centre[i]) / sigma[i]) ** 2
    return total


@njit(cache=True, error_model="numpy")
def row_log_likelihood(
    arrays: SharedArrays, fixed: FixedOptics, n_points: int, centre: Floats, sigma: Floats, parameters: Floats
) -> float:
    """Log-likelihood and log-prior of one row (11,); minus infinity where the model is undefined."""
    if not (np.all(np.isfinite(parameters)) and parameters[10] > 0.0):
        return -np.inf
    n_views = arrays.view_first.shape[0] - 1
    result = marginal(
        arrays,
        optics_at(parameters, fixed),
        levels_at(parameters),
        n_points,
        np.ones(n_views),
        np.ones(arrays.u_px.shape[0]),
    )
    value = log_prior(parameters, centre, sigma) - 0.5 * (result.chi_squared + result.log_determinant)
    return value if np.isfinite(value) else -np.inf


@njit(cache=True, error_model="numpy", parallel=True)
def rows_log_likelihood(
    arrays: SharedArrays, fixed: FixedOptics, n_points: int, centre: Floats, sigma: Floats, rows: Floats
) -> Floats:
    """`row_log_likelihood` of each row (K, 11), one thread a row: the same numbers on any number of threads."""
    values = np.empty(rows.shape[0])
    for row in prange(rows.shape[0]):
        values[row] = row_log_likelihood(arrays, fixed, n_points, centre, sigma, rows[row])
    return values

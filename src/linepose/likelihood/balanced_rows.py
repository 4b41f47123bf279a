"""The compiled log-likelihood of the balanced model, of one row of parameters and of many; see `balanced`."""

import numpy as np
from numba import njit, prange

from linepose.arrays import Floats
from linepose.likelihood.shared_arrays import SharedArrays
from linepose.likelihood.shared_kernel import FixedOptics, Levels, Optics, empty_lines, levels_at, linearise, optics_at
from linepose.likelihood.shared_marginal import marginal, normal_equations, solve_system
from linepose.likelihood.shared_rows import log_prior


@njit(cache=True, error_model="numpy")
def log_determinant_at(arrays: SharedArrays, optics: Optics, levels: Levels, points_m: Floats) -> float:
    """`sum log|C_i| + log|H_PP|`, linearised at the points (K, 3); infinite where one is behind the camera."""
    lines = empty_lines(arrays.u_px.shape[0])
    if not linearise(arrays, optics, levels, points_m, lines):
        return np.inf
    views = arrays.view_first.shape[0] - 1
    system = normal_equations(arrays, lines, points_m.shape[0], np.ones(views), np.ones(arrays.u_px.shape[0]))
    log_determinant, _ = solve_system(system)
    return log_determinant + np.sum(lines.log_determinant)


@njit(cache=True, error_model="numpy")
def row_log_likelihood(
    arrays: SharedArrays,
    fixed: FixedOptics,
    reference: Levels,
    n_points: int,
    centre: Floats,
    sigma: Floats,
    parameters: Floats,
) -> float:
    """Log-likelihood and log-prior of one row (11,); minus infinity where the model is undefined."""
    if not (np.all(np.isfinite(parameters)) and parameters[10] > 0.0):
        return -np.inf
    views, lines = np.ones(arrays.view_first.shape[0] - 1), np.ones(arrays.u_px.shape[0])
    optics = optics_at(parameters, fixed)
    found = marginal(arrays, optics, levels_at(parameters), n_points, views, lines)
    if not np.isfinite(found.chi_squared):
        return -np.inf
    balance = log_determinant_at(arrays, optics, reference, found.points_m)
    value = log_prior(parameters, centre, sigma) - 0.5 * (found.chi_squared + found.log_determinant - balance)
    return value if np.isfinite(value) else -np.inf


@njit(cache=True, error_model="numpy", parallel=True)
def rows_log_likelihood(
    arrays: SharedArrays,
    fixed: FixedOptics,
    reference: Levels,
    n_points: int,
    centre: Floats,
    sigma: Floats,
    rows: Floats,
) -> Floats:
    """`row_log_likelihood` of each row (K, 11), one thread a row: the same numbers on any number of threads."""
    values = np.empty(rows.shape[0])
    for row in prange(rows.shape[0]):
        values[row] = row_log_likelihood(arrays, fixed, reference, n_points, centre, sigma, rows[row])
    return values

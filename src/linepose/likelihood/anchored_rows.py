"""The compiled log-likelihood of the shared-error model with its determinants at an anchor; see `anchored`."""

from typing import NamedTuple

import numpy as np
from numba import njit, prange

from linepose.likelihood.shared_arrays import SharedArrays
from linepose.likelihood.shared_kernel import FixedOptics, Levels, empty_lines, levels_at, linearise, optics_at
from linepose.likelihood.shared_marginal import marginal, normal_equations, solve_system
from linepose.likelihood.shared_rows import log_prior
from linepose.rotations import Floats


class Anchor(NamedTuple):
    """Where determinants are taken: parameters (11,), of which the levels do not count, and points (K, 3)."""

    parameters: Floats
    points_m: Floats


@njit(cache=True, error_model="numpy")
def anchored_log_determinant(arrays: SharedArrays, fixed: FixedOptics, anchor: Anchor, levels: Levels) -> float:
    """`sum log|C_i| + log|H_PP|` for the levels, at the anchor's pose, intrinsics and points."""
    lines = empty_lines(arrays.u_px.shape[0])
    if not linearise(arrays, optics_at(anchor.parameters, fixed), levels, anchor.points_m, lines):
        return np.inf
    views = arrays.view_first.shape[0] - 1
    system = normal_equations(arrays, lines, anchor.points_m.shape[0], np.ones(views), np.ones(arrays.u_px.shape[0]))
    log_determinant, _ = solve_system(system)
    return log_determinant + np.sum(lines.log_determinant)


@njit(cache=True, error_model="numpy")
def row_log_likelihood(
    arrays: SharedArrays, fixed: FixedOptics, anchor: Anchor, centre: Floats, sigma: Floats, parameters: Floats
) -> float:
    """Log-likelihood and log-prior of one row (11,); minus infinity where the model is undefined."""
    if not (np.all(np.isfinite(parameters)) and parameters[10] > 0.0):
        return -np.inf
    levels = levels_at(parameters)
    views, lines = np.ones(arrays.view_first.shape[0] - 1), np.ones(arrays.u_px.shape[0])
    found = marginal(arrays, optics_at(parameters, fixed), levels, anchor.points_m.shape[0], views, lines)
    log_determinant = anchored_log_determinant(arrays, fixed, anchor, levels)
    value = log_prior(parameters, centre, sigma) - 0.5 * (found.chi_squared + log_determinant)
    return value if np.isfinite(value) else -np.inf


@njit(cache=True, error_model="numpy", parallel=True)
def rows_log_likelihood(
    arrays: SharedArrays, fixed: FixedOptics, anchor: Anchor, centre: Floats, sigma: Floats, rows: Floats
) -> Floats:
    """`row_log_likelihood` of each row (K, 11), one thread a row: the same numbers on any number of threads."""
    values = np.empty(rows.shape[0])
    for row in prange(rows.shape[0]):
        values[row] = row_log_likelihood(arrays, fixed, anchor, centre, sigma, rows[row])
    return values

"""The compiled marginal likelihood of the robust model: every view and every line with a weight of its own.

Given the weights the model is the shared-error one, Gaussian; given the mean squares of what they scale, the weights
are Gamma-distributed. Alternating between the two (variational Bayes) raises a lower bound of the marginal likelihood
until it stands still, at the bound that is returned.
"""

from typing import NamedTuple

import numpy as np
from numba import njit, prange

from linepose.arrays import Floats
from linepose.likelihood.block_system import covariance_blocks, solve_blocks
from linepose.likelihood.shared_arrays import SharedArrays
from linepose.likelihood.shared_kernel import (
    FixedOptics,
    Levels,
    Lines,
    Optics,
    empty_lines,
    levels_at,
    linearise,
    optics_at,
)
from linepose.likelihood.shared_marginal import (
    Marginal,
    System,
    block_diagonal,
    initial_points,
    normal_equations,
    squared_residuals,
)
from linepose.likelihood.shared_rows import log_prior

MAXIMUM_SWEEPS = 60
LARGEST_FEEDBACK = 0.8
WEIGHT_TOLERANCE = 3e-3  # in the logarithm; the bound is stationary in the weights, so its own error is the square
VIEW_SIZE, LINE_SIZE = 6, 2


class Freedom(NamedTuple):
    """Degrees of freedom of the Student-t distributions of a view's shared error and of a line's own error."""

    of_view: float
    of_line: float


class RobustMarginal(NamedTuple):
    """The bound's Gaussian part, the mean weights (N,) of views and (L,) of lines, and the weights' share of it."""

    marginal: Marginal
    view_weight: Floats
    line_weight: Floats
    log_weights: float


@njit(cache=True, error_model="numpy")
def solve_moments(system: System) -> tuple[float, float, Floats, Floats, Floats]:
    """Solve the normal equations in place, and the covariances of what is solved for.

    Log-determinant, decrease of chi squared; covariances of points (K, 3, 3) and views (N, 6, 6), and between them
    (6 N, 3 K).
    """
    n_points, n_views = system.points.shape[0], system.views.shape[0]
    if 3 * n_points <= 6 * n_views:
        kept = block_diagonal(system.points)
        log_determinant, decrease = solve_blocks(
            system.views, system.cross, kept, system.view_vector, system.point_vector
        )
        views, cross, whole = covariance_blocks(system.views, system.cross, kept)
        points = _diagonal_blocks(whole, 3)
    else:
        kept, across = block_diagonal(system.views), system.cross.T.copy()
        log_determinant, decrease = solve_blocks(system.points, across, kept, system.point_vector, system.view_vector)
        points, transposed, whole = covariance_blocks(system.points, across, kept)
        views, cross = _diagonal_blocks(whole, 6), transposed.T.copy()
    return log_determinant, decrease, points, views, cross


@njit(cache=True, error_model="numpy")
def _diagonal_blocks(matrix: Floats, size: int) -> Floats:
    blocks = np.empty((matrix.shape[0] // size, size, size))
    for block in range(blocks.shape[0]):
        first = block * size
        blocks[block] = matrix[first : first + size, first : first + size]
    return blocks


@njit(cache=True, error_model="numpy")
def view_squares(errors: Floats, covariances: Floats, squares: Floats, slopes: Floats) -> None:
    """Fill (N,) the expected squares of the views' standardised errors, and minus their slopes by the own weight.

    errors (N, 6): posterior means; covariances (N, 6, 6).
    """
    for view in range(squares.shape[0]):
        squares[view], slopes[view] = 0.0, 0.0
        for c in range(6):
            squares[view] += errors[view, c] ** 2 + covariances[view, c, c]
            for d in range(6):
                covariance = covariances[view, c, d]
                slopes[view] += covariance**2 + 2.0 * errors[view, c] * covariance * errors[view, d]


@njit(cache=True, error_model="numpy")
def line_squares(
    arrays: SharedArrays,
    lines: Lines,
    system: System,
    points: Floats,
    views: Floats,
    cross: Floats,
    squares: Floats,
    slopes: Floats,
) -> None:
    """Fill (L,) the expected `n^T D^-1 n` of the lines' own errors, and minus their slopes by the own weight.

    The system is solved; the covariances are those of `solve_moments`.
    """
    by_all, mean, joint, half = np.empty((2, 9)), np.empty(9), np.empty((9, 9)), np.empty((2, 9))
    for line in range(squares.shape[0]):
        view, point = arrays.line_view[line], arrays.line_point[line]
        for i in range(3):
            by_all[0, i], by_all[1, i] = lines.by_point[line, 0, i], lines.by_point[line, 1, i]
            mean[i] = system.point_vector[3 * point + i]
            for j in range(3):
                joint[i, j] = points[point, i, j]
            for c in range(6):
                joint[3 + c, i] = joint[i, 3 + c] = cross[6 * view + c, 3 * point + i]
        for c in range(6):
            by_all[0, 3 + c], by_all[1, 3 + c] = lines.by_shared[line, 0, c], lines.by_shared[line, 1, c]
            mean[3 + c] = system.view_vector[6 * view + c]
            for d in range(6):
                joint[3 + c, 3 + d] = views[view, c, d]
        u, v = lines.residual_px[line, 0], lines.residual_px[line, 1]
        half[:] = 0.0
        for i in range(9):
            along, across = by_all[0, i], by_all[1, i]
            u -= along * mean[i]
            v -= across * mean[i]
            for j in range(9):
                half[0, j] += along * joint[i, j]
                half[1, j] += across * joint[i, j]
        uu, uv, vv = 0.0, 0.0, 0.0
        for j in range(9):
            uu += half[0, j] * by_all[0, j]
            uv += half[0, j] * by_all[1, j]
            vv += half[1, j] * by_all[1, j]
        p_uu, p_uv, p_vv = lines.precision[line, 0], lines.precision[line, 1], lines.precision[line, 2]
        weighted_u, weighted_v = p_uu * u + p_uv * v, p_uv * u + p_vv * v
        m_uu, m_uv = p_uu * uu + p_uv * uv, p_uu * uv + p_uv * vv
        m_vu, m_vv = p_uv * uu + p_vv * uv, p_uv * uv + p_vv * vv
        squares[line] = weighted_u * u + weighted_v * v + m_uu + m_vv
        slopes[line] = m_uu**2 + 2.0 * m_uv * m_vu + m_vv**2
        slopes[line] += 2.0 * (uu * weighted_u**2 + 2.0 * uv * weighted_u * weighted_v + vv * weighted_v**2)


@njit(cache=True, error_model="numpy")
def weight_steps(weight: Floats, square: Floats, slope: Floats, freedom: float, size: int, steps: Floats) -> float:
    """Fill the steps of the logarithms towards `(freedom + size) / (freedom + square)`; the largest change asked for.

    The square itself falls as its weight grows: the step allows for that (Newton's in the own weight, bounded), which
    leaves the resting point where it is and takes a quarter of the sweeps.
    """
    largest = 0.0
    for i in range(weight.shape[0]):
        asked = np.log((freedom + size) / (freedom + square[i]) / weight[i])
        feedback = min(slope[i] * weight[i] / (freedom + square[i]), LARGEST_FEEDBACK)
        steps[i] = asked / (1.0 - feedback)
        largest = max(largest, abs(asked))
    return largest


@njit(cache=True, error_model="numpy")
def extrapolation_factor(steps: Floats, before: Floats) -> float:
    """How many such steps remain in all, if they keep shrinking as from `before` to `steps`; between 1 and 5."""
    shrinkage = np.sum(steps * before) / max(np.sum(before * before), np.finfo(np.float64).tiny)
    return 1.0 / (1.0 - min(max(shrinkage, 0.0), LARGEST_FEEDBACK))


@njit(cache=True, error_model="numpy")
def weight_terms(weight: Floats, freedom: float, size: int) -> float:
    """The weights' share of the bound: expected log-scale less the divergence from the prior; 0 where all are one."""
    total = 0.0
    for i in range(weight.shape[0]):
        total += 0.5 * (freedom + size) * np.log(weight[i]) - 0.5 * freedom * (weight[i] - 1.0)
    return total


@njit(cache=True, error_model="numpy")
def robust_marginal(
    arrays: SharedArrays, optics: Optics, levels: Levels, freedom: Freedom, n_points: int
) -> RobustMarginal:
    """The bound where the weights stand still, lines linearised anew in every sweep."""
    n_views, n_lines = arrays.view_first.shape[0] - 1, arrays.u_px.shape[0]
    view_weight, line_weight = np.ones(n_views), np.ones(n_lines)
    view_square, view_slope = np.empty(n_views), np.empty(n_views)
    line_square, line_slope = np.empty(n_lines), np.empty(n_lines)
    steps, before = np.zeros(n_views + n_lines), np.zeros(n_views + n_lines)
    lines = empty_lines(n_lines)
    valid, points_m = initial_points(arrays, optics, n_points)
    errors = np.zeros((n_views, 6))
    undefined = Marginal(np.inf, np.inf, points_m, errors)
    for sweep in range(MAXIMUM_SWEEPS):
        if not valid or not linearise(arrays, optics, levels, points_m, lines):
            return RobustMarginal(undefined, view_weight, line_weight, 0.0)
        system = normal_equations(arrays, lines, n_points, view_weight, line_weight)
        log_determinant, decrease, points, views, cross = solve_moments(system)
        if np.isnan(log_determinant):
            return RobustMarginal(undefined, view_weight, line_weight, 0.0)
        points_m += system.point_vector.reshape(n_points, 3)
        found = Marginal(
            squared_residuals(lines, line_weight) - decrease,
            log_determinant + np.sum(lines.log_determinant),
            points_m,
            system.view_vector.reshape(n_views, 6),
        )
        log_weights = weight_terms(view_weight, freedom.of_view, VIEW_SIZE)
        log_weights += weight_terms(line_weight, freedom.of_line, LINE_SIZE)
        result = RobustMarginal(found, view_weight.copy(), line_weight.copy(), log_weights)
        view_squares(found.errors, views, view_square, view_slope)
        line_squares(arrays, lines, system, points, views, cross, line_square, line_slope)
        before[:] = steps
        asked_of_views = weight_steps(view_weight, view_square, view_slope, freedom.of_view, VIEW_SIZE, steps[:n_views])
        asked_of_lines = weight_steps(line_weight, line_square, line_slope, freedom.of_line, LINE_SIZE, steps[n_views:])
        if max(asked_of_views, asked_of_lines) < WEIGHT_TOLERANCE:
            break
        factor = extrapolation_factor(steps, before) if sweep > 0 and sweep % 2 == 0 else 1.0
        view_weight *= np.exp(factor * steps[:n_views])
        line_weight *= np.exp(factor * steps[n_views:])
    return result


@njit(cache=True, error_model="numpy")
def row_log_likelihood(
    arrays: SharedArrays,
    fixed: FixedOptics,
    freedom: Freedom,
    n_points: int,
    centre: Floats,
    sigma: Floats,
    parameters: Floats,
) -> float:
    """Log-likelihood bound and log-prior of one row (11,); minus infinity where the model is undefined."""
    if not (np.all(np.isfinite(parameters)) and parameters[10] > 0.0):
        return -np.inf
    result = robust_marginal(arrays, optics_at(parameters, fixed), levels_at(parameters), freedom, n_points)
    gaussian = -0.5 * (result.marginal.chi_squared + result.marginal.log_determinant)
    value = log_prior(parameters, centre, sigma) + gaussian + result.log_weights
    return value if np.isfinite(value) else -np.inf


@njit(cache=True, error_model="numpy", parallel=True)
def rows_log_likelihood(
    arrays: SharedArrays,
    fixed: FixedOptics,
    freedom: Freedom,
    n_points: int,
    centre: Floats,
    sigma: Floats,
    rows: Floats,
) -> Floats:
    """`row_log_likelihood` of each row (K, 11), one thread a row: the same numbers on any number of threads."""
    values = np.empty(rows.shape[0])
    for row in prange(rows.shape[0]):
        values[row] = row_log_likelihood(arrays, fixed, freedom, n_points, centre, sigma, rows[row])
    return values

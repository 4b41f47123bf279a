"""The compiled marginal likelihood of the shared-error model: points and shared errors integrated out.

Given a camera pose, intrinsics and levels, the residuals are linear and Gaussian in the points' steps dP (flat prior)
and the views' standardised errors z (unit normal). Integrating over z gives each view's covariance C_i,
integrating over dP the matrix H_PP; the determinant lemma joins both, `sum log|C_i| + log|H_PP| = sum log|D| + log|N|`,
N the normal equations of (dP, z), so neither C_i nor its inverse is ever formed.
"""

from typing import NamedTuple

import numpy as np
from numba import njit

from linepose.arrays import Floats
from linepose.likelihood.block_system import factorise, solve_blocks, solve_transposed, solve_upper
from linepose.likelihood.shared_arrays import SharedArrays
from linepose.likelihood.shared_kernel import (
    Levels,
    Lines,
    Optics,
    empty_lines,
    intersect_rays,
    linearise,
    project_line,
)

TRIANGULATION_STEPS = 1
MARGINAL_STEPS = 2


class System(NamedTuple):
    """Normal equations of the points' steps and the views' errors; see `block_system`.

    points (K, 3, 3), views (N, 6, 6), cross (6 N, 3 K), point_vector (3 K,), view_vector (6 N,).
    """

    points: Floats
    views: Floats
    cross: Floats
    point_vector: Floats
    view_vector: Floats


class Marginal(NamedTuple):
    """The marginal and where it was linearised; not finite where a point is behind the camera.

    chi_squared: its minimum over points and shared errors; log_determinant: `sum log|C_i| + log|H_PP|`;
    points_m (K, 3): the estimate, one step after the last linearisation; errors (N, 6): standardised shared errors.
    """

    chi_squared: float
    log_determinant: float
    points_m: Floats
    errors: Floats


@njit(cache=True, error_model="numpy")
def triangulate(arrays: SharedArrays, optics: Optics, points_m: Floats) -> bool:
    """Move the points (K, 3) one Gauss-Newton step towards the least reprojection error; whether there is one."""
    n_points = points_m.shape[0]
    normal, vector = np.zeros((n_points, 3, 3)), np.zeros((n_points, 3))
    residual, by_point = np.empty(2), np.empty((2, 3))
    weights = (optics.sigma_u_px**-2.0, optics.sigma_v_px**-2.0)
    for line in range(arrays.u_px.shape[0]):
        point = arrays.line_point[line]
        u_px, position, w_b = arrays.u_px[line], arrays.position_m[line], arrays.world_from_body[line]
        if not project_line(optics, u_px, position, w_b, points_m[point], residual, by_point):
            return False
        for row in range(2):
            for i in range(3):
                weighted = weights[row] * by_point[row, i]
                vector[point, i] += weighted * residual[row]
                for j in range(i, 3):
                    normal[point, i, j] += weighted * by_point[row, j]
    for point in range(n_points):
        if np.isnan(factorise(normal[point])):
            return False
        solve_transposed(normal[point], vector[point])
        solve_upper(normal[point], vector[point])
        for i in range(3):
            points_m[point, i] += vector[point, i]
    return True


@njit(cache=True, error_model="numpy")
def normal_equations(
    arrays: SharedArrays, lines: Lines, n_points: int, view_weight: Floats, line_weight: Floats
) -> System:
    """Normal equations of the lines (L,), whose precisions and whose views' are scaled by the weights (L,), (N,)."""
    n_views = view_weight.shape[0]
    points, views = np.zeros((n_points, 3, 3)), np.zeros((n_views, 6, 6))
    cross, point_vector, view_vector = (
        np.zeros((6 * n_views, 3 * n_points)),
        np.zeros(3 * n_points),
        np.zeros(6 * n_views),
    )
    for view in range(n_views):
        for c in range(6):
            views[view, c, c] = view_weight[view]
    for line in range(arrays.u_px.shape[0]):
        view, point, weight = arrays.line_view[line], arrays.line_point[line], line_weight[line]
        a, w, r = lines.by_point[line], lines.by_shared[line], lines.residual_px[line]
        uu, uv, vv = (
            weight * lines.precision[line, 0],
            weight * lines.precision[line, 1],
            weight * lines.precision[line, 2],
        )
        for i in range(3):
            u, v = uu * a[0, i] + uv * a[1, i], uv * a[0, i] + vv * a[1, i]
            point_vector[3 * point + i] += u * r[0] + v * r[1]
            for j in range(i, 3):
                points[point, i, j] += u * a[0, j] + v * a[1, j]
            for c in range(6):
                cross[6 * view + c, 3 * point + i] += u * w[0, c] + v * w[1, c]
        for c in range(6):
            u, v = uu * w[0, c] + uv * w[1, c], uv * w[0, c] + vv * w[1, c]
            view_vector[6 * view + c] += u * r[0] + v * r[1]
            for d in range(c, 6):
                views[view, c, d] += u * w[0, d] + v * w[1, d]
    return System(points, views, cross, point_vector, view_vector)


@njit(cache=True, error_model="numpy")
def solve_system(system: System) -> tuple[float, float]:
    """Solve the normal equations in place, the larger group eliminated; log-determinant and decrease of chi squared."""
    n_points, n_views = system.points.shape[0], system.views.shape[0]
    if 3 * n_points <= 6 * n_views:
        kept = block_diagonal(system.points)
        return solve_blocks(system.views, system.cross, kept, system.view_vector, system.point_vector)
    kept = block_diagonal(system.views)
    return solve_blocks(system.points, system.cross.T.copy(), kept, system.point_vector, system.view_vector)


@njit(cache=True, error_model="numpy")
def block_diagonal(blocks: Floats) -> Floats:
    """The matrix (B b, B b) with the blocks (B, b, b) on its diagonal, upper triangle only."""
    count, size = blocks.shape[0], blocks.shape[1]
    matrix = np.zeros((count * size, count * size))
    for block in range(count):
        for i in range(size):
            for j in range(i, size):
                matrix[block * size + i, block * size + j] = blocks[block, i, j]
    return matrix


@njit(cache=True, error_model="numpy")
def initial_points(arrays: SharedArrays, optics: Optics, n_points: int) -> tuple[bool, Floats]:
    """Points (K, 3) of least reprojection error, to `TRIANGULATION_STEPS`; whether they are in front of the camera."""
    points_m = intersect_rays(arrays, optics, n_points)
    for _ in range(TRIANGULATION_STEPS):
        if not triangulate(arrays, optics, points_m):
            return False, points_m
    return True, points_m


@njit(cache=True, error_model="numpy")
def marginal(
    arrays: SharedArrays, optics: Optics, levels: Levels, n_points: int, view_weight: Floats, line_weight: Floats
) -> Marginal:
    """The marginal after `MARGINAL_STEPS` linearisations, each at the minimum that the one before found."""
    n_views = view_weight.shape[0]
    lines = empty_lines(arrays.u_px.shape[0])
    valid, points_m = initial_points(arrays, optics, n_points)
    errors = np.zeros((n_views, 6))
    chi_squared, log_determinant = np.inf, np.inf
    for _ in range(MARGINAL_STEPS):
        if not valid or not linearise(arrays, optics, levels, points_m, lines):
            return Marginal(np.inf, np.inf, points_m, errors)
        system = normal_equations(arrays, lines, n_points, view_weight, line_weight)
        log_determinant, decrease = solve_system(system)
        if np.isnan(log_determinant):
            return Marginal(np.inf, np.inf, points_m, errors)
        points_m += system.point_vector.reshape(n_points, 3)
        errors = system.view_vector.reshape(n_views, 6)
        chi_squared = squared_residuals(lines, line_weight) - decrease
        log_determinant += np.sum(lines.log_determinant)
    return Marginal(chi_squared, log_determinant, points_m, errors)


@njit(cache=True, error_model="numpy")
def squared_residuals(lines: Lines, line_weight: Floats) -> float:
    """Sum over lines of their weight (L,) times `r^T D^-1 r`."""
    total = 0.0
    for line in range(line_weight.shape[0]):
        u, v = lines.residual_px[line, 0], lines.residual_px[line, 1]
        uu, uv, vv = lines.precision[line, 0], lines.precision[line, 1], lines.precision[line, 2]
        total += line_weight[line] * (uu * u * u + 2.0 * uv * u * v + vv * v * v)
    return total

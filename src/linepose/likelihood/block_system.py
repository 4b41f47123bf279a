"""Solving the normal equations of two groups of unknowns that meet only each other: points and views.

The matrix is `[[E, C], [C^T, K]]`: E and K are block diagonal, C is dense. E is eliminated block by block, which
leaves a dense matrix of the size of K: K minus a low rank. Eliminating the group with more unknowns, nothing as large
as the observations is ever factorised. Of symmetric matrices only the upper triangle is read; factors are upper,
`A = U^T U`. Inner loops run along rows over independent entries: they vectorise without reordering any sum.
"""

import numpy as np
from numba import njit

from linepose.rotations import Floats


@njit(cache=True, error_model="numpy")
def factorise(matrix: Floats) -> float:
    """Overwrite the upper triangle (n, n) with its Cholesky factor U; the log-determinant, NaN if not positive."""
    n = matrix.shape[0]
    log_determinant = 0.0
    for j in range(n):
        pivot = matrix[j, j]
        if not (pivot > 0.0 and pivot < np.inf):
            return np.nan
        log_determinant += np.log(pivot)
        scale = 1.0 / np.sqrt(pivot)
        for k in range(j, n):
            matrix[j, k] *= scale
        for i in range(j + 1, n):
            factor = matrix[j, i]
            for k in range(i, n):
                matrix[i, k] -= factor * matrix[j, k]
    return log_determinant


@njit(cache=True, error_model="numpy")
def solve_transposed(factor: Floats, vector: Floats) -> None:
    """Overwrite `vector` (n,) with the solution of `U^T x = vector`."""
    n = vector.shape[0]
    for i in range(n):
        vector[i] /= factor[i, i]
        for k in range(i + 1, n):
            vector[k] -= factor[i, k] * vector[i]


@njit(cache=True, error_model="numpy")
def solve_upper(factor: Floats, vector: Floats) -> None:
    """Overwrite `vector` (n,) with the solution of `U x = vector`."""
    for i in range(vector.shape[0] - 1, -1, -1):
        total = vector[i]
        for k in range(i + 1, vector.shape[0]):
            total -= factor[i, k] * vector[k]
        vector[i] = total / factor[i, i]


@njit(cache=True, error_model="numpy")
def solve_transposed_rows(factor: Floats, rows: Floats) -> None:
    """Overwrite `rows` (n, m) with the solution of `U^T X = rows`."""
    n = rows.shape[0]
    for i in range(n):
        inverse = 1.0 / factor[i, i]
        for q in range(rows.shape[1]):
            rows[i, q] *= inverse
        for k in range(i + 1, n):
            scale = factor[i, k]
            for q in range(rows.shape[1]):
                rows[k, q] -= scale * rows[i, q]


@njit(cache=True, error_model="numpy")
def subtract_square(rows: Floats, matrix: Floats) -> None:
    """Subtract `rows^T rows` from the upper triangle of `matrix` (m, m); rows (n, m) with n a multiple of three."""
    m = matrix.shape[0]
    for r in range(0, rows.shape[0], 3):
        for p in range(m):
            a, b, c = rows[r, p], rows[r + 1, p], rows[r + 2, p]
            for q in range(p, m):
                matrix[p, q] -= a * rows[r, q] + b * rows[r + 1, q] + c * rows[r + 2, q]


@njit(cache=True, error_model="numpy")
def solve_blocks(
    eliminated: Floats, cross: Floats, kept: Floats, eliminated_vector: Floats, kept_vector: Floats
) -> tuple[float, float]:
    """Solve `[[E, C], [C^T, K]] x = g` in place; the log-determinant and `g^T x`, NaN if not positive definite.

    eliminated (B, b, b): blocks of E, overwritten with their factors, b a multiple of three; cross (B b, n): C,
    overwritten with `U_E^-T C`; kept (n, n): K, overwritten with the factor of what elimination leaves of it; vectors
    (B b,), (n,): g, overwritten with x.
    """
    n_blocks, size = eliminated.shape[0], eliminated.shape[1]
    log_determinant, square = 0.0, 0.0
    for block in range(n_blocks):
        first, last = block * size, (block + 1) * size
        log_determinant += factorise(eliminated[block])
        if np.isnan(log_determinant):
            return np.nan, np.nan
        rows, vector = cross[first:last], eliminated_vector[first:last]
        solve_transposed_rows(eliminated[block], rows)
        solve_transposed(eliminated[block], vector)
        subtract_square(rows, kept)
        for r in range(size):
            square += vector[r] ** 2
            for q in range(kept.shape[0]):
                kept_vector[q] -= rows[r, q] * vector[r]
    log_determinant += factorise(kept)
    if np.isnan(log_determinant):
        return np.nan, np.nan
    solve_transposed(kept, kept_vector)
    for q in range(kept.shape[0]):
        square += kept_vector[q] ** 2
    solve_upper(kept, kept_vector)
    for block in range(n_blocks):
        first = block * size
        for r in range(size):
            total = 0.0
            for q in range(kept.shape[0]):
                total += cross[first + r, q] * kept_vector[q]
            eliminated_vector[first + r] -= total
        solve_upper(eliminated[block], eliminated_vector[first : first + size])
    return log_determinant, square

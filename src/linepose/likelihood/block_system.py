"""Solving the normal equations of two groups of unknowns that meet only each other: points and views.

The matrix is `[[E, C], [C^T, K]]`: E and K are block diagonal, C is dense. E is eliminated block by block, which
leaves a dense matrix of the size of K: K minus a low rank. Eliminating the group with more unknowns, nothing as large
as the observations is ever factorised. Of symmetric matrices only the upper triangle is read; factors are upper,
`A = U^T U`. Inner loops run along slices of rows over independent entries, so they vectorise without reordering a sum.
"""

import numpy as np
from numba import njit

from linepose.arrays import Floats


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
        pivot_row = matrix[j, j:]
        for k in range(pivot_row.shape[0]):
            pivot_row[k] *= scale
        for i in range(1, n - j):
            factor, source, target = pivot_row[i], pivot_row[i:], matrix[j + i, j + i :]
            for k in range(target.shape[0]):
                target[k] -= factor * source[k]
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
        inverse, solved = 1.0 / factor[i, i], rows[i]
        for q in range(solved.shape[0]):
            solved[q] *= inverse
        for k in range(i + 1, n):
            scale, target = factor[i, k], rows[k]
            for q in range(target.shape[0]):
                target[q] -= scale * solved[q]


@njit(cache=True, error_model="numpy")
def subtract_square(rows: Floats, matrix: Floats) -> None:
    """Subtract `rows^T rows` from the upper triangle of `matrix` (m, m); rows (n, m) with n a multiple of three."""
    m = matrix.shape[0]
    for r in range(0, rows.shape[0], 3):
        for p in range(m):
            first, second, third, target = rows[r, p:], rows[r + 1, p:], rows[r + 2, p:], matrix[p, p:]
            a, b, c = first[0], second[0], third[0]
            for q in range(target.shape[0]):
                target[q] -= a * first[q] + b * second[q] + c * third[q]


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


@njit(cache=True, error_model="numpy")
def inverse_of_factored(factor: Floats) -> Floats:
    """The inverse (n, n), both triangles, of the matrix whose upper factor is given."""
    n = factor.shape[0]
    rows = np.eye(n)
    for i in range(n):
        inverse, solved = 1.0 / factor[i, i], rows[i, : i + 1]
        for q in range(solved.shape[0]):
            solved[q] *= inverse
        for k in range(i + 1, n):
            scale, target = factor[i, k], rows[k, : i + 1]
            for q in range(target.shape[0]):
                target[q] -= scale * solved[q]
    matrix = np.zeros((n, n))
    for r in range(n):
        for p in range(r + 1):
            scale, source, target = rows[r, p], rows[r, : r + 1], matrix[p, : r + 1]
            for q in range(target.shape[0]):
                target[q] += scale * source[q]
    return matrix


@njit(cache=True, error_model="numpy")
def covariance_blocks(eliminated: Floats, cross: Floats, kept: Floats) -> tuple[Floats, Floats, Floats]:
    """Blocks of the inverse from what `solve_blocks` leaves: of E (B, b, b), of C (B b, n), and of K whole (n, n)."""
    n_blocks, size, n = eliminated.shape[0], eliminated.shape[1], kept.shape[0]
    of_kept = inverse_of_factored(kept)
    of_cross = np.zeros(cross.shape)
    of_eliminated = np.empty(eliminated.shape)
    for block in range(n_blocks):
        first, last = block * size, (block + 1) * size
        factor, rows, covariance = eliminated[block], cross[first:last], of_cross[first:last]
        gain = rows.copy()
        for i in range(size - 1, -1, -1):
            solved = gain[i]
            for k in range(i + 1, size):
                scale, source = factor[i, k], gain[k]
                for q in range(n):
                    solved[q] -= scale * source[q]
            for q in range(n):
                solved[q] /= factor[i, i]
        for i in range(size):
            target = covariance[i]
            for p in range(n):
                scale, source = gain[i, p], of_kept[p]
                for q in range(n):
                    target[q] -= scale * source[q]
        inverse = inverse_of_factored(factor)
        for i in range(size):
            for j in range(size):
                total = inverse[i, j]
                for q in range(n):
                    total -= covariance[i, q] * gain[j, q]
                of_eliminated[block, i, j] = total
    return of_eliminated, of_cross, of_kept

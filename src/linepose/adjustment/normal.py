"""Normal equations of the whitened linear model: points, intrinsics, clock offset and pose in one triangular factor.

Columns are ordered: points (3 K), principal point, focal length, what is sought of the lens (C), common shift, clock
offset, pose (6), and the residual last; those from the principal point to the pose are the camera's (10 + C). The
Cholesky factor of their products holds all that the adjustment asks for: the residual's last pivot is the least chi
squared, the other pivots are the determinant, and the trailing blocks are marginal: of the pose, of pose and clock
offset, and of all that is not a point. Without an estimate of shift or clock offset the column is zero and its prior
one.
"""

from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_triangular

from linepose.adjustment.linearise import Linearised
from linepose.adjustment.process import Components
from linepose.adjustment.whitening import Factor, factorise, whiten
from linepose.arrays import Floats
from linepose.compiling.kernels import kernel

N_POSE: Final = 6
CLOCK_OFFSET: Final = -N_POSE - 1  # its column among those of the camera, counted from their end
COMMON_SHIFT: Final = CLOCK_OFFSET - 1
_WIDTH: Final = 4  # columns are padded to a multiple of it


class Prior(NamedTuple):
    """What is known beside the measurements, as quadratic forms about the present estimate.

    camera (10 + C, 10 + C), camera_vector (10 + C,): information of the camera's columns, and its product with what the
    step ought to be; points (K, 3, 3), points_vector (K, 3): the same of points; board (3 K, 3 K): information that
    ties points of a board together, (0, 0) without one; chi_squared: with no step.
    """

    camera: Floats
    camera_vector: Floats
    points: Floats
    points_vector: Floats
    board: Floats
    chi_squared: float


class Pass(NamedTuple):
    """What one pass finds.

    factor: the filter's; whitened (2 L, n): all columns; upper (n, n): the normal equations' factor, rows and columns
    as the module says; chi_squared: at the minimum; chi_squared_before: with no step; log_determinant: of C and of the
    normal equations together.
    """

    factor: Factor
    whitened: Floats
    upper: Floats
    chi_squared: float
    chi_squared_before: float
    log_determinant: float


@kernel
def design(linearised: Linearised, correction: Floats, point_of: np.ndarray, n_points: int) -> Floats:
    """Columns (2 L, n) of the linear model before whitening, the residual `y - h + J c0` last but for padding."""
    first, n_camera = 3 * n_points, linearised.by_theta.shape[2]
    n_shared = n_camera - N_POSE
    used = first + n_camera + 1
    n = linearised.residual_px.shape[0]
    rows = np.zeros((2 * n, (used + _WIDTH - 1) // _WIDTH * _WIDTH))
    for line in range(n):
        for row in range(2):
            out, theta = rows[2 * line + row], linearised.by_theta[line, row]
            start = 3 * point_of[line]
            for i in range(3):
                out[start + i] = linearised.by_point[line, row, i]
            for i in range(n_shared):
                out[first + i] = theta[N_POSE + i]
            residual = linearised.residual_px[line, row]
            for i in range(6):
                out[first + n_shared + i] = theta[i]
                residual += linearised.by_body[line, row, i] * correction[line, i]
            out[first + n_camera] = residual
    return rows


@kernel
def products(rows: Floats, n: int) -> Floats:
    """Products (n, n) of the first n columns (m, >= n), upper triangle."""
    out = np.zeros((n, n))
    whole = rows.shape[0] - rows.shape[0] % 8
    for r in range(0, whole, 8):  # a target that is read and written once for eight rows
        r0, r1, r2, r3 = rows[r], rows[r + 1], rows[r + 2], rows[r + 3]
        r4, r5, r6, r7 = rows[r + 4], rows[r + 5], rows[r + 6], rows[r + 7]
        for i in range(n):
            a0, a1, a2, a3, target = r0[i], r1[i], r2[i], r3[i], out[i]
            a4, a5, a6, a7 = r4[i], r5[i], r6[i], r7[i]
            for j in range(i, n):
                first = a0 * r0[j] + a1 * r1[j] + a2 * r2[j] + a3 * r3[j]
                target[j] += first + (a4 * r4[j] + a5 * r5[j] + a6 * r6[j] + a7 * r7[j])
    for r in range(whole, rows.shape[0]):
        for i in range(n):
            for j in range(i, n):
                out[i, j] += rows[r, i] * rows[r, j]
    return out


@kernel
def cholesky_upper(matrix: Floats) -> None:
    """Replace the upper triangle of a matrix (n, n) by U with `U^T U` it; NaN from where it is not positive definite.

    The last pivot may be zero: a residual that the columns explain.
    """
    n = matrix.shape[0]
    for i in range(n):
        row = matrix[i]
        k = 0
        while k + 4 <= i:
            m0, m1, m2, m3 = matrix[k], matrix[k + 1], matrix[k + 2], matrix[k + 3]
            a0, a1, a2, a3 = m0[i], m1[i], m2[i], m3[i]
            for j in range(i, n):
                row[j] -= a0 * m0[j] + a1 * m1[j] + a2 * m2[j] + a3 * m3[j]
            k += 4
        while k < i:
            m0, a0 = matrix[k], matrix[k, i]
            for j in range(i, n):
                row[j] -= a0 * m0[j]
            k += 1
        pivot = row[i]
        if i == n - 1:
            pivot = max(pivot, 0.0) if pivot == pivot else pivot
        elif not pivot > 0.0:
            pivot = np.nan
        root = np.sqrt(pivot)
        row[i] = root
        for j in range(i + 1, n):
            row[j] /= root


@kernel
def one_pass(rows: Floats, process: Components, view: np.ndarray, begins: np.ndarray, prior: Prior) -> Pass:
    """Whiten the columns (2 L, n) and factor the normal equations with the prior added; NaN where they are singular."""
    n_points = prior.points.shape[0]
    first, n_camera = 3 * n_points, prior.camera.shape[0]
    n = first + n_camera + 1
    factor = factorise(process, view, begins)
    whitened = rows.copy()
    whiten(factor, whitened)
    upper = products(whitened, n)
    for point in range(n_points):
        for i in range(3):
            upper[3 * point + i, n - 1] += prior.points_vector[point, i]
            for j in range(i, 3):
                upper[3 * point + i, 3 * point + j] += prior.points[point, i, j]
    for i in range(prior.board.shape[0]):
        for j in range(i, prior.board.shape[0]):
            upper[i, j] += prior.board[i, j]
    for i in range(n_camera):
        upper[first + i, n - 1] += prior.camera_vector[i]
        for j in range(i, n_camera):
            upper[first + i, first + j] += prior.camera[i, j]
    upper[n - 1, n - 1] += prior.chi_squared
    before = upper[n - 1, n - 1]
    cholesky_upper(upper)
    log_determinant = factor.log_determinant
    for i in range(n - 1):
        log_determinant += 2.0 * np.log(upper[i, i])
    return Pass(factor, whitened, upper, upper[n - 1, n - 1] ** 2, before, log_determinant)


@kernel
def solve_step(upper: Floats, first_free: int, damping: float) -> Floats:
    """The step (n - 1,) of all columns that the factor (n, n) of a pass means; the camera's damped.

    Columns before `first_free` are points; the camera's reduced normal equations have `1 + damping` times their
    diagonal.
    """
    n = upper.shape[0] - 1
    step = np.zeros(n)
    size = n - first_free
    reduced, vector = np.zeros((size, size)), np.zeros(size)
    for i in range(size):
        for k in range(i + 1):
            vector[i] += upper[first_free + k, first_free + i] * upper[first_free + k, n]
            for j in range(i, size):
                reduced[i, j] += upper[first_free + k, first_free + i] * upper[first_free + k, first_free + j]
    for i in range(size):
        reduced[i, i] *= 1.0 + damping
        for j in range(i):
            reduced[i, j] = reduced[j, i]
    scale = np.sqrt(np.diag(reduced).copy())
    for i in range(size):
        for j in range(size):
            reduced[i, j] /= scale[i] * scale[j]
    step[first_free:] = np.linalg.solve(reduced, vector / scale) / scale
    for i in range(first_free - 1, -1, -1):
        total = upper[i, n]
        for j in range(i + 1, n):
            total -= upper[i, j] * step[j]
        step[i] = total / upper[i, i]
    return step


@kernel
def trailing_inverse(upper: Floats, size: int) -> Floats:
    """Covariance (size, size) of the last parameters before the residual column of a factor (n, n)."""
    n = upper.shape[0] - 1
    inverse = np.zeros((size, size))
    first = n - size
    for column in range(size):
        for i in range(column, -1, -1):
            total = 1.0 if i == column else 0.0
            for j in range(i + 1, column + 1):
                total -= upper[first + i, first + j] * inverse[j, column]
            inverse[i, column] = total / upper[first + i, first + i]
    return inverse @ inverse.T


def point_covariances(upper: Floats, shifts: Floats) -> Floats:
    """Covariances (K, 3, 3) of the points, which come first in a factor (n, n) with its residual column.

    shifts (K,): which of them follow the common shift downwards.
    """
    rows = _point_rows(upper, shifts)
    return np.asarray(rows @ np.swapaxes(rows, 1, 2))


def joint_covariance(upper: Floats, shifts: Floats, which: NDArray[np.bool_]) -> Floats:
    """Covariance (3 n, 3 n) of n of the points (K,) together."""
    rows = _point_rows(upper, shifts)[which].reshape(3 * int(which.sum()), -1)
    return np.asarray(rows @ rows.T)


def _point_rows(upper: Floats, shifts: Floats) -> Floats:
    """Root (K, 3, n) of the points' covariance, by a factor (n, n) with its residual column."""
    n, n_points = upper.shape[0] - 1, len(shifts)
    inverse = solve_triangular(np.triu(upper[:n, :n]), np.eye(n))
    rows = inverse[: 3 * n_points].reshape(n_points, 3, n).copy()
    rows[:, 2] += shifts[:, None] * inverse[COMMON_SHIFT]
    return np.asarray(rows)


@kernel
def whitened_residual(done: Pass, step: Floats) -> Floats:
    """Whitened residuals (L, 2) after a step (n - 1,) of the columns."""
    n = step.shape[0]
    out = np.empty((done.whitened.shape[0] // 2, 2))
    for row in range(done.whitened.shape[0]):
        total = done.whitened[row, n]
        for j in range(n):
            total -= done.whitened[row, j] * step[j]
        out[row // 2, row % 2] = total
    return out

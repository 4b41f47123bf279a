"""Many points: the normal equations without their matrix, in memory and time that follow the measurements.

`N x = A^T C^-1 A x + prior` takes one filter pass forwards and one backwards, whatever the number of points. Conjugate
gradients solve it, preconditioned twice: by the normal equations of innovations taken for independent, in which points
are 3 x 3 blocks and eliminated at once; and by N itself on smooth displacements of all points, which an error of the
navigation that lasts looks like and which independent innovations hold for far better known than they are. Columns x
are points (3 K), then those of the camera, as in `normal`.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np

from linepose.adjustment.linearise import Linearised
from linepose.adjustment.normal import N_POSE, Prior
from linepose.adjustment.whitening import Factor, unwhiten, whiten_residual
from linepose.arrays import Floats
from linepose.compiling.kernels import kernel
from linepose.errors import EstimationError

_MOST_ITERATIONS: Final = 2000
_DEGREE: Final = 6  # of the smooth displacements
_LEAST_EIGENVALUE: Final = 1e-12  # of their normal equations with unit diagonal, below which one depends on others


@dataclass(frozen=True)
class Equations:
    """Normal equations of L measurements of K points, as what they do to a column.

    by_point (L, 2, 3) and camera (L, 2, 10 + C): derivatives by point, and by the camera's columns; point (L,); factor:
    of the error process.
    """

    by_point: Floats
    camera: Floats
    point: np.ndarray
    factor: Factor
    prior: Prior

    @property
    def n_points(self) -> int:
        """Number of points K."""
        return len(self.prior.points)

    def times_design(self, column: Floats) -> Floats:
        """A times a column (3 K + 10 + C,), rows u and v of each measurement; (L, 2)."""
        return _times_design(self.by_point, self.camera, self.point, column)

    def transposed_information(self, residual: Floats) -> Floats:
        """`A^T C^-1` times residuals (L, 2); (3 K + 10 + C,)."""
        weighted = unwhiten(self.factor, whiten_residual(self.factor, residual))
        return _times_transposed(self.by_point, self.camera, self.point, self.n_points, weighted)

    def times_normal(self, column: Floats) -> Floats:
        """N times a column (3 K + 10 + C,)."""
        n = 3 * self.n_points
        points = np.einsum("kij,kj->ki", self.prior.points, column[:n].reshape(-1, 3)).ravel()
        prior = np.concatenate([points, self.prior.camera @ column[n:]])
        return self.transposed_information(self.times_design(column)) + prior

    def right_side(self, residual: Floats) -> Floats:
        """`A^T C^-1 e + prior` of residuals (L, 2); (3 K + 10 + C,)."""
        prior = np.concatenate([self.prior.points_vector.ravel(), self.prior.camera_vector])
        return self.transposed_information(residual) + prior


def equations(linearised: Linearised, point: np.ndarray, factor: Factor, prior: Prior) -> Equations:
    """The normal equations of a linear model and the factor of its error process."""
    camera = np.ascontiguousarray(
        np.concatenate([linearised.by_theta[..., N_POSE:], linearised.by_theta[..., :N_POSE]], axis=2)
    )
    return Equations(linearised.by_point, camera, point, factor, prior)


@dataclass(frozen=True)
class Blocks:
    """Normal equations with independent measurements, factored.

    points (K, 3, 3): inverted; coupling (3 K, 10 + C): of points and camera; camera (10 + C, 10 + C): its reduced
    matrix, inverted.
    """

    points: Floats
    coupling: Floats
    camera: Floats

    def solve(self, column: Floats) -> Floats:
        """The inverse times a column (3 K + 10 + C,)."""
        n = len(self.coupling)
        first = self._points(column[:n])
        camera = self.camera @ (column[n:] - first @ self.coupling)
        return np.concatenate([first - self._points(self.coupling @ camera), camera])

    def _points(self, column: Floats) -> Floats:
        return np.matmul(self.points, column.reshape(-1, 3, 1)).ravel()


@dataclass(frozen=True)
class Smooth:
    """S smooth columns (3 K + 10 + C, S) and the inverse (S, S) of their normal equations."""

    columns: Floats
    inverse: Floats

    def solve(self, column: Floats) -> Floats:
        """The inverse, of what the smooth columns span, times a column (3 K + 10 + C,)."""
        return self.columns @ (self.inverse @ (column @ self.columns))


@dataclass(frozen=True)
class Preconditioner:
    """The sum of both parts; symmetric and positive definite whatever either was built at."""

    blocks: Blocks
    smooth: Smooth

    def solve(self, column: Floats) -> Floats:
        """An approximation of the inverse of the normal equations times a column (3 K + 10 + C,)."""
        return self.blocks.solve(column) + self.smooth.solve(column)


def blocks(system: Equations) -> Blocks:
    """The part of independent measurements; raises EstimationError for a point seen from one direction only."""
    points, coupling, camera = _block_products(
        system.by_point, system.camera, system.point, system.factor.root, system.n_points
    )
    points += system.prior.points
    camera += system.prior.camera
    n_camera = len(camera)
    coupling = coupling.reshape(-1, n_camera)
    try:
        inverse = np.linalg.inv(points)
        reduced = camera - coupling.T @ np.matmul(inverse, coupling.reshape(-1, 3, n_camera)).reshape(-1, n_camera)
        return Blocks(inverse, coupling, np.linalg.inv(reduced))
    except np.linalg.LinAlgError:
        raise EstimationError(
            "adjustment: singular normal equations; drop points that are seen from one direction only"
        ) from None


def smooth(system: Equations, points_m: Floats) -> Smooth:
    """The part of smooth displacements of points (K, 3) and of the camera.

    Displacements are polynomials of the position along the two axes on which the points spread most.
    """
    columns = smooth_columns(points_m, len(system.prior.camera))
    product = np.array([system.times_normal(column) for column in columns.T]) @ columns
    scale = np.sqrt(np.diag(product))
    values, vectors = np.linalg.eigh((product + product.T) / 2 / np.outer(scale, scale))
    inverse = np.where(values > _LEAST_EIGENVALUE * values[-1], 1 / np.maximum(values, 1e-300), 0.0)
    return Smooth(columns, (vectors * inverse) @ vectors.T / np.outer(scale, scale))


def smooth_columns(points_m: Floats, n_camera: int) -> Floats:
    """Columns (3 K + 10 + C, S): polynomial displacements of points (K, 3), and each of the camera's
    columns alone.
    """
    off = points_m - points_m.mean(axis=0)
    along = off @ np.linalg.svd(off, full_matrices=False)[2][:2].T
    scaled = along / np.maximum(np.abs(along).max(axis=0), 1e-300)
    first, second = (np.polynomial.chebyshev.chebvander(one, _DEGREE) for one in scaled.T)
    terms = [first[:, i] * second[:, j] for i in range(_DEGREE + 1) for j in range(_DEGREE + 1 - i)]
    columns = np.zeros((points_m.size + n_camera, 3 * len(terms) + n_camera))
    for k, term in enumerate(terms):
        for axis in range(3):
            columns[axis : points_m.size : 3, 3 * k + axis] = term
    columns[-n_camera:, -n_camera:] = np.eye(n_camera)
    return columns


def conjugate_gradients(
    system: Equations, inverse: Preconditioner, right: Floats, tolerance: float
) -> tuple[Floats, int]:
    """N^-1 times a column (3 K + 10 + C,), and the number of iterations.

    It ends when the preconditioned residual is `tolerance` of the right side's. Raises EstimationError where that takes
    too long.
    """
    x, residual = np.zeros_like(right), right.copy()
    direction = scaled = inverse.solve(residual)
    rho = float(residual @ scaled)
    target = tolerance**2 * rho
    for iteration in range(_MOST_ITERATIONS):
        if rho <= target:
            return x, iteration
        product = system.times_normal(direction)
        step = rho / float(direction @ product)
        x = x + step * direction
        residual = residual - step * product
        scaled = inverse.solve(residual)
        before, rho = rho, float(residual @ scaled)
        direction = scaled + rho / before * direction
    raise EstimationError("adjustment: the normal equations of many points do not converge; add observations")


@kernel
def _times_design(by_point: Floats, camera: Floats, point: np.ndarray, column: Floats) -> Floats:
    n, n_camera = by_point.shape[0], camera.shape[2]
    first = column.shape[0] - n_camera
    out = np.empty((n, 2))
    for line in range(n):
        start = 3 * point[line]
        for row in range(2):
            total = 0.0
            for i in range(3):
                total += by_point[line, row, i] * column[start + i]
            for i in range(n_camera):
                total += camera[line, row, i] * column[first + i]
            out[line, row] = total
    return out


@kernel
def _times_transposed(by_point: Floats, camera: Floats, point: np.ndarray, n_points: int, rows: Floats) -> Floats:
    n, first, n_camera = by_point.shape[0], 3 * n_points, camera.shape[2]
    out = np.zeros(first + n_camera)
    for line in range(n):
        start, u, v = 3 * point[line], rows[line, 0], rows[line, 1]
        for i in range(3):
            out[start + i] += by_point[line, 0, i] * u + by_point[line, 1, i] * v
        for i in range(n_camera):
            out[first + i] += camera[line, 0, i] * u + camera[line, 1, i] * v
    return out


@kernel
def _block_products(
    by_point: Floats, camera: Floats, point: np.ndarray, root: Floats, n_points: int
) -> tuple[Floats, Floats, Floats]:
    """Products of the columns, each measurement whitened by its own innovation's root (L, 3)."""
    n, n_camera = by_point.shape[0], camera.shape[2]
    points, coupling = np.zeros((n_points, 3, 3)), np.zeros((n_points, 3, n_camera))
    of_camera = np.zeros((n_camera, n_camera))
    p, c = np.empty((2, 3)), np.empty((2, n_camera))
    for line in range(n):
        i00, l10, i11 = root[line, 0], root[line, 1], root[line, 2]
        for i in range(3):
            p[0, i] = by_point[line, 0, i] * i00
            p[1, i] = (by_point[line, 1, i] - l10 * p[0, i]) * i11
        for i in range(n_camera):
            c[0, i] = camera[line, 0, i] * i00
            c[1, i] = (camera[line, 1, i] - l10 * c[0, i]) * i11
        k = point[line]
        for i in range(3):
            for j in range(3):
                points[k, i, j] += p[0, i] * p[0, j] + p[1, i] * p[1, j]
            for j in range(n_camera):
                coupling[k, i, j] += p[0, i] * c[0, j] + p[1, i] * c[1, j]
        for i in range(n_camera):
            for j in range(n_camera):
                of_camera[i, j] += c[0, i] * c[0, j] + c[1, i] * c[1, j]
    return points, coupling, of_camera

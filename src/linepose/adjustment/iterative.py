"""Many points: the normal equations without their matrix, in memory and time that follow the measurements.

`N x = A^T C^-1 A x + prior` takes one filter pass forwards and one backwards, whatever the number of points. Conjugate
gradients solve it, preconditioned by the normal equations of innovations taken for independent, in which points are
3 x 3 blocks and eliminated at once. Columns x are points (3 K), then those of the camera, as in `normal`.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np

from linepose.adjustment.compiling import kernel
from linepose.adjustment.linearise import Linearised
from linepose.adjustment.normal import N_CAMERA, N_POSE, Prior
from linepose.adjustment.whitening import Factor, unwhiten_columns, whiten
from linepose.arrays import Floats
from linepose.errors import EstimationError

_MOST_ITERATIONS: Final = 2000


@dataclass(frozen=True)
class Equations:
    """Normal equations of L measurements of K points, as what they do to a column.

    by_point (L, 2, 3) and camera (L, 2, 9): derivatives by point, and by principal point, focal length, clock offset
    and pose; point (L,); factor: of the error process.
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

    def times_design(self, columns: Floats) -> Floats:
        """A times columns (3 K + 9, m), rows u and v of each measurement; (2 L, m)."""
        return _times_design(self.by_point, self.camera, self.point, columns)

    def times_design_transposed(self, rows: Floats) -> Floats:
        """A^T times rows (2 L, m); (3 K + 9, m)."""
        return _times_transposed(self.by_point, self.camera, self.point, self.n_points, rows)

    def information_of_rows(self, rows: Floats) -> Floats:
        """C^-1 times rows (2 L, m), which are overwritten."""
        whiten(self.factor, rows)
        return unwhiten_columns(self.factor, rows)

    def times_prior(self, columns: Floats) -> Floats:
        """The prior's information times columns (3 K + 9, m)."""
        points = columns[:-N_CAMERA].reshape(self.n_points, 3, -1)
        return np.concatenate(
            [
                np.einsum("kij,kjm->kim", self.prior.points, points).reshape(3 * self.n_points, -1),
                self.prior.camera @ columns[-N_CAMERA:],
            ]
        )

    def times_normal(self, columns: Floats) -> Floats:
        """N times columns (3 K + 9, m)."""
        weighted = self.information_of_rows(self.times_design(columns))
        return self.times_design_transposed(weighted) + self.times_prior(columns)

    def right_side(self, residual: Floats) -> Floats:
        """`A^T C^-1 e + prior` of residuals (2 L,); (3 K + 9, 1)."""
        weighted = self.information_of_rows(residual[:, None].copy())
        prior = np.concatenate([self.prior.points_vector.ravel(), self.prior.camera_vector])
        return self.times_design_transposed(weighted) + prior[:, None]


def equations(linearised: Linearised, point: np.ndarray, factor: Factor, prior: Prior) -> Equations:
    """The normal equations of a linear model and the factor of its error process."""
    camera = np.ascontiguousarray(
        np.concatenate([linearised.by_theta[..., N_POSE:], linearised.by_theta[..., :N_POSE]], axis=2)
    )
    return Equations(linearised.by_point, camera, point, factor, prior)


@dataclass(frozen=True)
class Blocks:
    """Normal equations with independent measurements, factored.

    points (K, 3, 3): inverted; coupling (K, 3, 9): of points and camera; camera (9, 9): its reduced matrix, inverted.
    """

    points: Floats
    coupling: Floats
    camera: Floats

    def solve(self, columns: Floats) -> Floats:
        """The inverse times columns (3 K + 9, m)."""
        points = columns[:-N_CAMERA].reshape(len(self.points), 3, -1)
        first = np.einsum("kij,kjm->kim", self.points, points)
        camera = self.camera @ (columns[-N_CAMERA:] - np.einsum("kic,kim->cm", self.coupling, first))
        moved = np.einsum("kij,kjm->kim", self.points, np.einsum("kic,cm->kim", self.coupling, camera))
        return np.concatenate([(first - moved).reshape(columns.shape[0] - N_CAMERA, -1), camera])


def blocks(system: Equations) -> Blocks:
    """The preconditioner; raises EstimationError for a point that is seen from one direction only."""
    points, coupling, camera = _block_products(
        system.by_point, system.camera, system.point, system.factor.root, system.n_points
    )
    points += system.prior.points
    camera += system.prior.camera
    try:
        inverse = np.linalg.inv(points)
        reduced = camera - np.einsum("kic,kij,kjd->cd", coupling, inverse, coupling)
        return Blocks(inverse, coupling, np.linalg.inv(reduced))
    except np.linalg.LinAlgError:
        raise EstimationError(
            "adjustment: singular normal equations; drop points that are seen from one direction only"
        ) from None


def conjugate_gradients(system: Equations, inverse: Blocks, right: Floats, tolerance: float) -> tuple[Floats, int]:
    """N^-1 times columns (3 K + 9, m), and the number of iterations.

    It ends when the preconditioned residual of every column is `tolerance` of the right side's. Raises EstimationError
    where that takes too long.
    """
    x, residual = np.zeros_like(right), right.copy()
    direction = scaled = inverse.solve(residual)
    rho = np.einsum("ij,ij->j", residual, scaled)
    target = tolerance**2 * np.maximum(rho, 1e-300)
    for iteration in range(_MOST_ITERATIONS):
        if np.all(rho <= target):
            return x, iteration
        product = system.times_normal(direction)
        step = rho / np.maximum(np.einsum("ij,ij->j", direction, product), 1e-300)
        x = x + step * direction
        residual = residual - step * product
        scaled = inverse.solve(residual)
        before, rho = rho, np.einsum("ij,ij->j", residual, scaled)
        direction = scaled + rho / np.maximum(before, 1e-300) * direction
    raise EstimationError("adjustment: the normal equations of many points do not converge; add observations")


@kernel
def _times_design(by_point: Floats, camera: Floats, point: np.ndarray, columns: Floats) -> Floats:
    n, m, first = by_point.shape[0], columns.shape[1], columns.shape[0] - N_CAMERA
    out = np.zeros((2 * n, m))
    for line in range(n):
        start = 3 * point[line]
        for row in range(2):
            target = out[2 * line + row]
            for i in range(3):
                value, source = by_point[line, row, i], columns[start + i]
                for j in range(m):
                    target[j] += value * source[j]
            for i in range(N_CAMERA):
                value, source = camera[line, row, i], columns[first + i]
                for j in range(m):
                    target[j] += value * source[j]
    return out


@kernel
def _times_transposed(by_point: Floats, camera: Floats, point: np.ndarray, n_points: int, rows: Floats) -> Floats:
    n, m, first = by_point.shape[0], rows.shape[1], 3 * n_points
    out = np.zeros((first + N_CAMERA, m))
    for line in range(n):
        start = 3 * point[line]
        for row in range(2):
            source = rows[2 * line + row]
            for i in range(3):
                value, target = by_point[line, row, i], out[start + i]
                for j in range(m):
                    target[j] += value * source[j]
            for i in range(N_CAMERA):
                value, target = camera[line, row, i], out[first + i]
                for j in range(m):
                    target[j] += value * source[j]
    return out


@kernel
def _block_products(
    by_point: Floats, camera: Floats, point: np.ndarray, root: Floats, n_points: int
) -> tuple[Floats, Floats, Floats]:
    """Products of the columns, each measurement whitened by its own innovation's root (L, 3)."""
    n = by_point.shape[0]
    points, coupling = np.zeros((n_points, 3, 3)), np.zeros((n_points, 3, N_CAMERA))
    of_camera = np.zeros((N_CAMERA, N_CAMERA))
    p, c = np.empty((2, 3)), np.empty((2, N_CAMERA))
    for line in range(n):
        i00, l10, i11 = root[line, 0], root[line, 1], root[line, 2]
        for i in range(3):
            p[0, i] = by_point[line, 0, i] * i00
            p[1, i] = (by_point[line, 1, i] - l10 * p[0, i]) * i11
        for i in range(N_CAMERA):
            c[0, i] = camera[line, 0, i] * i00
            c[1, i] = (camera[line, 1, i] - l10 * c[0, i]) * i11
        k = point[line]
        for i in range(3):
            for j in range(3):
                points[k, i, j] += p[0, i] * p[0, j] + p[1, i] * p[1, j]
            for j in range(N_CAMERA):
                coupling[k, i, j] += p[0, i] * c[0, j] + p[1, i] * c[1, j]
        for i in range(N_CAMERA):
            for j in range(N_CAMERA):
                of_camera[i, j] += c[0, i] * c[0, j] + c[1, i] * c[1, j]
    return points, coupling, of_camera

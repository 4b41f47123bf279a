"""Known points that contradict the rest: their weights, and how many sigmas they are off.

What is known of a point that is marked or read wrongly is metres off where centimetres are stated. Its weight is that
of a Student-t distribution, w = (4 + r) / (4 + d), d the square of how far it is off what all else says of that point,
of r dimensions. All else includes the other known points, so that weights are found in turns: first at the minimum of
chi squared where none of them counts.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np

from linepose.adjustment.known_points import KnownPoints
from linepose.arrays import Floats

DEGREES_OF_FREEDOM: Final = 4.0
CONTRADICTION_SIGMAS: Final = 4.0  # from which on a known point is weighted at all
UNCOUNTED: Final = 1e-8  # weight of a known point that does not count, which yet leaves a single ray an end
_LEAST: Final = 1e-9  # eigenvalue of an information, in units of its largest


@dataclass(frozen=True)
class KnownPointsFit:
    """Of M points: weight (M,), one unless it contradicts the rest; sigmas (M,), how far it is off what all else says.

    Both are NaN for a point of which nothing of its own is known, or that no line saw.
    """

    weight: Floats
    sigmas: Floats

    @property
    def contradicting(self) -> np.ndarray:
        """Rows of the points that contradict the rest, the worst first."""
        rows = np.flatnonzero(self.weight < 1)
        return rows[np.argsort(-self.sigmas[rows], kind="stable")]

    @property
    def counted(self) -> Floats:
        """The weights (M,) as what is known of the points takes them."""
        return np.where(np.isnan(self.weight), 1.0, self.weight)


def fit_of_known(known: KnownPoints, weight: Floats, points_m: Floats, covariance: Floats) -> KnownPointsFit:
    """How known points fit points (M, 3), covariances (M, 3, 3), that were adjusted with known points weighted (M,)."""
    weights, sigmas = np.full(len(weight), np.nan), np.full(len(weight), np.nan)
    for row in np.flatnonzero(known.apart & np.isfinite(points_m[:, 0])):
        values, vectors = np.linalg.eigh(known.information[row])
        axes = vectors[:, values > _LEAST * values[-1]]
        information = axes.T @ known.information[row] @ axes
        posterior = np.linalg.inv(axes.T @ covariance[row] @ axes)
        # what all else says is the posterior without what is known of the point, by as much as that counted
        rest = _at_least(posterior - weight[row] * information, _LEAST * values[-1])
        score = posterior @ axes.T @ (known.position_m[row] - points_m[row])
        square = float(score @ np.linalg.solve(rest @ np.linalg.solve(information, rest) + rest, score))
        dimension = axes.shape[1]
        sigmas[row] = np.sqrt(square / dimension)
        robust = (DEGREES_OF_FREEDOM + dimension) / (DEGREES_OF_FREEDOM + square)
        weights[row] = robust if sigmas[row] > CONTRADICTION_SIGMAS else 1.0
    return KnownPointsFit(weights, sigmas)


def _at_least(matrix: Floats, least: float) -> Floats:
    """A symmetric matrix (R, R) with eigenvalues of at least so much."""
    values, vectors = np.linalg.eigh((matrix + matrix.T) / 2)
    return np.asarray((vectors * np.maximum(values, least)) @ vectors.T)

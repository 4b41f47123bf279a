"""Whether a board's geometry, as it was measured, is the one that the scans see without it.

Of points P with covariance C, adjusted without the board, the board's shape leaves r = P - T b. In the 3 n - 6
directions V in which a shape can differ r has the covariance V^T C V + s^2, s the sigma of the measured geometry, so
that d = r^T V (V^T C V + s^2)^-1 V^T r is a chi squared of as many degrees of freedom, which Wilson and Hilferty's
cube root turns into sigmas of a normal number.
"""

from dataclasses import dataclass, field
from typing import Final

import numpy as np
from scipy.linalg import null_space

from linepose.adjustment.known_board import placed, rigid_motions
from linepose.adjustment.thresholds import MISFIT_SIGMAS
from linepose.arrays import Floats

_FLAT: Final = 1e-6  # of a board's extent


@dataclass(frozen=True)
class BoardFit:
    """What a board's known geometry is worth.

    n_points: of the board, that are seen; misfit_sigmas: of the geometry from what is seen without it, negative where
    it fits better than it need, NaN where that is not known; scale (2,): how many times as long as it was measured the
    board is seen along its x and y, NaN where that is not known; sigma_without (6,): of the pose, without the geometry.
    """

    n_points: int
    misfit_sigmas: float = float("nan")
    scale: Floats = field(default_factory=lambda: np.full(2, np.nan))
    sigma_without: Floats = field(default_factory=lambda: np.full(6, np.nan))

    @property
    def counts(self) -> bool:
        """Whether the geometry was used: it fits, or there was nothing to compare it with."""
        return not self.misfit_sigmas > MISFIT_SIGMAS

    def in_words(self) -> tuple[str, str]:
        """How far a geometry that was not used is off, and what to do."""
        along, across = self.scale
        return (
            f"the target's known geometry is {self.misfit_sigmas:.0f} sigmas off what is seen without it, and is not "
            f"used; the scans show it {along:.3f} times as long along its rows and {across:.3f} times across them",
            "correct the dimensions or ids of target, or target.sigma_m",
        )


def misfit_of_board(board_m: Floats, sigma_m: float, points_m: Floats, covariance: Floats) -> float:
    """How many sigmas a board (n, 3) is off points (n, 3) of covariance (3 n, 3 n) that were seen without it."""
    fit = placed(board_m, points_m)
    shapes = null_space(rigid_motions(fit.points_m).T)
    left, n = shapes.T @ fit.left_m.ravel(), shapes.shape[1]
    square = float(left @ np.linalg.solve(shapes.T @ covariance @ shapes + sigma_m**2 * np.eye(n), left))
    variance = 2 / (9 * n)
    return float((np.cbrt(square / n) - 1 + variance) / np.sqrt(variance))


def scale_of_board(board_m: Floats, points_m: Floats) -> Floats:
    """How many times as long as measured (n, 3) points (n, 3) are seen along the board's x and y; (2,), may be NaN."""
    off = board_m - board_m.mean(axis=0)
    extent = np.abs(off).max(axis=0)
    along = extent > _FLAT * extent.max()
    linear = np.linalg.lstsq(off[:, along], points_m - points_m.mean(axis=0), rcond=None)[0]
    scale = np.full(3, np.nan)
    scale[along] = np.linalg.norm(linear, axis=1)
    return scale[:2]

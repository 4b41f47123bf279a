"""Candidates for the board's targets: dark, elliptic holes in bright rings, at whatever stretch and slant.

A ring stays a ring under any smooth distortion, so its topology is what is looked for: a dark region without contact
to any other dark one. Its second moments then tell the local stretch, because the ring is a circle on the board.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from linepose.arrays import Floats
from linepose.inputs.scans.scan_files import Intensity
from linepose.inputs.targets.ring_board import RingBoard

_LEVELS: Final = np.geomspace(0.08, 0.7, 8)  # of the range of intensities
_SMALLEST_HOLE_PX: Final = 9
_FILLS_ELLIPSE: Final = (0.75, 1.15)  # area over that of the ellipse with the same moments
_DARK_INSIDE: Final = 0.6  # in hole radii: within the hole, beyond the dot
_N_ANGLES: Final = 16
_DARKEST: Final = 0.5  # of the ring's brightness: what a ring has inside and outside
_FULL_CIRCLE: Final = 0.7  # share of a ring's circumference that must look so


@dataclass(frozen=True)
class Targets:
    """Candidates: centres (K, 2) as u and line, the hole's covariance (K, 2, 2), and how ring-like it is (K,)."""

    centre: Floats
    covariance: Floats
    score: Floats

    def select(self, index: NDArray[np.int64]) -> "Targets":
        """These candidates, in the given order."""
        return Targets(self.centre[index], self.covariance[index], self.score[index])


def find_targets(intensity: Intensity, board: RingBoard) -> Targets:
    """All things like a board's rings in an image (L, P), each once, the best first."""
    low, high = float(intensity.min()), float(ndimage.uniform_filter(intensity, 3).max())
    found = [_holes(intensity, low + share * (high - low), board) for share in _LEVELS]
    targets = Targets(*(np.concatenate([getattr(one, name) for one in found]) for name in Targets.__annotations__))
    return _once(targets.select(np.argsort(-targets.score, kind="stable")))


def _holes(intensity: Intensity, level: float, board: RingBoard) -> Targets:
    """Elliptic dark regions at one level, kept where a ring surrounds them."""
    label, n_regions = ndimage.label(intensity < level)
    border = np.unique(np.concatenate([label[0], label[-1], label[:, 0], label[:, -1]]))
    area = np.bincount(label.ravel(), minlength=n_regions + 1)
    wanted = area >= _SMALLEST_HOLE_PX
    wanted[0] = wanted[border] = False
    kept = np.flatnonzero(wanted)
    row, column = np.nonzero(wanted[label])
    index = np.searchsorted(kept, label[row, column])
    n = area[kept].astype(float)
    centre = np.stack([np.bincount(index, one, minlength=len(kept)) / n for one in (column, row)], axis=-1)
    du, dv = column - centre[index, 0], row - centre[index, 1]
    covariance = np.empty((len(kept), 2, 2))
    covariance[:, 0, 0] = np.bincount(index, du * du, minlength=len(kept)) / n + 1 / 12
    covariance[:, 1, 1] = np.bincount(index, dv * dv, minlength=len(kept)) / n + 1 / 12
    covariance[:, 0, 1] = covariance[:, 1, 0] = np.bincount(index, du * dv, minlength=len(kept)) / n
    fills = n / (4 * np.pi * np.sqrt(np.linalg.det(covariance)))
    elliptic = np.flatnonzero((fills > _FILLS_ELLIPSE[0]) & (fills < _FILLS_ELLIPSE[1]))
    centre, covariance = centre[elliptic], covariance[elliptic]
    score = ring_score(intensity, centre, covariance, board)
    ringed = np.flatnonzero(score >= _FULL_CIRCLE)
    return Targets(centre, covariance, score).select(ringed)


def ring_score(intensity: Intensity, centre: Floats, covariance: Floats, board: RingBoard) -> Floats:
    """Share of the circumference with a bright ring between two dark ones; centres (K, 2), holes (K, 2, 2) to (K,)."""
    angle = 2 * np.pi * np.arange(_N_ANGLES) / _N_ANGLES
    circle = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    spread = 2 * np.linalg.cholesky(covariance)  # an ellipse's radius is twice its sigma

    def around(radius: float) -> Floats:
        position = centre[:, None] + radius * np.einsum("kij,aj->kai", spread, circle)
        return ndimage.map_coordinates(intensity, [position[..., 1], position[..., 0]], order=1, mode="nearest")

    inside, ring, outside = (around(one) for one in (_DARK_INSIDE, board.bright_radius, board.dark_radius))
    ringed = (inside < _DARKEST * ring) & (outside < _DARKEST * ring)
    return np.asarray(ringed.mean(axis=1))


def _once(targets: Targets) -> Targets:
    """The candidates, best first, without those that lie within a better one's hole."""
    kept: list[int] = []
    inverse = np.linalg.inv(4 * targets.covariance)
    for one in range(len(targets.centre)):
        offset = targets.centre[one] - targets.centre[kept]
        if not np.any(np.einsum("ki,kij,kj->k", offset, inverse[kept], offset) < 1.0):
            kept.append(one)
    return targets.select(np.array(kept, dtype=np.int64))

"""Matches between two strips: alike, alone in being so, and where the strips' other matches say that they must lie."""

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from linepose.arrays import Floats
from linepose.inputs.tie_points.features import Features

FEWEST: Final = 8  # matches between two strips that bear each other out
_SHARE: Final = 0.2  # of the matches that look alike
_SIZES: Final = 1.5  # ratio of the sizes of one feature in two strips
_UNLIKE: Final = 0.7  # distance of descriptors beyond which features are not alike, though nothing else be near
_SAME: Final = 1e-4  # squared distance of descriptors that differ by rounding alone
_NEIGHBOURS: Final = 10
_CELLS: Final = 3.0  # by which a match may lie off its neighbours at least
_SIGMAS: Final = 4.0
_NORMAL: Final = 1.4826  # from the median of absolute deviations to sigma


@dataclass(frozen=True)
class Matches:
    """Rows (K, 2) of features in two strips, how unlike each pair is (K,), and how many looked alike before."""

    rows: NDArray[np.int64]
    distance: Floats
    n_alike: int


def matches_of(
    first: Features, second: Features, search_m: float, ratio: float, relief_m: float, cell_m: float
) -> Matches:
    """Matches of two strips whose maps may lie `search_m` apart; none where they do not bear each other out.

    relief_m: how far maps may be apart from place to place besides, since the ground is not level.
    """
    rows, distance = alike(first, second, search_m, ratio)
    kept = in_consensus(first.place_m[rows[:, 0]], second.place_m[rows[:, 1]], relief_m, cell_m)
    if kept.sum() < max(FEWEST, _SHARE * len(rows)):
        kept = np.zeros(len(rows), dtype=bool)
    return Matches(rows[kept], distance[kept], len(rows))


def alike(first: Features, second: Features, search_m: float, ratio: float) -> tuple[NDArray[np.int64], Floats]:
    """Rows (K, 2) of features that are each other's best match, by a ratio better than the next, and how unlike (K,).

    Only what lies within `search_m` and is of like size is compared.
    """
    ours, theirs = (_rows_beside(one, other, search_m) for one, other in ((first, second), (second, first)))
    if len(ours) < 2 or len(theirs) < 2:
        return np.zeros((0, 2), dtype=np.int64), np.zeros(0)
    first, second = first.select(ours), second.select(theirs)
    apart = np.maximum(2 - 2 * (first.descriptor @ second.descriptor.T), _SAME)
    for axis in range(2):
        off = np.abs(first.place_m[:, None, axis].astype(np.float32) - second.place_m[None, :, axis].astype(np.float32))
        apart[off > search_m] = np.inf
    sizes = np.log(first.size_m)[:, None].astype(np.float32) - np.log(second.size_m).astype(np.float32)
    apart[np.abs(sizes) > np.log(_SIZES)] = np.inf
    best, back = np.argmin(apart, axis=1), np.argmin(apart, axis=0)
    row = np.arange(len(best))
    least = apart[row, best]
    next_best = np.minimum(_second(apart, best, axis=1)[row], _second(apart, back, axis=0)[best])
    good = (back[best] == row) & (least < _UNLIKE**2) & (least < ratio**2 * next_best)
    return np.column_stack([ours[row[good]], theirs[best[good]]]), np.sqrt(np.maximum(least[good], 0.0))


def in_consensus(first_m: Floats, second_m: Floats, relief_m: float, cell_m: float) -> NDArray[np.bool_]:
    """Which of the matches (K,) at places (K, 2) on two maps bear each other out.

    An affine map that most agree with to `relief_m` is sought; of these, each must lie near its neighbours' median.
    """
    import cv2
    from scipy.spatial import cKDTree

    kept = np.zeros(len(first_m), dtype=bool)
    if len(first_m) < FEWEST:
        return kept
    middle = first_m.mean(axis=0)
    tolerance = max(relief_m, _CELLS * cell_m)
    cv2.setRNGSeed(0)
    found = cv2.estimateAffine2D(
        first_m - middle, second_m - middle, ransacReprojThreshold=tolerance, maxIters=5000, confidence=0.999
    )
    if found[0] is None or abs(np.linalg.det(found[0][:, :2]) - 1) > 0.5:
        return kept
    inside = np.flatnonzero(found[1].ravel())
    for _ in range(2):
        if len(inside) < FEWEST:
            return kept
        off = second_m[inside] - first_m[inside]
        near = np.asarray(cKDTree(first_m[inside]).query(first_m[inside], min(_NEIGHBOURS + 1, len(inside)))[1])[:, 1:]
        from_median = np.linalg.norm(off - np.median(off[near], axis=1), axis=1)
        allowed = max(_CELLS * cell_m, _SIGMAS * _NORMAL * float(np.median(from_median)))
        inside = inside[from_median < allowed]
    kept[inside] = True
    return kept


def _rows_beside(one: Features, other: Features, search_m: float) -> NDArray[np.int64]:
    """Rows of features within the other's extent and `search_m` around it."""
    if not len(one) or not len(other):
        return np.zeros(0, dtype=np.int64)
    low, high = other.place_m.min(axis=0) - search_m, other.place_m.max(axis=0) + search_m
    return np.flatnonzero(np.all((one.place_m >= low) & (one.place_m <= high), axis=1))


def _second(apart: Floats, best: NDArray[np.int64], axis: int) -> Floats:
    """The least but the best along an axis; infinity where there is none."""
    index = np.expand_dims(best, axis)
    least = np.take_along_axis(apart, index, axis)
    np.put_along_axis(apart, index, np.inf, axis)
    second = apart.min(axis=axis)
    np.put_along_axis(apart, index, least, axis)
    return np.asarray(second)

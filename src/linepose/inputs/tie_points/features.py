"""Features of a rectified strip, each with its place on the ground and in the raw scan."""

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from linepose.arrays import Floats
from linepose.inputs.rectified.rectify import Rectified

_TILES: Final = 8  # along the longer side of a map, in which features count alike
_CONTRAST: Final = 0.02  # below which SIFT takes a feature for noise
_STRETCH: Final = (0.005, 0.995)  # quantiles of the light that become black and white
_RIM: Final = 9  # cells beside what a strip did not see, where its end would be taken for a feature


@dataclass(frozen=True)
class Features:
    """K features: place_m (K, 2) on the map, u_px and line (K,) in the raw scan, size_m, worth, descriptor (K, 128).

    worth: contrast of the feature; descriptors have length 1.
    """

    place_m: Floats
    u_px: Floats
    line: Floats
    size_m: Floats
    worth: Floats
    descriptor: NDArray[np.float32]

    def __len__(self) -> int:
        """How many there are."""
        return len(self.u_px)

    def select(self, rows: NDArray[np.int64]) -> "Features":
        """Some of them."""
        return Features(
            self.place_m[rows],
            self.u_px[rows],
            self.line[rows],
            self.size_m[rows],
            self.worth[rows],
            self.descriptor[rows],
        )


def features_of(strip: Rectified, n_features: int) -> Features:
    """At most so many features of a rectified strip, spread over it, upright: maps of all strips have north above."""
    import cv2

    seen = np.isfinite(strip.intensity)
    sift = cv2.SIFT.create(contrastThreshold=_CONTRAST, enable_precise_upscale=True)
    mask = cv2.erode(seen.astype(np.uint8), np.ones((2 * _RIM + 1, 2 * _RIM + 1), np.uint8), borderValue=0)
    picture = _stretched(strip.intensity, seen)
    found = sift.detect(picture, mask)
    at = np.array([one.pt for one in found]).reshape(-1, 2)
    worth = np.array([one.response for one in found])
    once = np.sort(np.unique(at, axis=0, return_index=True)[1])  # SIFT repeats one of two directions
    kept = once[_spread(at[once], worth[once], picture.shape, n_features)]
    upright = [
        cv2.KeyPoint(float(at[k, 0]), float(at[k, 1]), found[k].size, 0.0, found[k].response, found[k].octave)
        for k in kept
    ]
    if not upright:
        none = np.zeros(0)
        return Features(np.zeros((0, 2)), none, none, none, none, np.zeros((0, 128), dtype=np.float32))
    described, descriptor = sift.compute(picture, upright)
    at = np.array([one.pt for one in described])
    u_px, line = _between(strip.u_px, at), _between(strip.line, at)
    root = np.sqrt(descriptor / np.maximum(descriptor.sum(axis=1, keepdims=True), 1e-9))
    features = Features(
        strip.first_m + strip.cell_m * at,
        u_px,
        line,
        strip.cell_m * np.array([one.size for one in described]),
        np.array([one.response for one in described]),
        root.astype(np.float32),
    )
    return features.select(np.flatnonzero(np.isfinite(u_px) & np.isfinite(line)))


def _stretched(intensity: NDArray[np.float32], seen: NDArray[np.bool_]) -> NDArray[np.uint8]:
    """The light as grey values, the mean where nothing was seen."""
    if not seen.any():
        return np.zeros(intensity.shape, dtype=np.uint8)
    dark, bright = np.quantile(intensity[seen], _STRETCH)
    filled = np.where(seen, intensity, np.mean(intensity[seen]))
    return np.clip(255 * (filled - dark) / max(bright - dark, 1e-9), 0, 255).astype(np.uint8)


def _spread(at: Floats, worth: Floats, shape: tuple[int, ...], n_most: int) -> NDArray[np.int64]:
    """Rows of the worthiest features at places (K, 2), alike many of each tile; in the order of their rows."""
    size = max(max(shape) / _TILES, 1.0)
    column, row = (at / size).astype(int).T if len(at) else np.zeros((2, 0), dtype=int)
    tile = row * _TILES * 2 + column
    order = np.lexsort([-worth, tile])
    first = np.searchsorted(tile[order], tile[order])
    rank = np.empty(len(at), dtype=int)
    rank[order] = np.arange(len(at)) - first  # within its tile
    return np.sort(np.lexsort([-worth, rank])[:n_most])


def _between(values: NDArray[np.floating], at: Floats) -> Floats:
    """Values (K,) of a map at places (K, 2), column and row, linear between cells; NaN beside what was not seen."""
    column = np.clip(np.floor(at[:, 0]).astype(int), 0, values.shape[1] - 2)
    row = np.clip(np.floor(at[:, 1]).astype(int), 0, values.shape[0] - 2)
    right, down = at[:, 0] - column, at[:, 1] - row
    above = values[row, column] * (1 - right) + values[row, column + 1] * right
    below = values[row + 1, column] * (1 - right) + values[row + 1, column + 1] * right
    return np.asarray(above * (1 - down) + below * down, dtype=float)

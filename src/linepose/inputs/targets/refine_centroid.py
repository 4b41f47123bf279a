"""A dot's centre as its intensity-weighted mean, in a window that takes the dot's own size and slant.

A slow pass stretches a dot over many lines, so no fixed patch holds it. The window is a Gaussian whose covariance
follows from the second moments of the dot's bright part, and which moves with the centre.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from linepose.arrays import Floats
from linepose.inputs.scans.scan_files import Intensity

_REACH_PX: Final = 5  # how far from the label the dot is looked for
_LARGEST_WINDOW: Final = 1000
_DARK_PERCENT: Final = 20  # the darkest fifth is the print around the dot, even where rings share the window
_LOWEST_PEAK: Final = 0.1  # of the brightest thing around
_LEVEL: Final = 0.35  # of the peak's height above the dark: where a spot ends
_FILLS_ELLIPSE: Final = 0.6  # an arc of a ring fills less
_MARGIN: Final = 0.75  # of the dot's extent, added on each side of it: stays within the ring
_TURNS: Final = 30
_CONVERGED_PX: Final = 1e-4
_WINDOW_VARIANCE: Final = 2.0  # of the bright part's: wide enough to hold it, narrow enough to leave the ring out
_GAIN: Final = 1.5  # the weights pull towards the present centre


@dataclass(frozen=True)
class Spot:
    """A connected bright region: its first line and pixel, and its mask (height, width) from there."""

    top: int
    left: int
    mask: NDArray[np.bool_]

    def holds(self, u: int, v: int) -> bool:
        """Whether a pixel of a line is part of the region."""
        row, column = v - self.top, u - self.left
        height, width = self.mask.shape
        return 0 <= row < height and 0 <= column < width and bool(self.mask[row, column])


def centroid(intensity: Intensity, u_px: float, line: float) -> tuple[float, float] | None:
    """Intensity-weighted centre of the dot nearest a rough position, the background subtracted.

    None where no bright spot that is dark all round lies within 5 pixels and lines.
    """
    spot = _spot(intensity, u_px, line)
    if spot is None:
        return None
    n_lines, n_pixels = intensity.shape
    height, width = spot.mask.shape
    pad_v, pad_u = int(np.ceil(_MARGIN * height)), int(np.ceil(_MARGIN * width))
    top, left = max(spot.top - pad_v, 0), max(spot.left - pad_u, 0)
    bottom, right = min(spot.top + height + pad_v, n_lines), min(spot.left + width + pad_u, n_pixels)
    window = intensity[top:bottom, left:right].astype(float)
    background = float(np.percentile(window, _DARK_PERCENT))
    v, u = np.nonzero(spot.mask)
    start = np.array([u.mean() + spot.left, v.mean() + spot.top])
    found = _weighted_mean(window - background, np.array([left, top], dtype=float), start, _scatter(spot.mask))
    return None if found is None else (float(found[0]), float(found[1]))


def _spot(intensity: Intensity, u_px: float, line: float) -> Spot | None:
    """The brightest solid spot near a position; a ring, whatever its brightness, is hollow and passed over."""
    n_lines, n_pixels = intensity.shape
    u0, v0 = int(np.clip(round(u_px), 0, n_pixels - 1)), int(np.clip(round(line), 0, n_lines - 1))
    top, left = max(v0 - _REACH_PX, 0), max(u0 - _REACH_PX, 0)
    near = intensity[top : v0 + _REACH_PX + 1, left : u0 + _REACH_PX + 1]
    v, u = np.nonzero(near == ndimage.maximum_filter(near, size=3))
    v, u = v + top, u + left
    hollow: list[Spot] = []
    for one in np.argsort(-intensity[v, u], kind="stable"):
        if any(region.holds(int(u[one]), int(v[one])) for region in hollow):
            continue
        region = _region_around(intensity, int(u[one]), int(v[one]))
        if region is None:
            return None
        if _is_solid(region.mask):
            return region
        hollow.append(region)
    return None


def _region_around(intensity: Intensity, u: int, v: int) -> Spot | None:
    """What is joined to a peak and not much darker than it; the window grows until it holds the whole region."""
    n_lines, n_pixels = intensity.shape
    half_u = half_v = 2 * _REACH_PX
    while max(half_u, half_v) <= _LARGEST_WINDOW:
        top, left = max(v - half_v, 0), max(u - half_u, 0)
        window = intensity[top : v + half_v + 1, left : u + half_u + 1]
        dark, bright = float(np.percentile(window, _DARK_PERCENT)), float(window.max())
        height = float(intensity[v, u]) - dark
        if height <= _LOWEST_PEAK * (bright - dark):
            return None
        label, _ = ndimage.label(window > dark + _LEVEL * height)
        mask = label == label[v - top, u - left]
        rows, columns = ndimage.find_objects(mask.astype(np.int8))[0]
        cut_v = (rows.start == 0 and top > 0) or (rows.stop == len(window) and top + rows.stop < n_lines)
        cut_u = (columns.start == 0 and left > 0) or (
            columns.stop == window.shape[1] and left + columns.stop < n_pixels
        )
        if not cut_v and not cut_u:
            return Spot(rows.start + top, columns.start + left, mask[rows, columns])
        half_v, half_u = half_v * (1 + cut_v), half_u * (1 + cut_u)
    return None


def _is_solid(mask: NDArray[np.bool_]) -> bool:
    """Whether a region is without a hole and fills the ellipse of its own moments."""
    if ndimage.binary_fill_holes(mask).sum() > mask.sum():
        return False
    determinant = float(np.linalg.det(_scatter(mask)))
    return mask.sum() >= _FILLS_ELLIPSE * 4 * np.pi * np.sqrt(determinant)


def _scatter(mask: NDArray[np.bool_]) -> Floats:
    """Covariance (2, 2) of a region's area along u and lines."""
    v, u = np.nonzero(mask)
    return np.cov(np.stack([u, v]), bias=True) + np.eye(2) / 12  # a pixel is a square of side 1


def _weighted_mean(light: Floats, corner: Floats, start: Floats, scatter: Floats) -> Floats | None:
    """Centre (u, line) of light (V, U) whose first pixel is at `corner`, from a start and a first scatter (2, 2)."""
    v, u = np.indices(light.shape).reshape(2, -1)
    position = np.stack([u, v], axis=-1) + corner
    light = light.ravel()
    centre, window = start, _WINDOW_VARIANCE * scatter
    for _ in range(_TURNS):
        offset = position - centre
        weight = light * np.exp(-0.5 * np.einsum("ki,ij,kj->k", offset, np.linalg.inv(window), offset))
        total = float(weight.sum())
        if total <= 0:
            return None
        shift = weight @ offset / total
        centre = centre + _GAIN * shift
        if np.linalg.norm(centre - start) > np.ptp(position, axis=0).max():
            return None
        if np.linalg.norm(shift) < _CONVERGED_PX:
            return centre
    return centre

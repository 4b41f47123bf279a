"""A dot's centre as its intensity-weighted mean, in a window that takes the dot's own size and slant.

A slow pass stretches a dot over many lines, so no fixed patch holds it. The window is a Gaussian whose covariance
follows from the second moments of the dot's bright part, and which moves with the centre.
"""

from typing import Final

import numpy as np
from scipy import ndimage

from linepose.extraction.scans import Intensity
from linepose.rotations import Floats

_REACH_PX: Final = 5  # how far from the label the dot is looked for
_LARGEST_WINDOW: Final = 1000
_MARGIN: Final = 0.75  # of the dot's extent, added on each side of it: stays within the ring
_TURNS: Final = 30
_CONVERGED_PX: Final = 1e-4
_WINDOW_VARIANCE: Final = 4.0  # of the bright part's: wide enough to hold it, narrow enough to leave the ring out
_GAIN: Final = 1.5  # the weights pull towards the present centre


def centroid(intensity: Intensity, u_px: float, line: float) -> tuple[float, float] | None:
    """Intensity-weighted centre of the dot nearest a rough position, the background subtracted.

    None where no bright spot that is dark all round lies within 5 pixels and lines.
    """
    spot = _spot(intensity, u_px, line)
    if spot is None:
        return None
    rows, columns, region = spot
    n_lines, n_pixels = intensity.shape
    pad_v, pad_u = (int(np.ceil(_MARGIN * (one.stop - one.start))) for one in (rows, columns))
    top, left = max(rows.start - pad_v, 0), max(columns.start - pad_u, 0)
    window = intensity[top : min(rows.stop + pad_v, n_lines), left : min(columns.stop + pad_u, n_pixels)].astype(float)
    border = np.concatenate([window[0], window[-1], window[:, 0], window[:, -1]])
    background = float(np.median(border))
    v, u = np.nonzero(region)
    start = np.array([u.mean() + columns.start, v.mean() + rows.start])
    scatter = np.cov(np.stack([u, v]), bias=True) + np.eye(2) / 12
    found = _weighted_mean(window - background, np.array([left, top], dtype=float), start, scatter)
    return None if found is None else (float(found[0]), float(found[1]))


def _spot(intensity: Intensity, u_px: float, line: float) -> tuple[slice, slice, np.ndarray] | None:
    """Rows, columns and mask of the bright spot near a position, dark all round: the window grows until it holds it."""
    n_lines, n_pixels = intensity.shape
    u0, v0 = int(np.clip(round(u_px), 0, n_pixels - 1)), int(np.clip(round(line), 0, n_lines - 1))
    half_u = half_v = 2 * _REACH_PX
    while max(half_u, half_v) <= _LARGEST_WINDOW:
        top, left = max(v0 - half_v, 0), max(u0 - half_u, 0)
        window = intensity[top : v0 + half_v + 1, left : u0 + half_u + 1]
        near = window[
            max(v0 - _REACH_PX - top, 0) : v0 + _REACH_PX + 1 - top,
            max(u0 - _REACH_PX - left, 0) : u0 + _REACH_PX + 1 - left,
        ]
        # the darkest tenth is the print around the dot even where a ring shares the window
        dark = float(np.percentile(window, 10))
        v, u = np.unravel_index(int(np.argmax(near)), near.shape)
        v, u = v + max(v0 - _REACH_PX - top, 0), u + max(u0 - _REACH_PX - left, 0)
        label, _ = ndimage.label(window > (dark + float(window[v, u])) / 2)
        if label[v, u] == 0:
            return None
        rows, columns = ndimage.find_objects((label == label[v, u]).astype(np.int8))[0]
        touches_v = (rows.start == 0 and top > 0) or (rows.stop == window.shape[0] and top + rows.stop < n_lines)
        touches_u = (columns.start == 0 and left > 0) or (
            columns.stop == window.shape[1] and left + columns.stop < n_pixels
        )
        if not touches_v and not touches_u:
            region = label[rows, columns] == label[v, u]
            return (
                slice(rows.start + top, rows.stop + top),
                slice(columns.start + left, columns.stop + left),
                region,
            )
        half_v, half_u = half_v * (1 + touches_v), half_u * (1 + touches_u)
    return None


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

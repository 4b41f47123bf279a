"""The paper's way to a dot's centre: the intensity peak of an enlarged patch (section 3.3)."""

from typing import Final

import numpy as np
from PIL import Image
from scipy import ndimage

from linepose.inputs.scans.scan_files import Intensity

_PATCH: Final = 10
_ENLARGED: Final = 100
_LOWEST_PEAK: Final = 0.1  # of the range of the patch: lesser peaks are noise of the dark print


def peak(intensity: Intensity, u_px: float, line: float) -> tuple[float, float] | None:
    """Peak nearest the centre of the 10 x 10 patch around a label, enlarged to 100 x 100 by bicubic interpolation.

    None where the patch does not fit into the scan or is without contrast.
    """
    n_lines, n_pixels = intensity.shape
    if min(n_lines, n_pixels) < _PATCH:
        return None
    left = int(np.clip(round(u_px - (_PATCH - 1) / 2), 0, n_pixels - _PATCH))
    top = int(np.clip(round(line - (_PATCH - 1) / 2), 0, n_lines - _PATCH))
    patch = np.ascontiguousarray(intensity[top : top + _PATCH, left : left + _PATCH])
    enlarged = np.asarray(Image.fromarray(patch).resize((_ENLARGED, _ENLARGED), Image.Resampling.BICUBIC))
    low, high = float(enlarged.min()), float(enlarged.max())
    if high <= low:
        return None
    is_peak = (enlarged == ndimage.maximum_filter(enlarged, size=3)) & (enlarged >= low + _LOWEST_PEAK * (high - low))
    rows, columns = np.nonzero(is_peak)
    scale = _ENLARGED / _PATCH
    u, v = left + (columns + 0.5) / scale - 0.5, top + (rows + 0.5) / scale - 0.5
    nearest = int(np.argmin((u - u_px) ** 2 + (v - line) ** 2))
    return float(u[nearest]), float(v[nearest])

"""How far a dot stands out of the noise around it."""

from typing import Final

import numpy as np

from linepose.inputs.scans.scan_files import Intensity

_REACH: Final = 12  # pixels and lines around the dot
_SIGMA_OF_DIFFERENCES: Final = 1.4826 / np.sqrt(2)  # of normal noise, from the median of absolute differences


def contrast(intensity: Intensity, u_px: float, line: float) -> float:
    """Height of the mean of 3 x 3 pixels at a place above the median around it, in sigmas of a pixel's noise.

    The noise is that of neighbours along the line, most of which lie on even ground; infinite where there is none. The
    brightest spot of pure noise has 1 or 2, a printed dot 10 and more.
    """
    row, column = round(line), round(u_px)
    window = _part(intensity, row, column, _REACH)
    noise = float(_SIGMA_OF_DIFFERENCES * np.median(np.abs(np.diff(window, axis=1))))
    height = float(np.mean(_part(intensity, row, column, 1)) - np.median(window))
    return height / noise if noise > 0 else np.inf


def _part(intensity: Intensity, row: int, column: int, reach: int) -> np.ndarray:
    rows, columns = (slice(max(centre - reach, 0), centre + reach + 1) for centre in (row, column))
    return np.asarray(intensity[rows, columns], dtype=float)

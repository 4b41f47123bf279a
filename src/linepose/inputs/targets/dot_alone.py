"""A dot hardly larger than a pixel, refined without the ring around it.

Such a dot is dimmer than its ring, and a few pixels from it: what follows the light to its middle ends in the ring.
"""

from typing import Final

import numpy as np

from linepose.arrays import Floats
from linepose.inputs.scans.scan_files import Intensity
from linepose.inputs.targets.refine import Refine
from linepose.inputs.targets.ring_board import RingBoard

_DOT: Final = 0.4  # hole radii about the expected place, that a dot may fill
_HOLE: Final = 0.75  # hole radii that are dark but for the dot
_LEAST_SIGMAS: Final = 8.0  # of the hole's noise, that the dot's brightest place must stand out by
_FEWEST: Final = 8  # places of the dark hole
_SIGMA_OF_DEVIATIONS: Final = 1.4826  # of normal noise, from the median of absolute deviations
_ROOM: Final = 12  # pixels and lines around the hole


def dot_alone(intensity: Intensity, expected: Floats, jacobian: Floats, refine: Refine, board: RingBoard) -> Floats:
    """Centre (2,) of the dot expected at u and line (2,), all beyond its hole taken for dark; NaN where there is none.

    jacobian (2, 2): of the scan's position by the board's, pixels and lines per metre.
    """
    nothing = np.full(2, np.nan)
    reach = np.ceil(board.hole_radius_m * np.linalg.norm(jacobian, axis=1)).astype(int) + _ROOM
    first = np.maximum(np.floor(expected).astype(int) - reach, 0)
    last = np.minimum(np.ceil(expected).astype(int) + reach + 1, intensity.shape[::-1])
    window = intensity[first[1] : last[1], first[0] : last[0]].astype(np.float32)
    line, u = np.indices(window.shape)
    offset = np.stack([u, line], axis=-1) + first - expected
    radius = np.linalg.norm(offset @ np.linalg.inv(jacobian).T, axis=-1) / board.hole_radius_m
    dark = window[(radius > _DOT) & (radius < _HOLE)]
    if dark.size < _FEWEST:
        return nothing
    level = np.median(dark)
    noise = _SIGMA_OF_DEVIATIONS * np.median(np.abs(dark - level))
    dot = window[radius <= _DOT]
    if not dot.size or not dot.max() - level > _LEAST_SIGMAS * noise:
        return nothing
    window[radius >= _HOLE] = level
    found = refine(window, *(expected - first).tolist())
    return nothing if found is None else np.array(found) + first

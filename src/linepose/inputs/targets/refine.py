"""From a rough label to the dot's centre, by one of several methods of the same signature.

A method takes intensities (L, P) and one rough position (u, line), and returns the centre (u, line), or None where
there is no dot. Positions count pixels and lines from 0, whole numbers at their centres.
"""

from collections.abc import Callable
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from linepose.arrays import Floats
from linepose.inputs.scans.scan_files import Intensity
from linepose.inputs.targets.refine_centroid import centroid
from linepose.inputs.targets.refine_peak import peak

Refine = Callable[[Intensity, float, float], tuple[float, float] | None]

METHODS: Final[dict[str, Refine]] = {"peak": peak, "centroid": centroid}
AS_LABELLED: Final = "none"
REFINEMENTS: Final[dict[str, Refine]] = {**METHODS, AS_LABELLED: lambda _, u_px, line: (u_px, line)}


def refine_points(method: Refine, intensity: Intensity, position: ArrayLike) -> Floats:
    """Centres near rough positions (K, 2) of u and line; (K, 2), NaN where there is no dot."""
    found = [method(intensity, float(u), float(line)) for u, line in np.asarray(position, dtype=float)]
    return np.array([(np.nan, np.nan) if one is None else one for one in found]).reshape(-1, 2)

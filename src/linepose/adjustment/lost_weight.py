"""How many measurements lose their weight by heavy tails alone, so that more of them are a fault.

A measurement's weight is w = (nu + 2) / (nu + d), d its two squared errors in sigmas. If errors have the tails that
the weights allow for, d / 2 follows Fisher's F of 2 and nu degrees of freedom, and

    P(w < W) = (1 + ((nu + 2) / W - nu) / nu)^(-nu / 2),

one in 36 for W = 0.25 and nu = 4; errors without tails lose their weight far more rarely.
"""

from typing import Final

import numpy as np
from scipy.special import bdtr

from linepose.adjustment.thresholds import DEGREES_OF_FREEDOM, DOUBTFUL_WEIGHT, MEASUREMENT_DIMENSION

SHARE_OF_TAILS: Final = (((DEGREES_OF_FREEDOM + MEASUREMENT_DIMENSION) / DOUBTFUL_WEIGHT) / DEGREES_OF_FREEDOM) ** (
    -DEGREES_OF_FREEDOM / 2
)  # of measurements, that tails let expect below DOUBTFUL_WEIGHT
_RARELY: Final = 1e-3  # as often more than the bound lose their weight by tails alone


def most_lost_by_tails(n_measurements: int) -> int:
    """How many of so many measurements lose their weight by heavy tails alone, but for one case in a thousand.

    None below 36, of which tails let expect less than one: there each is worth a look, though tails may be all of it.
    """
    if n_measurements * SHARE_OF_TAILS < 1:
        return 0
    counts = np.arange(n_measurements + 1)
    return int(np.argmax(bdtr(counts, n_measurements, SHARE_OF_TAILS) >= 1 - _RARELY))

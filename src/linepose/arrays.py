"""Array types, and numbers of arrays as text."""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def exact_decimal(value: float) -> str:
    """The shortest decimal that reads back to the same double, as other programs parse it.

    A NumPy scalar's own `repr` is `np.float64(...)`, which PROJ reads as 0.
    """
    return repr(float(value))

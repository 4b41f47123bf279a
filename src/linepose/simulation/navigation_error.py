"""The true error of a simulated navigation solution: correlated in time, white, and constant in a view.

An error has six axes: north, east, down (m), roll, pitch, yaw (rad). It is independent of what the system reports.
"""

import numba
import numpy as np
from numpy.typing import ArrayLike, NDArray

from linepose.arrays import Floats
from linepose.simulation.settings import NavigationErrorSettings


def navigation_errors(
    rng: np.random.Generator, settings: NavigationErrorSettings, time_s: ArrayLike, view: NDArray[np.int64]
) -> Floats:
    """Errors at times in ascending order, each in a view (a whole number from 0); (K,), (K,) to (K, 6)."""
    time = np.asarray(time_s, dtype=float)
    correlated = np.array([*settings.gauss_markov_position_m, *settings.gauss_markov_euler_rad])
    white = np.array([*settings.white_position_m, *settings.white_euler_rad])
    in_view = np.array([*settings.view_position_m, *settings.view_euler_rad])
    errors = correlated * unit_gauss_markov(rng, time, settings.correlation_time_s)
    errors += white * rng.standard_normal((len(time), 6))
    return errors + (in_view * rng.standard_normal((int(view.max(initial=0)) + 1, 6)))[view]


def unit_gauss_markov(rng: np.random.Generator, time_s: ArrayLike, correlation_time_s: float) -> Floats:
    """Six stationary first-order Gauss-Markov processes of sigma 1, exact at uneven times; (K,) to (K, 6).

    The correlation of two times is `exp(-|dt| / correlation_time_s)`.
    """
    time = np.asarray(time_s, dtype=float)
    decay = np.exp(-np.diff(time) / correlation_time_s)
    return _filtered(rng.standard_normal((len(time), 6)), decay)


@numba.njit(cache=True)
def _filtered(white: Floats, decay: Floats) -> Floats:
    values = white.copy()
    for k in range(1, len(white)):
        innovation = np.sqrt(1.0 - decay[k - 1] ** 2)
        for axis in range(white.shape[1]):
            values[k, axis] = decay[k - 1] * values[k - 1, axis] + innovation * white[k, axis]
    return values

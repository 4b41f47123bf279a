"""Simulated navigation errors of one kind each, or of two."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from linepose.simulation.settings import NavigationErrorSettings, Triple


def white_per_line(sigma: Sequence[float]) -> NavigationErrorSettings:
    """Errors independent from point to point; sigma (6,) in m and rad."""
    return NavigationErrorSettings(white_position_m=_triple(sigma[:3]), white_euler_rad=_triple(sigma[3:]))


def constant_in_view(sigma: Sequence[float]) -> NavigationErrorSettings:
    """Errors alike for all points of a view, independent from view to view; sigma (6,) in m and rad."""
    return NavigationErrorSettings(view_position_m=_triple(sigma[:3]), view_euler_rad=_triple(sigma[3:]))


def mixed(sigma: Sequence[float], view_share: float) -> NavigationErrorSettings:
    """Errors of variance sigma^2, of which `view_share` is constant in a view and the rest white; sigma (6,)."""
    view, white = np.asarray(sigma) * np.sqrt(view_share), np.asarray(sigma) * np.sqrt(1 - view_share)
    return NavigationErrorSettings(
        white_position_m=_triple(white[:3]),
        white_euler_rad=_triple(white[3:]),
        view_position_m=_triple(view[:3]),
        view_euler_rad=_triple(view[3:]),
    )


def gauss_markov(sigma: Sequence[float], correlation_time_s: float) -> NavigationErrorSettings:
    """Errors correlated in time alone; sigma (6,) in m and rad."""
    return NavigationErrorSettings(
        gauss_markov_position_m=_triple(sigma[:3]),
        gauss_markov_euler_rad=_triple(sigma[3:]),
        correlation_time_s=correlation_time_s,
    )


def _triple(values: ArrayLike) -> Triple:
    first, second, third = np.asarray(values, dtype=float).tolist()
    return first, second, third

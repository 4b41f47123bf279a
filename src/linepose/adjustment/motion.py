"""How the body moves: its rates, along which a clock offset moves it, and how far it moves in one line.

A measurement that is a line late is wrong by the motion in one line. Across the scan line no pixel is measured but a
time, so noise there is lateness. Its image follows the camera's pose as the residuals do, which noise in pixels would
not. The rate is a straight line through the reported poses of a view; the duration of a line is what the time stamps
are multiples of.
"""

from typing import Final

import numpy as np
from numpy.typing import NDArray

from linepose.arrays import Floats

_LONGEST_GAP_US: Final = 200_000.0  # between two measurements whose difference of time is still compared with multiples
_SHORTEST_PERIOD_US: Final = 100.0
_COHERENCE: Final = 0.9  # of the differences with multiples of a period, 1 is perfect
_FEWEST_DIFFERENCES: Final = 20
_MOST_DIFFERENCES: Final = 500
_TRIED: Final = 1500


def body_rates(body_pose: Floats, time_us: NDArray[np.int64], view: NDArray[np.int64]) -> Floats:
    """Rates (L, 6) of position (m/s) and Euler angles (rad/s), one a view; NaN where a view's times do not differ."""
    rates = np.full(body_pose.shape, np.nan)
    for rows in _rows_of_views(view):
        time_s = (time_us[rows] - time_us[rows].min()) * 1e-6
        centred = time_s - time_s.mean()
        spread = centred @ centred
        if spread > 0:
            pose = body_pose[rows].copy()
            pose[:, 3:] = np.unwrap(pose[:, 3:], axis=0)
            rates[rows] = centred @ (pose - pose[0]) / spread
    return rates


def line_period_s(time_us: NDArray[np.int64], view: NDArray[np.int64]) -> float | None:
    """Duration of a line (s), the longest of which differences of time within views are multiples; None if of none."""
    differences = np.concatenate([_differences(np.sort(time_us[rows])) for rows in _rows_of_views(view)])
    differences = differences[:: max(1, len(differences) // _MOST_DIFFERENCES)]
    if len(differences) < _FEWEST_DIFFERENCES:
        return None
    periods = np.geomspace(4 * float(np.quantile(differences, 0.25)), _SHORTEST_PERIOD_US, _TRIED)
    good = np.flatnonzero(_coherence(differences, periods) > _COHERENCE)
    if len(good) == 0:
        return None
    near = periods[good[0]] * np.linspace(0.97, 1.0, 301)
    return float(near[int(np.argmax(_coherence(differences, near)))]) * 1e-6


def _rows_of_views(view: NDArray[np.int64]) -> list[NDArray[np.int64]]:
    """Rows of each view, in one sort."""
    order = np.argsort(view, kind="stable")
    return np.split(order, np.flatnonzero(np.diff(view[order])) + 1)


def _coherence(differences: Floats, periods: Floats) -> Floats:
    """How near differences (D,) are to multiples of periods (P,), 1 if they all are; (P,)."""
    return np.cos(2 * np.pi * differences / periods[:, None]).mean(axis=1)


def _differences(ascending_us: NDArray[np.int64]) -> Floats:
    one = np.diff(ascending_us).astype(float)
    return one[(one > _SHORTEST_PERIOD_US) & (one < _LONGEST_GAP_US)]


def lateness_of_views(
    rates: Floats,
    time_us: NDArray[np.int64],
    view: NDArray[np.int64],
    sigma_v_px: float,
    period_s: float | None,
) -> tuple[Floats, Floats]:
    """Motion in one line (L, 6) at rates (L, 6), and a sigma across the line (L,) that stands for it (px).

    Of the two one is zero. Without a period given, and where the time stamps do not tell it, motion is not known.
    """
    period = period_s if period_s is not None else line_period_s(time_us, view)
    motion = np.nan_to_num(rates * (period or 0.0), nan=0.0)
    moves = np.any(motion != 0, axis=1)
    return motion, np.where(moves, 0.0, 2.0 * sigma_v_px)

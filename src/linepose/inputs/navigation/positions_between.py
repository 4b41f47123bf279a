"""Positions of fixes at the times of attitudes, which other messages bring at another rate."""

import logging
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from linepose.arrays import Floats
from linepose.errors import InputError

_BEYOND_S: Final = 0.05  # how long before the first fix and after the last the motion between two fixes is taken on
DEFAULT_GAP_S: Final = 1.5  # fixes once a second, whose stamps jitter

GAP_KEY: Final = "source.navigation.maximum_fix_gap_s"

log = logging.getLogger(__name__)


@dataclass(frozen=True)
class Between:
    """Which attitudes have a position (A,), and those positions (K, 3); the key by which some have none."""

    near: NDArray[np.bool_]
    position: Floats
    gap_key: str | None


def positions_between(
    attitude_us: NDArray[np.int64], fix_us: NDArray[np.int64], geodetic: Floats, maximum_gap_s: float, place: str
) -> Between:
    """Positions at the attitudes (A,) that lie between two of the fixes (F,) at most so far apart.

    `fix_us` increases; positions (F, 3) are latitude, longitude (deg) and height (m), and linear in between. How many
    attitudes are left out is told with the key that decides it; raises InputError where all are.
    """
    after = np.searchsorted(fix_us, attitude_us).clip(1, len(fix_us) - 1)
    step_us = fix_us[after] - fix_us[after - 1]
    beyond_us = np.maximum(fix_us[0] - attitude_us, attitude_us - fix_us[-1])
    in_gap = (step_us > maximum_gap_s * 1e6) & (attitude_us != fix_us[after])
    outside = beyond_us > _BEYOND_S * 1e6
    near = ~in_gap & ~outside
    if not near.any() or np.diff(fix_us).min() > maximum_gap_s * 1e6:
        found = f"no message between two fixes at most {maximum_gap_s:g} s apart"
        remedy = f"raise {GAP_KEY}, or check the stamps"
        raise InputError(place, found, "fixes around the attitudes", remedy)
    lost = np.count_nonzero(in_gap & ~outside)
    if lost:
        told = (
            "%s: %d of %d poses are left out: fixes around them are %.3f s apart, more than %g s; complete the fixes, "
        )
        told += f"or raise {GAP_KEY}"
        longest_s = float(np.max(step_us[in_gap & ~outside])) / 1e6
        log.warning(told, place, lost, len(attitude_us), longest_s, maximum_gap_s)
    if np.any(outside):
        log.info("%s: %d of %d poses lie outside the fixes", place, np.count_nonzero(outside), len(attitude_us))
    row = after[near]
    share = (attitude_us[near] - fix_us[row - 1]) / step_us[near]
    position = geodetic[row - 1] + share[:, None] * (geodetic[row] - geodetic[row - 1])
    return Between(near, position, GAP_KEY if lost else None)

"""Rows of a recording that can be used: with numbers, in the order of time, each once; what is left out is counted."""

import logging

import numpy as np
from numpy.typing import NDArray

from linepose.arrays import Floats

log = logging.getLogger(__name__)


def usable_rows(time_us: NDArray[np.int64], values: Floats, place: str) -> NDArray[np.int64]:
    """Rows of times (K,) and values (K, N) in the order of time, without those of no number and exact repeats.

    Rows of one time and other values stay. One line of the log says how many are passed over, and why.
    """
    whole = np.flatnonzero(np.all(np.isfinite(values), axis=1))
    order = whole[np.argsort(time_us[whole], kind="stable")]
    times, of_times = time_us[order], values[order]
    repeated = np.zeros(len(order), dtype=bool)
    repeated[1:] = (np.diff(times) == 0) & np.all(of_times[1:] == of_times[:-1], axis=1)
    told = {
        "without a value are left out": len(time_us) - len(whole),
        "that repeat the one before are passed over": int(np.count_nonzero(repeated)),
        "behind later ones are sorted by time": int(
            np.count_nonzero(time_us[whole] < np.maximum.accumulate(time_us[whole])) if len(whole) else 0
        ),
    }
    faults = [f"{count} records {what}" for what, count in told.items() if count]
    if faults:
        log.warning("%s: %s", place, "; ".join(faults))
    return np.asarray(order[~repeated])


def placed(geodetic: Floats, place: str) -> NDArray[np.bool_]:
    """Which of latitude, longitude (deg) and height (K, 3) are not 0, 0, as devices write them without a fix; counted.

    All, where there are no others.
    """
    known: NDArray[np.bool_] = np.any(geodetic[:, :2] != 0, axis=1)
    if known.all() or not known.any():
        return np.ones(len(geodetic), dtype=bool)
    told = "%s: %d of %d records at latitude 0, longitude 0, as without a fix, are left out"
    log.warning(told, place, np.count_nonzero(~known), len(known))
    return known

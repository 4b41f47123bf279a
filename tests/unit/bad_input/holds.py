"""What holds of anything that a reader returns, whatever was done to its file."""

from typing import Any

import numpy as np
import pandas as pd

EARLIEST_US, LATEST_US = 3e14, 4.2e15  # 1979 and 2103
MOST_RAD = 12.7


def log_holds(record: Any) -> bool:
    """Poses in order between 1980 and 2100, of numbers, turned by at most two turns; covariances of numbers."""
    log = record.log
    good = np.all(np.diff(log.time_us) > 0) and log.time_us[0] > EARLIEST_US and log.time_us[-1] < LATEST_US
    good = good and np.all(np.isfinite(log.position_m)) and np.all(np.abs(log.euler_rad) < MOST_RAD)
    if record.covariances is None:
        return bool(good)
    return bool(good and np.all(np.isfinite(record.covariances.covariance)))


def times_hold(times: Any) -> bool:
    """Times of lines in order."""
    return bool(np.all(np.diff(times) > 0) and times[0] > EARLIEST_US and times[-1] < LATEST_US)


def image_holds(mean: Any) -> bool:
    """An image of numbers."""
    return bool(mean.ndim == 2 and mean.size and np.all(np.isfinite(mean)))


def labels_hold(table: pd.DataFrame) -> bool:
    """Points with names, each once an observation that has a scan, at places of numbers."""
    named = all(str(one).isprintable() and str(one).strip() for one in table["point"])
    once = not table.duplicated(["observation", "point"]).any()
    known = table["observation"].isin([1, 3]).all()
    return bool(named and once and known and np.isfinite(table[["u_px", "line"]]).all(axis=None))


def views_hold(table: pd.DataFrame) -> bool:
    """Points with names, at places of numbers on the sensor."""
    named = all(str(one).isprintable() and str(one).strip() for one in table["point"])
    return bool(
        named and np.isfinite(table.drop(columns="point")).all(axis=None) and table["u_px"].between(-0.5, 647.5).all()
    )


def covariances_hold(covariances: Any) -> bool:
    """Covariances of numbers, none of them negative on the diagonal, at times between 1980 and 2100."""
    matrices = covariances.covariance
    good = np.all(np.isfinite(matrices)) and np.all(np.diagonal(matrices, axis1=1, axis2=2) >= 0)
    time_us = covariances.time_us
    return bool(good and (not len(time_us) or (time_us.min() > EARLIEST_US and time_us.max() < LATEST_US)))


def points_hold(known: Any) -> bool:
    """Points with names at places of numbers, with weights that are not negative."""
    named = all(name.strip() and name.isprintable() for name in known)
    numbers = all(
        np.all(np.isfinite(one.position_m)) and np.all(np.linalg.eigvalsh(one.information) >= 0)
        for one in known.values()
    )
    return bool(known and named and numbers)

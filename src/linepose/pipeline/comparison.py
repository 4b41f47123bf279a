"""Two calibrations beside each other: by parameter, by how unlikely the difference is, and by what a pixel moves."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.estimation.pixel_shift import Mounted, pixel_shift, shift_covariance
from linepose.estimation.pose_change import (
    GROUPS,
    MOVES,
    PER_MOVE,
    PoseChange,
    change_of_estimates,
    covariance_of_difference,
)
from linepose.geometry.distance import check_covariance, difference_covariance, pose_difference
from linepose.pipeline.adjusted_intrinsics import NAMES
from linepose.pipeline.calibration import HAND_MEASURED, Calibration


@dataclass(frozen=True, eq=False)
class Comparison:
    """How a second calibration differs from a first; what `compare` returns.

    Parameters
    ----------
    names : tuple of str
        Of the first and the second.
    difference : ndarray of shape (6,)
        Forward, right, down (m), and turn about these axes (rad).
    covariance : ndarray of shape (6, 6)
        Of the difference, m and rad.
    range_m : float
        At which a pixel's place on the ground is compared (m).
    pixels : pandas.DataFrame
        One row a place on the line: its shift along and across the line (m) with sigmas.
    shares_hand_measurement : bool
        Whether both rest on the same one, which then counts once.
    n_shared_measurements : int
        On which both rest; with any there is no p-value.

    Examples
    --------
    >>> calibration = linepose.calibrate_platform("myrobot")
    >>> comparison = linepose.compare(calibration, calibration, range_m=3.0)
    >>> comparison.difference.tolist(), comparison.n_shared_measurements == len(calibration.observations)
    ([0.0, 0.0, 0.0, 0.0, 0.0, 0.0], True)
    """

    names: tuple[str, str]
    difference: Floats
    covariance: Floats
    range_m: float
    pixels: pd.DataFrame
    shares_hand_measurement: bool
    n_shared_measurements: int = 0

    @property
    def change(self) -> PoseChange:
        """The difference as tests and moves."""
        return change_of_estimates(self.difference, self.covariance)

    def table(self) -> pd.DataFrame:
        """One row a number: `difference`, `sigma`, in m and degrees, and `sigmas`."""
        sigma = np.sqrt(np.diag(self.covariance))
        columns = {"difference": self.difference * PER_MOVE, "sigma": sigma * PER_MOVE}
        return pd.DataFrame(columns, index=list(MOVES)).assign(sigmas=self.difference / sigma)

    def as_dict(self) -> dict[str, Any]:
        """All of it as JSON holds it."""
        tests = {group: self.change.test(group) for group in GROUPS}
        return {
            "format": "linepose comparison",
            "version": 1,
            "first": self.names[0],
            "second": self.names[1],
            "differences": _finite(self.table()),
            "tests": {
                group: {"sigmas": one.distance, "p_value": None if self.n_shared_measurements else one.p_value}
                for group, one in tests.items()
            },
            "range_m": self.range_m,
            "pixels": _finite(self.pixels),
            "shares_hand_measurement": self.shares_hand_measurement,
            "n_shared_measurements": self.n_shared_measurements,
        }


def _finite(table: pd.DataFrame) -> dict[str, dict[str, float | None]]:
    """Rows as JSON holds them: None for what is no finite number."""
    return {
        str(name): {key: float(value) if np.isfinite(value) else None for key, value in row.items()}
        for name, row in table.iterrows()
    }


def compare(first: Calibration, second: Calibration, range_m: float) -> Comparison:
    """What leads from a first calibration to a second, and by how much a pixel's place on the ground moves.

    A hand measurement that is the same prior of both counts once; all else is taken as independent.

    Parameters
    ----------
    first, second : Calibration
        Of cameras with equally many pixels.
    range_m : float
        Distance of the ground from the camera (m).

    Returns
    -------
    Comparison
        The difference (m, rad) with its covariance, and the move of pixels (m).

    Raises
    ------
    InputError
        The range is none, or the cameras have different lines.

    Examples
    --------
    >>> calibration = linepose.calibrate_platform("myrobot")
    >>> linepose.compare(calibration, calibration, range_m=3.0).shares_hand_measurement
    True
    """
    if not (np.isfinite(range_m) and range_m > 0):
        raise InputError("range", f"{range_m} m", "a distance above 0", "give that of the ground from the camera")
    if first.camera.n_pixels != second.camera.n_pixels:
        raise InputError(
            f"camera of {second.name}",
            f"{second.camera.n_pixels} pixels",
            f"{first.camera.n_pixels}, as {first.name} has",
            "compare calibrations of one camera",
        )
    covariances = [
        difference_covariance(one.pose, check_covariance(one.covariance, f"covariance of {one.name}"))
        for one in (first, second)
    ]
    shared = _prior_of(first) is not None and _same(_prior_of(first), _prior_of(second))
    total = covariances[0] + covariances[1]
    if shared:
        total = covariance_of_difference(covariances, first.hand_measured.body_covariance)
    mounted = [Mounted(one.own_camera, one.pose) for one in (first, second)]
    return Comparison(
        (first.name, second.name),
        pose_difference(second.pose, first.pose),
        total,
        range_m,
        _pixels(mounted[0], mounted[1], range_m, *_with_intrinsics(total, first, second)),
        shared,
        _n_shared_measurements(first, second),
    )


def _with_intrinsics(covariance: Floats, first: Calibration, second: Calibration) -> tuple[Floats, tuple[str, ...]]:
    """Covariance (6 + I, 6 + I) of the difference of pose and of intrinsics, given the pose's; with these's names."""
    estimated = [one for one in (first.intrinsics, second.intrinsics) if one is not None]
    names = tuple(name for name in NAMES if any(name in one.names for one in estimated))
    whole = np.zeros((6 + len(names), 6 + len(names)))
    whole[:6, :6] = covariance
    for one in estimated:
        at = [6 + names.index(name) for name in one.names]
        whole[np.ix_(at, at)] += one.covariance
        whole[:6, at] += one.with_pose
    whole[6:, :6] = whole[:6, 6:].T
    return whole, names


def _n_shared_measurements(first: Calibration, second: Calibration) -> int:
    """How many measurements both rest on, by time and pixel."""
    tables = [one.observations.loc[one.observations["time_us"] != 0, ["time_us", "u_px"]] for one in (first, second)]
    return len(tables[0].merge(tables[1], on=["time_us", "u_px"]))


def _prior_of(calibration: Calibration) -> Floats | None:
    """Pose and sigmas of the hand measurement where it is a prior of the calibration."""
    if calibration.stage == HAND_MEASURED or calibration.platform is None or calibration.platform.prior == "none":
        return None
    hand = calibration.hand_measured
    return np.concatenate([hand.pose, np.sqrt(np.diag(hand.body_covariance))])


def _same(one: Floats | None, other: Floats | None) -> bool:
    return one is not None and other is not None and bool(np.array_equal(one, other))


def _pixels(
    first: Mounted, second: Mounted, range_m: float, covariance: Floats, names: tuple[str, ...]
) -> pd.DataFrame:
    last = first.camera.n_pixels - 1
    rows = {}
    for place, pixel in (("first", 0.0), ("centre", last / 2), ("last", float(last))):
        along, across = pixel_shift(first, second, pixel, range_m)
        variance = np.diag(shift_covariance(first, second, pixel, range_m, covariance, names))
        sigma = np.sqrt(np.maximum(variance, 0.0))
        rows[place] = {
            "along_m": along,
            "across_m": across,
            "sigma_along_m": sigma[0],
            "sigma_across_m": sigma[1],
            "shift_px": float(np.hypot(along, across)) * first.camera.focal_length_px / range_m,
        }
    return pd.DataFrame.from_dict(rows, orient="index")

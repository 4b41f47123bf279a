"""The navigation system's covariances, and which of them holds for a point."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd
import pyarrow as pa
from numpy.typing import NDArray

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.inputs.number_files import check_microseconds, read_numbers
from linepose.survey.observations import COVARIANCE_COLUMNS, COVARIANCE_INDICES
from linepose.tables import floats

SIGMA_COLUMNS: Final = (
    "sigma_north_m",
    "sigma_east_m",
    "sigma_down_m",
    "sigma_roll_rad",
    "sigma_pitch_rad",
    "sigma_yaw_rad",
)
NAVIGATION_SIGMA: Final = pa.schema(floats(*SIGMA_COLUMNS))
_SIZE: Final = 12
_ASYMMETRY: Final = 1e-9  # as a correlation: both halves are printed alike
_NEGATIVE: Final = 1e-5  # as an eigenvalue of the correlations: what rounding to six printed digits may leave


@dataclass(frozen=True)
class NavigationCovariances:
    """Covariances (K, 6, 6) of north, east, down (m), roll, pitch, yaw (rad) at increasing times time_us (K,).

    `source` names where they come from, for messages.
    """

    time_us: NDArray[np.int64]
    covariance: Floats
    source: str = "navigation"

    def median_sigma(self) -> Floats:
        """Median over time of the standard deviations (6,), as Table 2 prints them (there in degrees)."""
        return np.sqrt(np.median(np.diagonal(self.covariance, axis1=1, axis2=2), axis=0))


def read_covariances(path: Path, attitude_columns: Sequence[int]) -> NavigationCovariances:
    """Covariances of a file with rows of time (us) and a row-major 12x12 matrix, position in its rows 0-2.

    `attitude_columns` are the three rows and columns of roll, pitch and yaw. Raises InputError naming the row of a
    time that does not increase, or of a matrix that is not symmetric or not positive semi-definite.
    """
    time_us, numbers = read_numbers(path, 1 + _SIZE * _SIZE, "time (us) and 144 covariances")
    check_microseconds(time_us, path)
    backwards = np.flatnonzero(np.diff(time_us) <= 0)
    if backwards.size:
        row = int(backwards[0]) + 1
        raise InputError(
            f"{path}, row {row + 1}, column 1",
            f"time {time_us[row]}",
            f"a time after the row before it ({time_us[row - 1]})",
            "sort the rows by time and remove repeated ones",
        )
    keep = [0, 1, 2, *attitude_columns]
    covariance = numbers.reshape(-1, _SIZE, _SIZE)[:, keep][:, :, keep]
    for row, matrix in enumerate(covariance):
        _check_covariance(matrix, keep, f"{path}, row {row + 1}")
    return NavigationCovariances(time_us, covariance, str(path))


def _check_covariance(matrix: Floats, names: Sequence[int], place: str) -> None:
    """Check a covariance (6, 6), whose rows and columns are `names` in the file's matrix."""
    if not np.all(np.isfinite(matrix)):
        raise InputError(place, "a covariance that is no number", "36 finite numbers", "remove or mend the row")
    scale = np.sqrt(np.abs(np.diag(matrix)))
    asymmetric = np.argwhere(np.abs(matrix - matrix.T) > _ASYMMETRY * np.outer(scale, scale))
    if asymmetric.size:
        i, j = asymmetric[0]
        at, mirrored = (names[i], names[j]), (names[j], names[i])
        found = f"covariance {matrix[i, j]:g} at {at} and {matrix[j, i]:g} at {mirrored}"
        raise InputError(place, found, "a symmetric matrix", "check the column order, or remove the row")
    unit = np.where(scale > 0, scale, 1.0)
    lowest = float(np.linalg.eigvalsh(matrix / np.outer(unit, unit))[0])
    if lowest < -_NEGATIVE:
        raise InputError(
            place,
            f"a covariance whose correlations have the eigenvalue {lowest:g}",
            "a positive semi-definite matrix",
            "check navigation.covariance_columns, or remove the row",
        )


def associate_covariances(
    points: pd.DataFrame, navigation: NavigationCovariances, maximum_gap_s: float
) -> pd.DataFrame:
    """The points with the covariance of nearest time stamp, and the gap to it in `nav_gap_s` (section 3.3).

    Raises InputError naming the file, and the observation whose gap is the largest where that is too large.
    """
    time_us = points["time_us"].to_numpy()
    after = np.searchsorted(navigation.time_us, time_us).clip(1, max(len(navigation.time_us) - 1, 1))
    before = after - 1
    after = after.clip(max=len(navigation.time_us) - 1)
    nearer = np.abs(navigation.time_us[after] - time_us) < np.abs(navigation.time_us[before] - time_us)
    index = np.where(nearer, after, before)
    gap_s = np.abs(navigation.time_us[index] - time_us) / 1e6
    if gap_s.max() > maximum_gap_s:
        worst = points.iloc[int(gap_s.argmax())]
        raise InputError(
            f"{navigation.source}: observation {worst['observation']:g}, point {worst['point']:g}",
            f"the covariance nearest to its time {worst['time_us']:.0f} us {gap_s.max():.3f} s away",
            f"at most {maximum_gap_s:g} s",
            "complete the navigation log, correct the clocks, or raise navigation.maximum_gap_s",
        )
    matrices = navigation.covariance[index]
    columns = {name: matrices[:, i, j] for name, (i, j) in zip(COVARIANCE_COLUMNS, COVARIANCE_INDICES, strict=True)}
    return points.assign(**columns, nav_gap_s=gap_s)


def median_sigma_table(navigation: NavigationCovariances) -> pd.DataFrame:
    """The median sigmas as a table of one row; columns as in `NAVIGATION_SIGMA`."""
    return pd.DataFrame([navigation.median_sigma()], columns=list(SIGMA_COLUMNS))

"""The navigation system's covariances, and which of them holds for a point."""

from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd
import pyarrow as pa
from numpy.typing import NDArray

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.survey.covariance_rule import COVARIANCE_REMEDY, COVARIANCE_WORDS, first_unusable
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


def associate_covariances(
    points: pd.DataFrame, navigation: NavigationCovariances, maximum_gap_s: float
) -> pd.DataFrame:
    """The points with the covariance of nearest time stamp, and the gap to it in `nav_gap_s` (section 3.3).

    Raises InputError naming the file, and the observation whose gap is the largest where that is too large, or whose
    covariance is none.
    """
    time_us = points["time_us"].to_numpy()
    after = np.searchsorted(navigation.time_us, time_us).clip(1, max(len(navigation.time_us) - 1, 1))
    before = after - 1
    after = after.clip(max=len(navigation.time_us) - 1)
    nearer = np.abs(navigation.time_us[after] - time_us) < np.abs(navigation.time_us[before] - time_us)
    index = np.where(nearer, after, before)
    gap_s = np.abs(navigation.time_us[index] - time_us) / 1e6
    if gap_s.max() > maximum_gap_s:
        worst = int(gap_s.argmax())
        number, name = (points[column].iloc[worst] for column in ("observation", "point"))
        raise InputError(
            f"{navigation.source}: observation {number}, point {name}",
            f"the covariance nearest to its time {time_us[worst]} us {gap_s.max():.3f} s away",
            f"at most {maximum_gap_s:g} s",
            "complete the navigation log, correct the clocks, or raise navigation.maximum_gap_s",
        )
    matrices = navigation.covariance[index]
    # turned covariances are symmetric but for rounding
    unusable = first_unusable((matrices + np.swapaxes(matrices, 1, 2)) / 2)
    if unusable is not None:
        number, name = (points[column].iloc[unusable[0]] for column in ("observation", "point"))
        raise InputError(
            f"{navigation.source}: observation {number}, point {name}", unusable[1], COVARIANCE_WORDS, COVARIANCE_REMEDY
        )
    columns = {name: matrices[:, i, j] for name, (i, j) in zip(COVARIANCE_COLUMNS, COVARIANCE_INDICES, strict=True)}
    return points.assign(**columns, nav_gap_s=gap_s)


def median_sigma_table(navigation: NavigationCovariances) -> pd.DataFrame:
    """The median sigmas as a table of one row; columns as in `NAVIGATION_SIGMA`."""
    return pd.DataFrame([navigation.median_sigma()], columns=list(SIGMA_COLUMNS))

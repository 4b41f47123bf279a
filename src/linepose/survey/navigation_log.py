"""The navigation system's raw log: the body pose over time, and which pose holds for a point."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation, Slerp

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.geometry import rotations
from linepose.survey.observations import EULER_COLUMNS, POSITION_COLUMNS


@dataclass(frozen=True)
class NavigationLog:
    """Body poses: time_us (K,) increasing, position_m (K, 3) north, east, down, euler_rad (K, 3) roll, pitch, yaw.

    `source` names where they come from, and `gap_key` the key that decides whether a gap in them matters, for messages.
    """

    time_us: NDArray[np.int64]
    position_m: Floats
    euler_rad: Floats
    source: str = "navigation"
    gap_key: str = "navigation.maximum_pose_gap_s"


PoseAt = Callable[[NavigationLog, NDArray[np.int64]], tuple[Floats, Floats]]


def nearest_pose(log: NavigationLog, time_us: NDArray[np.int64]) -> tuple[Floats, Floats]:
    """Positions (P, 3) and Euler angles (P, 3) of the nearest time stamps, as the paper takes them (section 3.3)."""
    before, after = _neighbours(log, time_us)
    nearer = np.abs(log.time_us[after] - time_us) < np.abs(log.time_us[before] - time_us)
    index = np.where(nearer, after, before)
    return log.position_m[index], log.euler_rad[index]


def interpolated_pose(log: NavigationLog, time_us: NDArray[np.int64]) -> tuple[Floats, Floats]:
    """Positions (P, 3), linear between the two time stamps around, and Euler angles (P, 3), at constant turn rate."""
    before, after = _neighbours(log, time_us)
    share = (time_us - log.time_us[before]) / (log.time_us[after] - log.time_us[before])
    step = log.position_m[after] - log.position_m[before]
    needed, place = np.unique(np.concatenate([before, after]), return_inverse=True)
    keys = Rotation.from_matrix(rotations.matrix_from_euler(log.euler_rad[needed]))
    # in rows of the needed keys, because Slerp prepares every interval it is given
    at = place[: len(before)] + share * (place[len(before) :] - place[: len(before)])
    matrices = Slerp(np.arange(len(needed)), keys)(at).as_matrix()
    return log.position_m[before] + share[:, None] * step, rotations.euler_from_matrix(matrices)


POSE_AT: Final[dict[str, PoseAt]] = {"nearest": nearest_pose, "interpolate": interpolated_pose}


def _neighbours(log: NavigationLog, time_us: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Rows of the log before and after times (P,) within it."""
    after = np.searchsorted(log.time_us, time_us).clip(1, len(log.time_us) - 1)
    return after - 1, after


def associate_poses(points: pd.DataFrame, log: NavigationLog, pose_at: PoseAt, maximum_gap_s: float) -> pd.DataFrame:
    """The points with the body pose at their times: columns of position and Euler angles added.

    Raises InputError naming the log, and the observation outside it or in a gap of it longer than `maximum_gap_s`.
    """
    time_us = points["time_us"].to_numpy()
    outside = np.flatnonzero((time_us < log.time_us[0]) | (time_us > log.time_us[-1]))
    if outside.size:
        remedy = "complete the navigation log, or correct the clocks"
        expected = f"a time within the navigation log ({log.time_us[0]} to {log.time_us[-1]})"
        raise InputError(_place(log, points, outside[0]), f"time {time_us[outside[0]]}", expected, remedy)
    before, after = _neighbours(log, time_us)
    gap_s = (log.time_us[after] - log.time_us[before]) / 1e6
    if gap_s.max() > maximum_gap_s:
        worst = int(gap_s.argmax())
        raise InputError(
            _place(log, points, worst),
            f"a gap of {gap_s[worst]:.3f} s in the navigation log around its time",
            f"at most {maximum_gap_s:g} s",
            f"complete the log, leave the observation out, or raise {log.gap_key}",
        )
    position, euler = pose_at(log, time_us)
    columns = dict(zip((*POSITION_COLUMNS, *EULER_COLUMNS), np.hstack([position, euler]).T, strict=True))
    return points.assign(**columns)


def _place(log: NavigationLog, points: pd.DataFrame, row: int) -> str:
    number, name = (points[column].iloc[row] for column in ("observation", "point"))
    return f"{log.source}: observation {number}, point {name}"

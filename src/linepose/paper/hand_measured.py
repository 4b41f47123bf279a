"""The sigmas that the paper's tables print for hand-measured poses: those of Euler angles, 0.1 m and 2 deg each."""

from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from linepose.arrays import Floats
from linepose.geometry.pose import POSE_COLUMNS, SIGMA_COLUMNS, euler_pose, rotation_vector_covariance

_SIGMA_M: Final = 0.1  # section 4
_SIGMA_DEG: Final = 2.0


def hand_measured_sigma(pose: ArrayLike) -> Floats:
    """One standard deviation of each number (6,) of a hand-measured pose (6,) with a rotation vector (m, rad)."""
    covariance = np.diag(np.repeat([_SIGMA_M, np.deg2rad(_SIGMA_DEG)], 3) ** 2)
    return np.sqrt(np.diag(rotation_vector_covariance(euler_pose(pose), covariance)))


def as_printed(poses: pd.DataFrame) -> pd.DataFrame:
    """Poses by their stage, the hand-measured one's sigmas as the paper prints them; `poses` as in `POSE`."""
    table = poses.set_index("stage").copy()
    if "hand_measured" in table.index:
        pose = table.loc["hand_measured", list(POSE_COLUMNS)].to_numpy(dtype=float, copy=True)
        table.loc["hand_measured", list(SIGMA_COLUMNS)] = hand_measured_sigma(pose)
    return table

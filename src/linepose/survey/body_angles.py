"""Roll, pitch and yaw of whole observations."""

from typing import Final

import numpy as np

from linepose.arrays import Floats
from linepose.survey.observations import EULER_COLUMNS, Survey

BODY_ANGLES: Final = tuple(name.removesuffix("_rad") for name in EULER_COLUMNS)


def body_angles_rad(survey: Survey) -> Floats:
    """Mean roll, pitch, yaw of each observation over the points it has; (N, 3)."""
    return np.asarray(
        np.arctan2(np.nanmean(np.sin(survey.euler_rad), axis=1), np.nanmean(np.cos(survey.euler_rad), axis=1))
    )

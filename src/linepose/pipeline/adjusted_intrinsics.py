"""Principal point and focal length as an adjustment found them: they belong to its pose, and err together with it."""

from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd
import pyarrow as pa

from linepose.arrays import Floats
from linepose.geometry.camera import Camera
from linepose.geometry.pose import N_PARAMETERS
from linepose.tables import floats

_PAIR: Final = ("principal_point_px", "focal_length_m")
_COVARIANCE: Final = ("variance_principal_point_px2", "covariance_px_m", "variance_focal_length_m2")
_STEPS: Final = ("forward_m", "right_m", "down_m", "turn_x_rad", "turn_y_rad", "turn_z_rad")
_BY: Final = tuple(f"{step}_by_{name}" for step in _STEPS for name in _PAIR)

INTRINSICS: Final = pa.schema(floats(*_PAIR, *_COVARIANCE, *_BY))


@dataclass(frozen=True, eq=False)
class AdjustedIntrinsics:
    """Principal point (px) and focal length (m) that belong to an adjusted pose.

    `covariance` (2, 2): of the two; `pose_by_intrinsics` (6, 2): how the pose's estimate, position (m) and small turn
    about body axes (rad), follows them.
    """

    principal_point_px: float
    focal_length_m: float
    covariance: Floats
    pose_by_intrinsics: Floats

    @property
    def with_pose(self) -> Floats:
        """Covariance (6, 2) of the pose, position and small turn about body axes, with the two."""
        return self.pose_by_intrinsics @ self.covariance

    def camera(self, given: Camera) -> Camera:
        """The camera of a platform's file with these two in place of the file's."""
        return given.replaced(principal_point_px=self.principal_point_px, focal_length_m=self.focal_length_m)


def intrinsics_table(found: AdjustedIntrinsics) -> pd.DataFrame:
    """One row: the two, their covariance, and how the pose follows them; columns as in `INTRINSICS`."""
    (of_centre, of_both), (_, of_focal) = found.covariance
    values = [found.principal_point_px, found.focal_length_m, of_centre, of_both, of_focal]
    return pd.DataFrame([[*values, *found.pose_by_intrinsics.ravel()]], columns=INTRINSICS.names)


def intrinsics_from_table(table: pd.DataFrame) -> AdjustedIntrinsics:
    """What `intrinsics_table` has written."""
    row = table.iloc[0]
    of_centre, of_both, of_focal = row[list(_COVARIANCE)].to_numpy(dtype=float)
    by = row[list(_BY)].to_numpy(dtype=float).reshape(N_PARAMETERS, len(_PAIR))
    centre, focal = (float(row[name]) for name in _PAIR)
    return AdjustedIntrinsics(centre, focal, np.array([[of_centre, of_both], [of_both, of_focal]]), by)

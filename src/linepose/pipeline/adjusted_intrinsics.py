"""The intrinsics as an adjustment found them: they belong to its pose, and err together with it."""

from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd
import pyarrow as pa

from linepose.arrays import Floats
from linepose.geometry.camera import Camera
from linepose.geometry.camera_sigmas import ALWAYS_ESTIMATED
from linepose.geometry.lens import COEFFICIENTS
from linepose.tables import floats, optional_floats, texts

NAMES: Final = (*ALWAYS_ESTIMATED, *COEFFICIENTS)
IDENTIFIABLE_SHARE: Final = 0.5  # of the prior's sigma, below which the survey has told an intrinsic
_LEAST_GAIN: Final = 0.02  # of the variance, below which that of the draws of the levels hides it
_COVARIANCE: Final = tuple(f"covariance_with_{name}" for name in NAMES)
_BY: Final = tuple(
    f"{step}_by_one" for step in ("forward_m", "right_m", "down_m", "turn_x_rad", "turn_y_rad", "turn_z_rad")
)

INTRINSICS: Final = pa.schema(
    [
        *texts("parameter"),
        *floats("value", "sigma", "prior", "prior_sigma"),
        *optional_floats(*_COVARIANCE),
        *floats(*_BY),
    ]
)


@dataclass(frozen=True, eq=False)
class AdjustedIntrinsics:
    """Principal point (px), focal length (m), and estimated coefficients of the lens, that belong to an adjusted pose.

    `names` of all I; `estimate` (I,); `covariance` (I, I); `pose_by_intrinsics` (6, I): how the pose's estimate,
    position (m) and small turn about body axes (rad), follows them; `prior`, `prior_sigma` (I,): the platform's file.
    """

    names: tuple[str, ...]
    estimate: Floats
    covariance: Floats
    pose_by_intrinsics: Floats
    prior: Floats
    prior_sigma: Floats

    @property
    def with_pose(self) -> Floats:
        """Covariance (6, I) of the pose, position and small turn about body axes, with the intrinsics."""
        return self.pose_by_intrinsics @ self.covariance

    @property
    def sigma(self) -> Floats:
        """One standard deviation of each (I,)."""
        return np.sqrt(np.diag(self.covariance))

    @property
    def is_told(self) -> np.ndarray:
        """Whether the survey told each (I,): the sigma is less than `IDENTIFIABLE_SHARE` of the prior's."""
        return self.sigma < IDENTIFIABLE_SHARE * self.prior_sigma

    @property
    def moved_sigmas(self) -> Floats:
        """How far each (I,) lies from its prior, in sigmas of how far what the survey says of it lets it move.

        The estimate of a linear problem lies off the prior's mean by the difference of prior and posterior variance.
        0 where the survey says next to nothing of it.
        """
        gain = 1 - (self.sigma / self.prior_sigma) ** 2
        moved = (self.estimate - self.prior) / self.prior_sigma / np.sqrt(np.maximum(gain, _LEAST_GAIN))
        return np.where(gain < _LEAST_GAIN, 0.0, moved)

    def camera(self, given: Camera) -> Camera:
        """The camera of a platform's file with these in place of the file's."""
        return given.replaced(**dict(zip(self.names, map(float, self.estimate), strict=True)))


def intrinsics_table(found: AdjustedIntrinsics) -> pd.DataFrame:
    """A row an intrinsic, in its own unit: value, prior, covariances, how the pose follows; columns of `INTRINSICS`."""
    rows = []
    for i, name in enumerate(found.names):
        covariance = dict(zip(found.names, found.covariance[i], strict=True))
        known = [found.estimate[i], found.sigma[i], found.prior[i], found.prior_sigma[i]]
        others = [covariance.get(other, np.nan) for other in NAMES]
        rows.append([name, *known, *others, *found.pose_by_intrinsics[:, i]])
    return pd.DataFrame(rows, columns=INTRINSICS.names)


def intrinsics_from_table(table: pd.DataFrame) -> AdjustedIntrinsics:
    """What `intrinsics_table` has written."""
    names = tuple(str(name) for name in table["parameter"])
    covariance = table[[f"covariance_with_{name}" for name in names]].to_numpy(dtype=float)
    return AdjustedIntrinsics(
        names,
        table["value"].to_numpy(dtype=float),
        covariance,
        table[list(_BY)].to_numpy(dtype=float).T,
        table["prior"].to_numpy(dtype=float),
        table["prior_sigma"].to_numpy(dtype=float),
    )

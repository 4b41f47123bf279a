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
from linepose.pipeline.checks import CAMERA_SIGMAS
from linepose.tables import floats, optional_floats, texts

NAMES: Final = (*ALWAYS_ESTIMATED, *COEFFICIENTS)
IDENTIFIABLE_SHARE: Final = 0.5  # of the prior's sigma, below which the survey has told an intrinsic
_TELLING_GAIN: Final = 0.02  # of the prior's variance, from which on its sigma alone makes a test
_LEAST_GAIN: Final = 1e-12  # of the prior's variance, below which rounding hides it
_LARGEST_ERROR: Final = {"principal_point_px": 500.0} | dict.fromkeys(COEFFICIENTS, 1.0)  # that data sheets have, ...
_LARGEST_SHARE: Final = 0.5  # ... and of the focal length such a share
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
    def survey_sigma(self) -> Floats:
        """One standard deviation of each (I,) by all but its own prior; at least this where rounding hides it."""
        gain = self._gain
        return self.prior_sigma * np.sqrt((1 - gain) / gain)

    @property
    def moved_sigmas(self) -> Floats:
        """How far what all else says of each (I,) lies from its prior, in sigmas of both together; see `is_tested`.

        The estimate is the mean of the two by their information: it lies off its prior by the gain times their
        difference, whose variance is the prior's divided by the gain. NaN where the sigmas are not known. Where
        conjugate gradients solve for many points, up to a fifth is lost of priors a thousand times tighter than the
        survey.
        """
        return (self.estimate - self.prior) / (self.prior_sigma * np.sqrt(self._gain))

    @property
    def is_tested(self) -> np.ndarray:
        """Whether the survey could contradict each prior (I,): by its sigma, or an error such as data sheets have."""
        return self._could_tell & ~self._is_hidden

    @property
    def is_held(self) -> np.ndarray:
        """Whether each prior (I,) is so tight that what a survey says of it, be it much, cannot be computed."""
        return self._could_tell & self._is_hidden

    @property
    def _could_tell(self) -> np.ndarray:
        largest = _LARGEST_ERROR | {"focal_length_m": _LARGEST_SHARE * self.prior[self.names.index("focal_length_m")]}
        error = np.array([largest[name] for name in self.names])
        return np.asarray((self._gain >= _TELLING_GAIN) | (CAMERA_SIGMAS * self.survey_sigma < error))

    @property
    def _is_hidden(self) -> np.ndarray:
        """Whether rounding hides what the survey says of each (I,)."""
        return self._gain <= _LEAST_GAIN

    @property
    def _gain(self) -> Floats:
        """The share of each prior's variance (I,) that the survey has taken; not below what rounding leaves of it."""
        return np.maximum(1 - (self.sigma / self.prior_sigma) ** 2, _LEAST_GAIN)

    def camera(self, given: Camera) -> Camera:
        """The camera of a platform's file with these in place of the file's."""
        return given.replaced(**dict(zip(self.names, map(float, self.estimate), strict=True)))


def farthest(found: AdjustedIntrinsics) -> tuple[str, float | None]:
    """The tested intrinsic that lies farthest from its prior, and how many sigmas; NaN where its sigma is not known.

    No name, and None, where the survey tests none.
    """
    moved = np.abs(found.moved_sigmas)
    if np.any(unknown := np.isnan(moved)):
        return found.names[int(np.argmax(unknown))], float("nan")
    if not np.any(found.is_tested):
        return "", None
    most = int(np.argmax(np.where(found.is_tested, moved, -1.0)))
    return found.names[most], float(moved[most])


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

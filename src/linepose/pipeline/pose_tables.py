"""The pose as people ask for it: rotation vector and Euler angles, beside the hand measurement."""

import math
import warnings
from dataclasses import dataclass

import numpy as np

from linepose.adjustment.thresholds import OPEN_SHARE
from linepose.arrays import Floats
from linepose.geometry.pose import euler_covariance, euler_pose
from linepose.geometry.pose_with_covariance import PoseWithCovariance

_POSITION = ("r_x forward", "r_y right", "r_z down")
_DEGREES = "°"
_GIMBAL_DEG = 89.0


@dataclass(frozen=True)
class PoseNumber:
    """One number of the pose in its unit: estimate, hand measurement, the sigma of each, and the truth if known.

    hand_counts: whether the hand measurement is a prior that the estimate and its sigma have counted in.
    """

    name: str
    unit: str
    estimate: float
    sigma: float
    hand: float
    hand_sigma: float
    truth: float | None = None
    hand_counts: bool = False

    @property
    def difference(self) -> float:
        """Estimate minus hand measurement."""
        return self._from(self.hand)

    @property
    def difference_sigmas(self) -> float:
        """The difference in sigmas of the difference.

        Where the hand measurement counts, as far as the data alone lie from it; in its own sigmas where they say
        nothing of this number.
        """
        if not self.hand_counts:
            return self.difference / float(np.hypot(self.sigma, self.hand_sigma))
        is_open = self.sigma > OPEN_SHARE * self.hand_sigma
        return self.difference / (self.hand_sigma if is_open else math.sqrt(self.hand_sigma**2 - self.sigma**2))

    @property
    def error_sigmas(self) -> float | None:
        """Estimate minus truth in sigmas of the estimate."""
        return None if self.truth is None else self._from(self.truth) / self.sigma

    def _from(self, value: float) -> float:
        """Estimate minus a value, of angles in degrees the short way round."""
        difference = self.estimate - value
        return math.remainder(difference, 360.0) if self.unit == _DEGREES else difference


def rotation_vector_numbers(
    estimate: PoseWithCovariance, hand: PoseWithCovariance, truth: Floats | None = None, hand_counts: bool = False
) -> list[PoseNumber]:
    """The six parameters, m and rad."""
    names = [*_POSITION, "theta e_x", "theta e_y", "theta e_z"]
    return _numbers(names, ["m"] * 3 + ["rad"] * 3, estimate, hand, truth, hand_counts)


def euler_numbers(
    estimate: PoseWithCovariance, hand: PoseWithCovariance, truth: Floats | None = None, hand_counts: bool = False
) -> list[PoseNumber]:
    """Roll, pitch, yaw (zyx intrinsic) in degrees; none where the pitch is too near 90 deg to tell them apart."""
    poses = [estimate.pose, hand.pose] + ([] if truth is None else [truth])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # of angles that cannot be told apart: they are left out
        if any(abs(np.degrees(euler_pose(pose)[4])) > _GIMBAL_DEG for pose in poses):
            return []
    scale = np.diag([1.0] * 3 + [float(np.degrees(1.0))] * 3)
    in_euler = [
        PoseWithCovariance(scale @ euler_pose(one.pose), scale @ euler_covariance(one.pose, one.covariance) @ scale)
        for one in (estimate, hand)
    ]
    numbers = _numbers(
        [*_POSITION, "roll", "pitch", "yaw"],
        ["m"] * 3 + [_DEGREES] * 3,
        in_euler[0],
        in_euler[1],
        None if truth is None else scale @ euler_pose(truth),
        hand_counts,
    )
    return numbers[3:]


def _numbers(
    names: list[str],
    units: list[str],
    estimate: PoseWithCovariance,
    hand: PoseWithCovariance,
    truth: Floats | None,
    hand_counts: bool,
) -> list[PoseNumber]:
    sigma, hand_sigma = (np.sqrt(np.diag(one.covariance)) for one in (estimate, hand))
    return [
        PoseNumber(
            names[k],
            units[k],
            float(estimate.pose[k]),
            float(sigma[k]),
            float(hand.pose[k]),
            float(hand_sigma[k]),
            None if truth is None else float(truth[k]),
            hand_counts,
        )
        for k in range(len(names))
    ]

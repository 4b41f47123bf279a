"""The camera's pose on the vehicle as read from a tape measure: the start of the search, or a prior."""

import numpy as np
from pydantic import Field, PositiveFloat

from linepose.arrays import Floats
from linepose.geometry.pose import rotation_vector_pose
from linepose.geometry.rotations import left_jacobian_so3
from linepose.settings import Settings

Triple = tuple[float, float, float]


class HandMeasured(Settings):
    """The camera in the body frame by tape measure: forward, right, down (m); roll, pitch, yaw, zyx intrinsic (deg).

    The sigmas are one standard deviation of each coordinate (m), and of the turn about each of the body's axes (deg):
    those of Euler angles would claim far too much near a pitch of a right angle.

    Examples
    --------
    >>> import linepose
    >>> by_hand = linepose.HandMeasured(position_m=(0.2, 0.0, -0.8), euler_deg=(0.0, 0.0, -90.0))
    >>> by_hand.pose.round(3).tolist()
    [0.2, 0.0, -0.8, 0.0, 0.0, -1.571]
    """

    position_m: Triple = Field(description="Camera in the body frame: forward, right, down (m).")
    euler_deg: Triple = Field(description="Camera to body: roll, pitch, yaw, zyx intrinsic (deg).")
    sigma_position_m: PositiveFloat = Field(
        0.1, ge=1e-6, le=1e6, description="One standard deviation of each coordinate (m)."
    )
    sigma_rotation_deg: PositiveFloat = Field(
        2.0, ge=1e-6, le=1e6, description="One standard deviation of the turn about each of the body's axes (deg)."
    )

    @property
    def pose(self) -> Floats:
        """The pose (6,) with a rotation vector, m and rad."""
        return rotation_vector_pose(self._euler_pose())

    @property
    def covariance(self) -> Floats:
        """Covariance (6, 6) of the pose with a rotation vector, to first order."""
        by_turn = np.eye(6)
        by_turn[3:, 3:] = np.linalg.inv(left_jacobian_so3(self.pose[3:]))
        return by_turn @ self.body_covariance @ by_turn.T

    @property
    def body_covariance(self) -> Floats:
        """Covariance (6, 6) of position (m) and of small turns about the body's axes (rad)."""
        return np.diag(np.repeat([self.sigma_position_m, np.deg2rad(self.sigma_rotation_deg)], 3) ** 2)

    def _euler_pose(self) -> Floats:
        return np.concatenate([self.position_m, np.deg2rad(self.euler_deg)])

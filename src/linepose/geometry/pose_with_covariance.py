"""A pose and how sure it is, in the body axes that its reader uses."""

from dataclasses import dataclass
from typing import Final, Literal

import numpy as np
from scipy.spatial.transform import RigidTransform, Rotation

from linepose.arrays import Floats
from linepose.geometry.rotations import (
    left_jacobian_so3,
    matrix_from_rotation_vector,
    rotation_vector_from_matrix,
)

BodyAxes = Literal["frd", "flu"]

_TO_FLU: Final = np.diag([1.0, -1.0, -1.0])


@dataclass(frozen=True, eq=False)
class PoseWithCovariance:
    """Pose (6,), position and rotation vector, camera to body (m, rad), and its covariance (6, 6).

    `body_axes`: "frd" forward, right, down, or "flu" forward, left, up.
    """

    pose: Floats
    covariance: Floats
    body_axes: BodyAxes = "frd"

    @property
    def sigma(self) -> Floats:
        """One standard deviation of each number of the pose (6,)."""
        return np.sqrt(np.diag(self.covariance))

    @property
    def matrix(self) -> Floats:
        """Homogeneous transform (4, 4) that takes points of the camera frame to the body frame (m)."""
        return np.asarray(self._transform().as_matrix())

    @property
    def inverse_matrix(self) -> Floats:
        """Homogeneous transform (4, 4) that takes points of the body frame to the camera frame (m)."""
        return np.asarray(self._transform().inv().as_matrix())

    def _transform(self) -> RigidTransform:
        return RigidTransform.from_components(self.pose[:3], Rotation.from_rotvec(self.pose[3:]))

    @property
    def quaternion_wxyz(self) -> Floats:
        """Unit quaternion (w, x, y, z) of the rotation, camera to body, w not negative; (4,)."""
        return np.asarray(Rotation.from_rotvec(self.pose[3:]).as_quat(canonical=True, scalar_first=True))

    def in_axes(self, axes: BodyAxes) -> "PoseWithCovariance":
        """The same pose in a body frame with these axes and the same origin; the camera's axes stay.

        The rotation vector's covariance goes through the small rotation in body axes, to first order.
        """
        if axes == self.body_axes:
            return self
        rotation = matrix_from_rotation_vector(self.pose[3:])
        vector = rotation_vector_from_matrix(_TO_FLU @ rotation)
        before, after = (left_jacobian_so3(v) for v in (self.pose[3:], vector))
        jacobian = np.zeros((6, 6))
        jacobian[:3, :3] = _TO_FLU
        jacobian[3:, 3:] = np.linalg.solve(after, _TO_FLU @ before)
        pose = np.concatenate([_TO_FLU @ self.pose[:3], vector])
        return PoseWithCovariance(pose, jacobian @ self.covariance @ jacobian.T, axes)

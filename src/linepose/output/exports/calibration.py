"""A finished calibration as the exports of a pose need it: one stage's pose and covariance, in the wanted body axes."""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

import numpy as np
from scipy.spatial.transform import Rotation

from linepose.arrays import Floats
from linepose.config.platform import Platform
from linepose.errors import InputError
from linepose.geometry.pose import POSE_COLUMNS
from linepose.geometry.rotations import (
    left_jacobian_so3,
    matrix_from_rotation_vector,
    rotation_vector_from_matrix,
)
from linepose.output.exports.options import BodyAxes
from linepose.pipeline.stages import POSE, SAMPLES
from linepose.tables import read_table

HAND_MEASURED: Final = "hand_measured"
_TO_FLU: Final = np.diag([1.0, -1.0, -1.0])


@dataclass(frozen=True)
class Calibration:
    """Pose (6,) with a rotation vector, camera to body, and its covariance (6, 6), m and rad, in axes `body_axes`.

    `covariance_from` says what the covariance rests on.
    """

    platform: str
    stage: str
    pose: Floats
    covariance: Floats
    covariance_from: str
    n_observations: int
    noise_model: str
    body_axes: BodyAxes = "frd"

    def matrix(self) -> Floats:
        """Camera coordinates to body coordinates, homogeneous (4, 4)."""
        transform = np.eye(4)
        transform[:3, :3] = matrix_from_rotation_vector(self.pose[3:])
        transform[:3, 3] = self.pose[:3]
        return transform

    def inverse_matrix(self) -> Floats:
        """Body coordinates to camera coordinates, homogeneous (4, 4)."""
        inverse = np.eye(4)
        inverse[:3, :3] = matrix_from_rotation_vector(self.pose[3:]).T
        inverse[:3, 3] = -inverse[:3, :3] @ self.pose[:3]
        return inverse

    def quaternion(self) -> Floats:
        """Unit quaternion (w, x, y, z) of the rotation, camera to body, w not negative; (4,)."""
        return np.asarray(Rotation.from_rotvec(self.pose[3:]).as_quat(canonical=True, scalar_first=True))

    def sigma(self) -> Floats:
        """One standard deviation of each number of the pose (6,)."""
        return np.sqrt(np.diag(self.covariance))

    def in_axes(self, axes: BodyAxes) -> "Calibration":
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
        return replace(self, pose=pose, covariance=jacobian @ self.covariance @ jacobian.T, body_axes=axes)


def read_calibration(results: Path, platform: Platform, name: str, stage: str) -> Calibration:
    """The pose of a stage (`inliers`, `all`, `hand_measured`, ...) below results/NAME, its covariance from the samples.

    Raises InputError where the platform has not been run, or has no such stage.
    """
    poses = read_table(finished(results / name / "pose.parquet", name), POSE).set_index("stage")
    if stage not in poses.index:
        raise InputError(f"stage of {name}", repr(stage), f"one of {', '.join(poses.index)}", "name one of them")
    row = poses.loc[stage]
    if stage == HAND_MEASURED:
        covariance, covariance_from = platform.start_covariance(), "sigmas of the hand measurement"
    else:
        samples = read_table(finished(results / name / "mcmc" / f"{stage}.parquet", name), SAMPLES)
        covariance, covariance_from = np.cov(samples[list(POSE_COLUMNS)].to_numpy().T), f"{len(samples)} samples"
    return Calibration(
        platform=name,
        stage=stage,
        pose=np.array(row[list(POSE_COLUMNS)], dtype=float),
        covariance=covariance,
        covariance_from=covariance_from,
        n_observations=int(row["n_observations"]),
        noise_model=platform.noise_model,
    )


def finished(path: Path, name: str) -> Path:
    """A result of a platform; raises InputError that says what to run where it is missing."""
    if not path.is_file():
        raise InputError(str(path), "no such result", "a finished calibration", f"run `linepose run {name}` first")
    return path

"""What the doctor looks at: the observations, the camera and the hand-measured pose, and how to change them."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from linepose.arrays import Floats
from linepose.geometry import rotations
from linepose.geometry.camera import Camera
from linepose.survey.observations import Survey


@dataclass(frozen=True)
class Recording:
    """A survey, the camera that made it, and the camera's hand-measured pose (6,) with a rotation vector."""

    survey: Survey
    camera: Camera
    pose: Floats


Change = Callable[[Recording], Recording]
_AXES = range(3)


def unchanged(recording: Recording) -> Recording:
    """The recording as it was given."""
    return recording


def mapped_positions(matrix: ArrayLike) -> Change:
    """A change of all positions to `matrix @ position`, (3, 3), their covariance with them."""
    return _mapped_navigation(np.asarray(matrix, dtype=float), np.eye(3), np.zeros(3))


def mapped_angles(matrix: ArrayLike, offset_rad: ArrayLike = (0.0, 0.0, 0.0)) -> Change:
    """A change of roll, pitch, yaw to `matrix @ angles + offset`, (3, 3) and (3,), their covariance with them."""
    return _mapped_navigation(np.eye(3), np.asarray(matrix, dtype=float), np.asarray(offset_rad, dtype=float))


def scaled_angles(factor: float) -> Change:
    """A change of unit of roll, pitch, yaw; the reported covariance, which comes from elsewhere, stays."""

    def change(recording: Recording) -> Recording:
        survey = recording.survey
        return replace(recording, survey=replace(survey, euler_rad=factor * survey.euler_rad))

    return change


def _mapped_navigation(position: Floats, angles: Floats, offset_rad: Floats) -> Change:
    both = np.zeros((6, 6))
    both[:3, :3], both[3:, 3:] = position, angles

    def change(recording: Recording) -> Recording:
        survey = recording.survey
        changed = replace(
            survey,
            position_m=survey.position_m @ position.T,
            euler_rad=survey.euler_rad @ angles.T + offset_rad,
            covariance=both @ survey.covariance @ both.T,
        )
        return replace(recording, survey=changed)

    return change


def turned_bodies(turn: Callable[[Floats], Floats]) -> Change:
    """A change of the body's rotation matrices (K, 3, 3), body to world; the reported covariance stays."""

    def change(recording: Recording) -> Recording:
        survey = recording.survey
        euler = survey.euler_rad.copy()
        present = np.all(np.isfinite(euler), axis=-1)
        euler[present] = rotations.euler_from_matrix(turn(rotations.matrix_from_euler(euler[present])))
        return replace(recording, survey=replace(survey, euler_rad=euler))

    return change


def reordered_angles() -> Change:
    """A change for angles meant as x, then y, then z intrinsic, in place of z, y, x."""
    return turned_bodies(reordered)


def reordered(matrices: Floats) -> Floats:
    """`Rx(roll) Ry(pitch) Rz(yaw)` from `Rz(yaw) Ry(pitch) Rx(roll)`; (..., 3, 3) to (..., 3, 3)."""
    roll, pitch, yaw = np.moveaxis(rotations.euler_from_matrix(matrices), -1, 0)
    zero = np.zeros_like(roll)
    single = [np.stack(angles, axis=-1) for angles in ((roll, zero, zero), (zero, pitch, zero), (zero, zero, yaw))]
    about_x, about_y, about_z = (rotations.matrix_from_euler(angles) for angles in single)
    return about_x @ about_y @ about_z


def changed_pose(change: Callable[[Floats, Floats], tuple[Floats, Floats]]) -> Change:
    """A change of the hand-measured position (3,) and rotation matrix (3, 3), camera to body."""

    def changed(recording: Recording) -> Recording:
        matrix = rotations.matrix_from_rotation_vector(recording.pose[3:])
        position, turned = change(recording.pose[:3], matrix)
        return replace(recording, pose=np.concatenate([position, rotations.rotation_vector_from_matrix(turned)]))

    return changed


def flipped_scan_line(recording: Recording) -> Recording:
    """The pixels counted from the other end of the line."""
    survey = recording.survey
    return replace(recording, survey=replace(survey, u_px=recording.camera.n_pixels - 1 - survey.u_px))


def in_turn(*changes: Change) -> Change:
    """Several changes, the first first."""

    def change(recording: Recording) -> Recording:
        for one in changes:
            recording = one(recording)
        return recording

    return change

"""Rotations: Euler angles, rotation vectors and matrices, and how a small change of one moves the others.

Conventions: Euler angles are (roll, pitch, yaw) in rad, zyx intrinsic, `R = Rz(yaw) Ry(pitch) Rx(roll)`;
a rotation vector is the angle (rad) times the unit axis. Small rotations are taken on the left,
`R' = exp(small) R`, so they are expressed in the frame that R maps into.
"""

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation

from linepose.arrays import Floats

_SMALL_ANGLE_RAD = 1e-3  # below this the series is exact to double precision and the quotients are not


def skew(vectors: ArrayLike) -> Floats:
    """Cross-product matrices, `skew(a) @ b == cross(a, b)`; (..., 3) to (..., 3, 3)."""
    v = np.asarray(vectors, dtype=float)
    matrices = np.zeros((*v.shape, 3))
    matrices[..., 2, 1], matrices[..., 0, 2], matrices[..., 1, 0] = v[..., 0], v[..., 1], v[..., 2]
    return matrices - np.swapaxes(matrices, -1, -2)


def matrix_from_euler(euler_rad: ArrayLike) -> Floats:
    """Rotation matrices of Euler angles (roll, pitch, yaw); (..., 3) to (..., 3, 3)."""
    euler = np.asarray(euler_rad, dtype=float)
    return Rotation.from_euler("ZYX", euler[..., ::-1]).as_matrix()


def euler_from_matrix(matrices: ArrayLike) -> Floats:
    """Euler angles (roll, pitch, yaw) of rotation matrices, pitch within +-pi/2; (..., 3, 3) to (..., 3)."""
    return Rotation.from_matrix(np.asarray(matrices, dtype=float)).as_euler("ZYX")[..., ::-1].copy()


def matrix_from_rotation_vector(rotation_vector_rad: ArrayLike) -> Floats:
    """Rotation matrices of rotation vectors; (..., 3) to (..., 3, 3)."""
    return Rotation.from_rotvec(np.asarray(rotation_vector_rad, dtype=float)).as_matrix()


def rotation_vector_from_matrix(matrices: ArrayLike) -> Floats:
    """Rotation vectors, at most pi long, of rotation matrices; (..., 3, 3) to (..., 3)."""
    return Rotation.from_matrix(np.asarray(matrices, dtype=float)).as_rotvec()


def rotation_vector_from_euler(euler_rad: ArrayLike) -> Floats:
    """Rotation vectors of Euler angles (roll, pitch, yaw); (..., 3) to (..., 3)."""
    return rotation_vector_from_matrix(matrix_from_euler(euler_rad))


def euler_from_rotation_vector(rotation_vector_rad: ArrayLike) -> Floats:
    """Euler angles (roll, pitch, yaw) of rotation vectors; (..., 3) to (..., 3)."""
    return euler_from_matrix(matrix_from_rotation_vector(rotation_vector_rad))


def rotation_angle_rad(first: ArrayLike, second: ArrayLike) -> Floats:
    """Geodesic angle between two rotations given as matrices; (..., 3, 3) each to (...)."""
    a, b = np.asarray(first, dtype=float), np.asarray(second, dtype=float)
    difference = np.swapaxes(a, -1, -2) @ b
    return np.asarray(np.linalg.norm(rotation_vector_from_matrix(difference), axis=-1))


def left_jacobian_so3(rotation_vector_rad: ArrayLike) -> Floats:
    """Left Jacobian of SO(3): the small rotation that a change of the rotation vector causes; (..., 3) to (..., 3, 3).

    `exp(v + dv) = exp(J(v) dv) exp(v)` to first order.
    """
    v = np.asarray(rotation_vector_rad, dtype=float)
    squared = np.sum(v * v, axis=-1)[..., None, None]
    small = squared < _SMALL_ANGLE_RAD**2
    safe = np.where(small, 1.0, squared)
    angle = np.sqrt(safe)
    first = np.where(small, 0.5 - squared / 24, (1 - np.cos(angle)) / safe)
    second = np.where(small, 1 / 6 - squared / 120, (angle - np.sin(angle)) / (safe * angle))
    k = skew(v)
    return np.eye(3) + first * k + second * (k @ k)


def small_rotation_by_euler(euler_rad: ArrayLike) -> Floats:
    """The small rotation that a change of (roll, pitch, yaw) causes, in the outer frame; (..., 3) to (..., 3, 3).

    Columns are the instantaneous axes of roll, pitch and yaw.
    """
    euler = np.asarray(euler_rad, dtype=float)
    pitch, yaw = euler[..., 1], euler[..., 2]
    zero, one = np.zeros_like(pitch), np.ones_like(pitch)
    roll_axis = np.stack([np.cos(yaw) * np.cos(pitch), np.sin(yaw) * np.cos(pitch), -np.sin(pitch)], axis=-1)
    pitch_axis = np.stack([-np.sin(yaw), np.cos(yaw), zero], axis=-1)
    yaw_axis = np.stack([zero, zero, one], axis=-1)
    return np.stack([roll_axis, pitch_axis, yaw_axis], axis=-1)


def rotation_vector_by_euler(euler_rad: ArrayLike) -> Floats:
    """Jacobian of the rotation vector by (roll, pitch, yaw); (..., 3) to (..., 3, 3)."""
    vector = rotation_vector_from_euler(euler_rad)
    by_vector, by_euler = left_jacobian_so3(vector), small_rotation_by_euler(euler_rad)
    return np.asarray(np.linalg.solve(by_vector, by_euler), dtype=float)


def euler_by_rotation_vector(rotation_vector_rad: ArrayLike) -> Floats:
    """Jacobian of (roll, pitch, yaw) by the rotation vector, singular at pitch = +-pi/2; (..., 3) to (..., 3, 3)."""
    euler = euler_from_rotation_vector(rotation_vector_rad)
    by_euler, by_vector = small_rotation_by_euler(euler), left_jacobian_so3(rotation_vector_rad)
    return np.asarray(np.linalg.solve(by_euler, by_vector), dtype=float)

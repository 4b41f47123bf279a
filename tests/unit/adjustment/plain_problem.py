"""The adjustment at fixed levels as any least-squares program takes it: residuals of sigma one and their derivatives.

Unknown are a camera of eight numbers (position, rotation vector on the left of the start's rotation, principal point,
focal length), points, and standard normal errors: z of each measurement, q of each view, and for each measurement six
white ones and its lateness.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.sparse import csr_matrix

from linepose.adjustment.linearise import Optics, empty_linearised, linearise
from linepose.adjustment.process import ACROSS_FLOOR_PX
from linepose.geometry import rotations

N_CAMERA, N_OWN = 8, 7


@dataclass(frozen=True)
class PlainProblem:
    """L measurements of K points in N views, what is known of the camera, levels, and a start."""

    measurements: object
    knowledge: object
    levels: object
    start: object

    @property
    def blocks(self):
        """Start of every kind's unknowns, and their size."""
        m = self.measurements
        sizes = [(1, N_CAMERA), (m.n_points, 3), (len(m.u_px), 6), (m.n_views, 6), (len(m.u_px), N_OWN)]
        starts = np.concatenate([[0], np.cumsum([count * size for count, size in sizes])])
        return [slice(a, b) for a, b in pairwise(starts)], [size for _, size in sizes]

    def first(self):
        """Unknowns (D,) at the start, as arrays of each kind."""
        m = self.measurements
        n = len(m.u_px)
        return [
            np.zeros((1, 8)),
            self.start.points_m.copy(),
            np.zeros((n, 6)),
            np.zeros((m.n_views, 6)),
            np.zeros((n, 7)),
        ]

    def rotation(self, camera):
        """Rotation (3, 3) of the camera in the body."""
        return rotations.matrix_from_rotation_vector(camera[3:6]) @ self.start.rotation

    def measurement(self, line, camera, point, z, q, own):
        """Residual (2,) of a measurement, and its derivatives by camera, point, z, q and its own errors."""
        m, levels, start = self.measurements, self.levels, self.start
        scale = np.array([1, 1, 1, *[levels.attitude] * 3])[:, None]
        root = scale * m.structure.root[line]
        motion = levels.lateness * m.structure.motion[line]
        correction = root @ (levels.drift * z + levels.constant * q + levels.white * own[:6]) + motion * own[6]
        file = self.knowledge.camera
        optics = Optics(
            start.position_m + camera[:3],
            self.rotation(camera),
            float(start.principal_point_px + camera[6]),
            float(start.focal_length_m + camera[7]),
            file.pixel_pitch_m,
            file.lens,
            np.empty(0, dtype=np.int64),
        )
        out = empty_linearised(1)
        body = (m.body_pose[line] + correction)[None]
        linearise(
            m.u_px[line : line + 1],
            body,
            np.zeros((1, 6)),
            np.zeros(1, dtype=int),
            point[None],
            np.zeros(1),
            optics,
            out,
        )
        pixel = np.array([levels.pixel * file.sigmas.u_px, ACROSS_FLOOR_PX])[:, None]
        by_camera = -out.by_theta[0, :, :8] / pixel
        by_camera[:, 3:6] = by_camera[:, 3:6] @ rotations.left_jacobian_so3(camera[3:6])
        by_body = -out.by_body[0] / pixel
        by_root = by_body @ root
        by_own = np.column_stack([levels.white * by_root, by_body @ motion])
        return (out.residual_px[0] / pixel[:, 0]), [
            by_camera,
            -out.by_point[0] / pixel,
            levels.drift * by_root,
            levels.constant * by_root,
            by_own,
        ]

    def prior(self, camera):
        """Residuals (8,) of hand measurement and intrinsics, and their derivative (8, 8) by the camera."""
        hand, file, start = self.knowledge.hand, self.knowledge.camera, self.start
        whitening = np.linalg.inv(np.linalg.cholesky(hand.covariance))
        turn = rotations.rotation_vector_from_matrix(
            rotations.matrix_from_rotation_vector(hand.pose[3:]) @ self.rotation(camera).T
        )
        off = np.concatenate([hand.pose[:3] - start.position_m - camera[:3], turn])
        by_pose = -np.eye(6)
        by_pose[3:, 3:] = -np.linalg.inv(rotations.left_jacobian_so3(-turn)) @ rotations.left_jacobian_so3(camera[3:6])
        sigma = np.array([file.sigmas.principal_point_px, file.sigmas.focal_length_m])
        found = np.array([start.principal_point_px, start.focal_length_m]) + camera[6:]
        derivative = np.zeros((8, 8))
        derivative[:6, :6] = whitening @ by_pose
        derivative[6:, 6:] = np.diag(1 / sigma)
        expected = np.array([file.principal_point_px, file.focal_length_m])
        return np.concatenate([whitening @ off, (found - expected) / sigma]), derivative

    def decay(self, line):
        """Share of z that is left since the measurement before, and the root of what is new."""
        share = np.exp(-self.measurements.structure.gap_s[line] / self.levels.correlation_time_s)
        return share, np.sqrt(1 - share**2)

    def residuals(self, x):
        """All residuals (R,) and their Jacobian (R, D), sparse, of unknowns (D,)."""
        m, (where, sizes) = self.measurements, self.blocks
        camera, points, z, q, own = (x[one].reshape(-1, size) for one, size in zip(where, sizes, strict=True))
        values, rows, columns, entries, n = [], [], [], [], 0

        def add(residual, parts):
            nonlocal n
            values.append(residual)
            for kind, index, derivative in parts:
                first = where[kind].start + index * sizes[kind]
                r, c = np.meshgrid(np.arange(len(residual)), np.arange(derivative.shape[1]), indexing="ij")
                rows.append((n + r).ravel())
                columns.append((first + c).ravel())
                entries.append(derivative.ravel())
            n += len(residual)

        for line, (point, view) in enumerate(zip(m.point, m.view, strict=True)):
            residual, parts = self.measurement(line, camera[0], points[point], z[line], q[view], own[line])
            add(residual, list(zip(range(5), (0, point, line, view, line), parts, strict=True)))
            share, new = self.decay(line)
            before = z[line - 1] if line else np.zeros(6)
            parts = [(2, line, np.eye(6) / new)] + ([(2, line - 1, -share / new * np.eye(6))] if line else [])
            add((z[line] - share * before) / new, parts)
            add(own[line], [(4, line, np.eye(7))])
        for view in range(m.n_views):
            add(q[view], [(3, view, np.eye(6))])
        residual, derivative = self.prior(camera[0])
        add(residual, [(0, 0, derivative)])
        jacobian = csr_matrix(
            (np.concatenate(entries), (np.concatenate(rows), np.concatenate(columns))), shape=(n, len(x))
        )
        return np.concatenate(values), jacobian

    def pose(self, camera):
        """Pose (6,) of a camera (8,), with a rotation vector."""
        return np.concatenate(
            [self.start.position_m + camera[:3], rotations.rotation_vector_from_matrix(self.rotation(camera))]
        )

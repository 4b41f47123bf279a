"""The present estimate, and what is known of the camera beside the measurements."""

from dataclasses import dataclass

import numpy as np

from linepose.adjustment.hand_measured import HandMeasuredPrior
from linepose.adjustment.known_board import knowledge_of_board, moved_with_board
from linepose.adjustment.linearise import Linearised, Optics, empty_linearised, linearise
from linepose.adjustment.measurements import Measurements
from linepose.adjustment.normal import CLOCK_OFFSET, COMMON_SHIFT, N_POSE, Prior
from linepose.arrays import Floats
from linepose.geometry import rotations
from linepose.geometry.camera import Camera
from linepose.geometry.lens import COEFFICIENTS, Lens


@dataclass(frozen=True)
class State:
    """Camera, clock, points and body poses.

    position_m (3,), rotation (3, 3): of the camera in the body; principal_point_px, focal_length_m; lens, of
    which the coefficients `sought` are estimated; clock_offset_s: what is added to the scan's time stamps to get the
    navigation's time; points_m (K, 3); correction (L, 6): of the
    body poses, beside what the clock offset moves them; shifts (K,): which points follow the common shift, and
    common_shift_m: how far below its source's heights the ground is; board_m (K, 3): points in the board's own frame,
    NaN for those of no board.
    """

    position_m: Floats
    rotation: Floats
    principal_point_px: float
    focal_length_m: float
    lens: Lens
    sought: tuple[str, ...]
    clock_offset_s: float
    points_m: Floats
    correction: Floats
    shifts: Floats
    board_m: Floats
    common_shift_m: float = 0.0

    @property
    def pose(self) -> Floats:
        """The pose (6,) with a rotation vector."""
        return np.concatenate([self.position_m, rotations.rotation_vector_from_matrix(self.rotation)])

    def body_poses(self, measurements: Measurements) -> Floats:
        """Poses (L, 6) of the body as they are now taken to be."""
        return measurements.body_pose + self.clock_offset_s * measurements.rate + self.correction

    def optics(self, camera: Camera) -> Optics:
        """As the kernels take it."""
        return Optics(
            np.ascontiguousarray(self.position_m),
            np.ascontiguousarray(self.rotation),
            float(self.principal_point_px),
            float(self.focal_length_m),
            camera.pixel_pitch_m,
            self.lens,
            np.array([COEFFICIENTS.index(name) for name in self.sought], dtype=np.int64),
        )

    def moved(self, step: Floats, correction: Floats) -> "State":
        """The state after a step (3 K + 10 + C,) of all columns of the normal equations, with corrections."""
        n = self.points_m.size
        points, camera = step[:n].reshape(-1, 3), step[n:]
        pose = camera[-N_POSE:]
        of_lens = camera[2:COMMON_SHIFT]
        found = {name: getattr(self.lens, name) + float(one) for name, one in zip(self.sought, of_lens, strict=True)}
        shift_m = float(camera[COMMON_SHIFT])
        down = np.array([0.0, 0.0, 1.0])
        turn = rotations.matrix_from_rotation_vector(pose[3:])
        moved = self.points_m + points
        board = np.isfinite(self.board_m[:, 0])
        if np.any(board):
            moved[board] = moved_with_board(self.board_m[board], self.points_m[board], points[board])
        return State(
            self.position_m + pose[:3],
            turn @ self.rotation,
            self.principal_point_px + float(camera[0]),
            self.focal_length_m + float(camera[1]),
            self.lens.at(found),
            self.sought,
            self.clock_offset_s + float(camera[CLOCK_OFFSET]),
            moved + shift_m * self.shifts[:, None] * down,
            correction,
            self.shifts,
            self.board_m,
            self.common_shift_m + shift_m,
        )


def camera_step(before: State, after: State) -> Floats:
    """Step (10 + C,) of the camera's columns of the normal equations that takes one state to the other."""
    turn = rotations.rotation_vector_from_matrix(after.rotation @ before.rotation.T)
    intrinsics = _intrinsics(after) - _intrinsics(before)
    clock_s, shift_m = after.clock_offset_s - before.clock_offset_s, after.common_shift_m - before.common_shift_m
    return np.concatenate([intrinsics, [shift_m, clock_s], after.position_m - before.position_m, turn])


def _intrinsics(state: State) -> Floats:
    """Principal point (px), focal length (m), and the coefficients that are sought; (2 + C,)."""
    return np.array(
        [state.principal_point_px, state.focal_length_m, *(getattr(state.lens, name) for name in state.sought)]
    )


def state_at(pose: Floats, camera: Camera, points_m: Floats, measurements: Measurements) -> State:
    """The state at a pose (6,) and points (K, 3): intrinsics of the camera's file, no clock offset, no corrections."""
    return State(
        np.asarray(pose[:3], dtype=float),
        rotations.matrix_from_rotation_vector(pose[3:]),
        camera.principal_point_px,
        camera.focal_length_m,
        camera.lens,
        camera.uncertain_coefficients,
        0.0,
        points_m,
        np.zeros((len(measurements.u_px), 6)),
        measurements.known.shifts,
        measurements.known.board_m,
    )


@dataclass(frozen=True)
class Knowledge:
    """The camera as its file has it, the hand-measured pose where it is a prior, and how far clocks may differ.

    clock_offset_sigma_s: of the clock offset's prior about zero; None where it is zero and not estimated.
    """

    camera: Camera
    hand: HandMeasuredPrior | None
    clock_offset_sigma_s: float | None = None

    @property
    def n_sought(self) -> int:
        """How many of the last columns are sought: those of the pose, and before them the clock offset's if estimated.

        All other columns are nuisance.
        """
        return N_POSE + (self.clock_offset_sigma_s is not None)

    def rates(self, measurements: Measurements) -> Floats:
        """Rates (L, 6) of the bodies along which the clock offset moves them; zero where it is not estimated."""
        return measurements.rate if self.clock_offset_sigma_s is not None else np.zeros_like(measurements.rate)

    def prior(self, state: State, measurements: Measurements) -> Prior:
        """As quadratic forms about a state."""
        names = ("principal_point_px", "focal_length_m", *state.sought)
        sigma = np.array([getattr(self.camera.sigmas, name) for name in names])
        error = np.array([getattr(self.camera, name) for name in names]) - _intrinsics(state)
        n_intrinsics, n_camera = len(names), len(names) - COMMON_SHIFT
        information, vector = np.zeros((n_camera, n_camera)), np.zeros(n_camera)
        information[:n_intrinsics, :n_intrinsics] = np.diag(sigma**-2)
        vector[:n_intrinsics] = error / sigma**2
        chi_squared = float(np.sum((error / sigma) ** 2))
        clock_sigma_s = self.clock_offset_sigma_s or 1.0
        information[CLOCK_OFFSET, CLOCK_OFFSET] = clock_sigma_s**-2
        vector[CLOCK_OFFSET] = -state.clock_offset_s / clock_sigma_s**2
        chi_squared += (state.clock_offset_s / clock_sigma_s) ** 2
        known = measurements.known
        shift_sigma_m = known.shift_sigma_m or 1.0
        information[COMMON_SHIFT, COMMON_SHIFT] = shift_sigma_m**-2
        vector[COMMON_SHIFT] = -state.common_shift_m / shift_sigma_m**2
        chi_squared += (state.common_shift_m / shift_sigma_m) ** 2
        if self.hand is not None:
            pose, pose_vector, pose_chi_squared = self.hand.information(state.position_m, state.rotation)
            information[-N_POSE:, -N_POSE:] = pose
            vector[-N_POSE:] = pose_vector
            chi_squared += pose_chi_squared
        position_m, points_information = known.at(state.points_m)
        off = position_m - state.points_m
        off[:, 2] += state.common_shift_m * known.shifts
        points_vector = np.einsum("kij,kj->ki", points_information, off)
        chi_squared += float(np.sum(off * points_vector))
        board, rows = np.zeros((0, 0)), known.on_board
        if np.any(rows):
            told = knowledge_of_board(known.board_m[rows], known.board_sigma_m, state.points_m[rows])
            board = np.zeros((off.size, off.size))
            board[np.ix_(np.repeat(rows, 3), np.repeat(rows, 3))] = told.information
            points_vector[rows] += told.vector.reshape(-1, 3)
            chi_squared += told.chi_squared
        return Prior(information, vector, points_information, points_vector, board, chi_squared)


def linearised_at(measurements: Measurements, knowledge: Knowledge, state: State) -> Linearised | None:
    """The rays' derivatives at a state; None where a point is not in front of the camera."""
    linearised = empty_linearised(len(measurements.u_px), len(state.sought))
    behind = linearise(
        measurements.u_px,
        state.body_poses(measurements),
        knowledge.rates(measurements),
        measurements.point,
        state.points_m,
        measurements.known.shifts,
        state.optics(knowledge.camera),
        linearised,
    )
    return None if behind else linearised

"""The usual mistakes with frames, signs, units and clocks, and how each is undone."""

from dataclasses import dataclass
from itertools import permutations, product
from typing import Final

import numpy as np

from linepose.arrays import Floats
from linepose.check.conventions.recording import (
    Change,
    changed_pose,
    corrected_navigation,
    flipped_scan_line,
    unchanged,
)
from linepose.geometry import rotations
from linepose.survey.navigation_corrections import CORRECTIONS, reordered

GPS_MINUS_UTC_S: Final = 18.0  # since 2017-01-01
_LEFT_UP: Final = np.diag([1.0, -1, -1])
_RIGHT_FORWARD_UP: Final = np.array([[0.0, 1, 0], [1, 0, 0], [0, 0, -1]])
_DOWN: Final = np.diag([1.0, 1, -1])


@dataclass(frozen=True)
class Mistake:
    """What may be wrong, how to undo it in the data, and in which part of the platform file it is mended.

    `corrections`: navigation.corrections that undo it, of a mistake of the log. `clock_shift_s`: what is to be added to
    the camera's time stamps. Where there is neither, `undo` changes the hand-measured pose, and perhaps the camera.
    """

    name: str
    undo: Change
    corrections: tuple[str, ...] = ()
    clock_shift_s: float = 0.0

    @property
    def n_changes(self) -> int:
        """How many mistakes were made together; the conventions of ROS are one."""
        return 1 if self.corrections == _OF_ROS else max(1, len(self.corrections))


AS_GIVEN: Final = Mistake("nothing: the data fit as they are given", unchanged)

_OF_ROS: Final = ("positions_enu", "attitude_axes")
_TOGETHER: Final = (
    ("pitch_sign", "yaw_sign"),
    ("pitch_sign", "yaw_minus_90"),
    _OF_ROS,
    ("positions_enu", "yaw_sign"),
    ("positions_enu", "yaw_mirrored"),
    ("positions_enu", "pitch_sign"),
    ("positions_enu", "pitch_sign", "yaw_sign"),
)


def usual_mistakes() -> tuple[Mistake, ...]:
    """Every mistake that is tried, the likelier ones of a kind first."""
    return (*_log(), *_hand_measurements(), *_camera(), *_clocks())


def _log() -> tuple[Mistake, ...]:
    return tuple(
        Mistake("; and ".join(CORRECTIONS[name].meaning for name in names), corrected_navigation(names), names)
        for names in (*((name,) for name in CORRECTIONS), *_TOGETHER)
    )


def _hand_measurements() -> tuple[Mistake, ...]:
    def in_body(axes: Floats) -> Change:
        return changed_pose(lambda position, matrix: (axes @ position, axes @ matrix))

    def scaled(position: Floats, matrix: Floats) -> tuple[Floats, Floats]:
        return position, rotations.matrix_from_euler(np.degrees(rotations.euler_from_matrix(matrix)))

    return (
        Mistake(
            "the hand-measured pose is in a body frame of forward, left, up where forward, right, down is expected",
            in_body(_LEFT_UP),
        ),
        Mistake(
            "the hand-measured pose is in a body frame of right, forward, up where forward, right, down is expected",
            in_body(_RIGHT_FORWARD_UP),
        ),
        Mistake(
            "the hand-measured height of the camera counts upwards where down is expected",
            changed_pose(lambda position, matrix: (_DOWN @ position, matrix)),
        ),
        Mistake("the hand-measured angles are radians where degrees are expected", changed_pose(scaled)),
        Mistake(
            "the hand-measured angles turn in the order x, y, z where z, y, x is expected",
            changed_pose(lambda position, matrix: (position, reordered(matrix))),
        ),
        Mistake(
            "the hand-measured rotation leads from body to camera where camera to body is expected",
            changed_pose(lambda position, matrix: (position, matrix.T)),
        ),
        Mistake(
            "the hand-measured pose is the body's in the camera frame where the camera's in the body is expected",
            changed_pose(lambda position, matrix: (-matrix.T @ position, matrix.T)),
        ),
    )


def _camera() -> tuple[Mistake, ...]:
    return (
        *(
            Mistake(
                f"the camera's axes are named otherwise: what is given as its x, y, z is its {_named(axes)}{more}",
                _renamed(axes),
            )
            for axes in _axis_rotations()
            for more in [" (or the scan line is flipped)" if np.array_equal(axes, np.diag([-1, -1, 1])) else ""]
        ),
        Mistake("the scan line is flipped: pixels are counted from the other end", flipped_scan_line),
    )


def _axis_rotations() -> list[Floats]:
    """The rotations that only permute axes and change their signs, but for the identity; (3, 3) each."""
    matrices = (np.diag(signs) @ np.eye(3)[list(order)] for order in permutations(range(3)) for signs in _SIGNS)
    return [matrix for matrix in matrices if np.linalg.det(matrix) > 0 and not np.array_equal(matrix, np.eye(3))]


_SIGNS: Final = tuple(product((1.0, -1.0), repeat=3))


def _renamed(axes: Floats) -> Change:
    return changed_pose(lambda position, matrix: (position, matrix @ axes))


def _named(axes: Floats) -> str:
    """Where each given axis lies, for example "y, -x, z", when the true camera's are the columns of `axes`."""
    rows = np.argmax(np.abs(axes), axis=1)
    return ", ".join(f"{'-' if axes[row, column] < 0 else ''}{'xyz'[column]}" for row, column in enumerate(rows))


def _clocks() -> tuple[Mistake, ...]:
    return (
        Mistake(
            "the camera's time stamps are UTC, the navigation's GPS time", unchanged, clock_shift_s=GPS_MINUS_UTC_S
        ),
        Mistake(
            "the camera's time stamps are GPS time, the navigation's UTC", unchanged, clock_shift_s=-GPS_MINUS_UTC_S
        ),
    )

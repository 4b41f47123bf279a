"""The usual mistakes with frames, signs, units and clocks: how each is undone, and what to write instead."""

from dataclasses import dataclass
from itertools import permutations, product
from typing import Final

import numpy as np

from linepose.arrays import Floats
from linepose.check.conventions.recording import (
    Change,
    changed_pose,
    flipped_scan_line,
    in_turn,
    mapped_angles,
    mapped_positions,
    reordered,
    reordered_angles,
    scaled_angles,
    turned_bodies,
    unchanged,
)
from linepose.geometry import rotations

GPS_MINUS_UTC_S: Final = 18.0  # since 2017-01-01
_SWAP: Final = np.array([[0.0, 1, 0], [1, 0, 0], [0, 0, 1]])
_DOWN: Final = np.diag([1.0, 1, -1])
_LEFT_UP: Final = np.diag([1.0, -1, -1])
_RIGHT_FORWARD_UP: Final = np.array([[0.0, 1, 0], [1, 0, 0], [0, 0, -1]])
_QUARTER_RAD: Final = np.pi / 2


@dataclass(frozen=True)
class Mistake:
    """What may be wrong, what to do about it, how to undo it, and by how much the camera's clock is to be moved."""

    name: str
    remedy: str
    undo: Change
    clock_shift_s: float = 0.0


AS_GIVEN: Final = Mistake("nothing: the data fit as they are given", "go on", unchanged)


def usual_mistakes() -> tuple[Mistake, ...]:
    """Every mistake that is tried, the likelier ones of a kind first."""
    return (*_positions(), *_attitudes(), *_hand_measurements(), *_camera(), *_clocks())


def _positions() -> tuple[Mistake, ...]:
    return (
        Mistake(
            "positions are east, north, up where north, east, down is expected",
            "swap north and east, and change the sign of the height (axes: enu)",
            mapped_positions(_DOWN @ _SWAP),
        ),
        Mistake("north and east are swapped", "swap the two columns", mapped_positions(_SWAP)),
        Mistake("the height counts upwards where down is expected", "change its sign", mapped_positions(_DOWN)),
    )


def _attitudes() -> tuple[Mistake, ...]:
    def sign(axis: int) -> Floats:
        matrix = np.eye(3)
        matrix[axis, axis] = -1
        return matrix

    return (
        *(
            Mistake(f"{name} has the other sign", f"change the sign of {name}: {positive}", mapped_angles(sign(axis)))
            for axis, (name, positive) in enumerate(
                (
                    ("roll", "positive where the right side goes down"),
                    ("pitch", "positive where the nose goes up"),
                    ("yaw", "positive clockwise, seen from above"),
                )
            )
        ),
        Mistake(
            "yaw counts counter-clockwise from east where clockwise from north is expected",
            "yaw = 90 deg - yaw",
            mapped_angles(sign(2), (0.0, 0.0, _QUARTER_RAD)),
        ),
        Mistake("roll and pitch are swapped", "swap the two columns", mapped_angles(_SWAP)),
        Mistake(
            "positions are east, north, up, yaw counts counter-clockwise from east and pitch has the other sign (ROS)",
            "convert the log to north, east, down and forward, right, down (axes: enu)",
            in_turn(mapped_positions(_DOWN @ _SWAP), mapped_angles(np.diag([1.0, -1, -1]), (0.0, 0.0, _QUARTER_RAD))),
        ),
        Mistake(
            "the log's angles turn in the order x, y, z where z, y, x is expected",
            "convert them to yaw, then pitch, then roll (zyx intrinsic)",
            reordered_angles(),
        ),
        Mistake(
            "the log's attitude leads from world to body where body to world is expected",
            "invert the rotations",
            turned_bodies(lambda matrices: np.swapaxes(matrices, -1, -2)),
        ),
        Mistake("the log's angles are degrees", "convert degrees to radians", scaled_angles(float(np.pi / 180))),
        Mistake(
            "the log's angles were converted to radians twice", "convert them once", scaled_angles(float(180 / np.pi))
        ),
    )


def _hand_measurements() -> tuple[Mistake, ...]:
    def in_body(axes: Floats) -> Change:
        return changed_pose(lambda position, matrix: (axes @ position, axes @ matrix))

    def scaled(position: Floats, matrix: Floats) -> tuple[Floats, Floats]:
        return position, rotations.matrix_from_euler(np.degrees(rotations.euler_from_matrix(matrix)))

    return (
        Mistake(
            "the body's axes are forward, left, up where forward, right, down is expected",
            "give the hand-measured pose and the log in one body frame, x forward, y right, z down",
            in_body(_LEFT_UP),
        ),
        Mistake(
            "the body's axes are right, forward, up where forward, right, down is expected",
            "give the hand-measured pose and the log in one body frame, x forward, y right, z down",
            in_body(_RIGHT_FORWARD_UP),
        ),
        Mistake(
            "the hand-measured height of the camera counts upwards where down is expected",
            "change the sign of the third number of hand_measured.position_m",
            changed_pose(lambda position, matrix: (_DOWN @ position, matrix)),
        ),
        Mistake(
            "the hand-measured angles are radians where degrees are expected",
            "give hand_measured.euler_deg in degrees",
            changed_pose(scaled),
        ),
        Mistake(
            "the hand-measured angles turn in the order x, y, z where z, y, x is expected",
            "convert hand_measured.euler_deg to yaw, then pitch, then roll (zyx intrinsic)",
            changed_pose(lambda position, matrix: (position, reordered(matrix))),
        ),
        Mistake(
            "the hand-measured rotation leads from body to camera where camera to body is expected",
            "invert the rotation of hand_measured.euler_deg",
            changed_pose(lambda position, matrix: (position, matrix.T)),
        ),
        Mistake(
            "the hand-measured pose is the body's in the camera frame where the camera's in the body is expected",
            "invert the hand-measured pose",
            changed_pose(lambda position, matrix: (-matrix.T @ position, matrix.T)),
        ),
    )


def _camera() -> tuple[Mistake, ...]:
    return (
        Mistake(
            "the scan line is flipped: pixels are counted from the other end",
            "u = number of pixels - 1 - u",
            flipped_scan_line,
        ),
        *(
            Mistake(
                f"the camera's axes are named otherwise: what is given as its x, y, z is its {_named(axes)}",
                "name them so that x runs along the scan line and z is the optical axis (hand_measured.euler_deg)",
                _renamed(axes),
            )
            for axes in _axis_rotations()
        ),
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
            "the camera's time stamps are UTC, the navigation's GPS time",
            f"add {GPS_MINUS_UTC_S:g} s to the camera's time stamps",
            unchanged,
            GPS_MINUS_UTC_S,
        ),
        Mistake(
            "the camera's time stamps are GPS time, the navigation's UTC",
            f"subtract {GPS_MINUS_UTC_S:g} s from the camera's time stamps",
            unchanged,
            -GPS_MINUS_UTC_S,
        ),
    )

"""Usual differences of a log's axes and angles from ours, by name, and how each is undone.

A correction is made after the reader's own: of what the reader takes for north, east, down and roll, pitch, yaw.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Annotated, Final

import numpy as np
from pydantic import AfterValidator, WithJsonSchema

from linepose.arrays import Floats
from linepose.geometry import rotations

_SWAP: Final = np.array([[0.0, 1, 0], [1, 0, 0], [0, 0, 1]])
_DOWN: Final = np.diag([1.0, 1, -1])
_RIGHT_ANGLE_RAD: Final = np.pi / 2


def _same(matrices: Floats) -> Floats:
    return matrices


@dataclass(frozen=True)
class Correction:
    """What a log has otherwise, in words, and what makes it ours.

    Positions become `position @ p`; angles first become `angles @ (roll, pitch, yaw) + offset_rad`, and then those of
    the body's rotation matrices (K, 3, 3) after `turn`. `is_own_inverse`: made twice it does nothing.
    """

    name: str
    meaning: str
    position: Floats = field(default_factory=lambda: np.eye(3))
    angles: Floats = field(default_factory=lambda: np.eye(3))
    offset_rad: tuple[float, float, float] = (0.0, 0.0, 0.0)
    turn: Callable[[Floats], Floats] = _same
    is_own_inverse: bool = True

    def of_positions(self, position_m: Floats) -> Floats:
        """Positions north, east, down (..., 3)."""
        return np.asarray(position_m @ self.position.T)

    def of_angles(self, euler_rad: Floats) -> Floats:
        """Roll, pitch, yaw (..., 3), those with an offset within half a turn; NaN stay so."""
        euler = np.asarray(euler_rad @ self.angles.T)
        if any(self.offset_rad):
            euler = (euler + np.array(self.offset_rad) + np.pi) % (2 * np.pi) - np.pi
        present = np.all(np.isfinite(euler), axis=-1)
        if self.turn is not _same and present.any():
            euler[present] = rotations.euler_from_matrix(self.turn(rotations.matrix_from_euler(euler[present])))
        return euler

    def of_covariances(self, covariance: Floats) -> Floats:
        """Covariances (..., 6, 6) of position and angles; those of angles stay at a change of their unit or order."""
        both = np.eye(6)
        both[:3, :3] = self.position
        if np.allclose(np.abs(np.linalg.det(self.angles)), 1.0):
            both[3:, 3:] = self.angles
        return np.asarray(both @ covariance @ both.T)


def transposed(matrices: Floats) -> Floats:
    """The inverse of rotation matrices (..., 3, 3)."""
    return np.swapaxes(matrices, -1, -2)


def reordered(matrices: Floats) -> Floats:
    """`Rx(roll) Ry(pitch) Rz(yaw)` from `Rz(yaw) Ry(pitch) Rx(roll)`; (..., 3, 3) to (..., 3, 3)."""
    roll, pitch, yaw = np.moveaxis(rotations.euler_from_matrix(matrices), -1, 0)
    zero = np.zeros_like(roll)
    single = [np.stack(angles, axis=-1) for angles in ((roll, zero, zero), (zero, pitch, zero), (zero, zero, yaw))]
    about_x, about_y, about_z = (rotations.matrix_from_euler(angles) for angles in single)
    return about_x @ about_y @ about_z


def _signs(*signs: float) -> Floats:
    return np.diag(np.array(signs, dtype=float))


def _yaw(offset_rad: float) -> tuple[float, float, float]:
    return (0.0, 0.0, offset_rad)


_ALL: Final = (
    Correction(
        "positions_enu", "positions are east, north, up where north, east, down is expected", position=_DOWN @ _SWAP
    ),
    Correction("north_east_swapped", "north and east are swapped", position=_SWAP),
    Correction("height_up", "the height counts upwards where down is expected", position=_DOWN),
    Correction("roll_sign", "roll has the other sign", angles=_signs(-1, 1, 1)),
    Correction("pitch_sign", "pitch has the other sign", angles=_signs(1, -1, 1)),
    Correction(
        "yaw_sign", "yaw has the other sign: counter-clockwise where clockwise is expected", angles=_signs(1, 1, -1)
    ),
    Correction(
        "yaw_mirrored",
        "yaw counts counter-clockwise from east where clockwise from north is expected, or the other way round",
        angles=_signs(1, 1, -1),
        offset_rad=_yaw(_RIGHT_ANGLE_RAD),
    ),
    Correction(
        "yaw_plus_90",
        "yaw is a quarter of a turn too small: it counts clockwise from east",
        offset_rad=_yaw(_RIGHT_ANGLE_RAD),
        is_own_inverse=False,
    ),
    Correction(
        "yaw_minus_90",
        "yaw is a quarter of a turn too large: it counts counter-clockwise from north where it is read as from east, "
        "or clockwise from west",
        offset_rad=_yaw(-_RIGHT_ANGLE_RAD),
        is_own_inverse=False,
    ),
    Correction("yaw_plus_180", "yaw counts from south", offset_rad=_yaw(np.pi)),
    Correction(
        "attitude_axes",
        "angles are of forward, left, up in east, north, up (ROS) where forward, right, down in north, east, down is "
        "expected, or the other way round",
        angles=_signs(1, -1, -1),
        offset_rad=_yaw(_RIGHT_ANGLE_RAD),
    ),
    Correction("roll_pitch_swapped", "roll and pitch are swapped", angles=_SWAP),
    Correction(
        "angles_xyz",
        "the log's angles turn in the order x, y, z where z, y, x is expected",
        turn=reordered,
        is_own_inverse=False,
    ),
    Correction(
        "world_to_body",
        "the log's attitude leads from world to body where body to world is expected",
        turn=transposed,
    ),
    Correction("degrees", "the log's angles are degrees", angles=np.eye(3) * (np.pi / 180), is_own_inverse=False),
    Correction(
        "radians_twice",
        "the log's angles were converted to radians twice",
        angles=np.eye(3) * (180 / np.pi),
        is_own_inverse=False,
    ),
)
CORRECTIONS: Final = {one.name: one for one in _ALL}
MEANINGS: Final = "; ".join(f"`{one.name}`: {one.meaning}" for one in _ALL)


def _known(name: str) -> str:
    if name not in CORRECTIONS:
        raise ValueError(f"one of {', '.join(CORRECTIONS)}")
    return name


CorrectionName = Annotated[str, AfterValidator(_known), WithJsonSchema({"type": "string", "enum": list(CORRECTIONS)})]


def with_correction(names: Sequence[str], added: Sequence[str]) -> tuple[str, ...]:
    """Names with others made after them; one that undoes the last before it takes that away."""
    found = list(names)
    for name in added:
        if found and found[-1] == name and CORRECTIONS[name].is_own_inverse:
            found.pop()
        else:
            found.append(name)
    return tuple(found)

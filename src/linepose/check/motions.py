"""What to drive next: for each motion, passes like the present ones with it, and the sigma that they would bring.

Nothing here is a rule of thumb: the added passes are replayed on the points, and the normal equations say what they
bring.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from linepose.adjustment.known_points import KnownPoints
from linepose.adjustment.prediction import predicted_covariance
from linepose.adjustment.result import Adjustment
from linepose.arrays import Floats
from linepose.check.replay import crossing
from linepose.errors import EstimationError
from linepose.geometry.camera import Camera
from linepose.survey.body_angles import body_angles_rad
from linepose.survey.observations import Survey

_ADDED: Final = 4
_TILT_RAD: Final = float(np.radians(4.0))
_PAUSE_US: Final = 60_000_000  # before the added passes
_ENOUGH_POINTS: Final = 0.5  # of those that the passes had, to be still in view
_WORTH: Final = 0.9  # of the sigma that plain repetition would bring

Move = Callable[[Survey, Floats], Survey]


@dataclass(frozen=True)
class Motion:
    """A motion in words that follow "drive four more passes", and the covariance (6, 6) with them.

    Rotations are turns about the body's axes.
    """

    words: str
    covariance: Floats


def spread_in_words(survey: Survey) -> str:
    """How roll, pitch, heading and distance differ between the observations."""
    angles = body_angles_rad(survey)
    roll, pitch = np.degrees(np.ptp(angles[:, :2], axis=0))
    headings = np.sort(np.degrees(angles[:, 2]) % 360)
    gaps = np.diff(np.append(headings, headings[0] + 360))
    return f"roll spreads over {roll:.1f} deg, pitch {pitch:.1f} deg, headings {360 - gaps.max():.0f} deg"


@dataclass(frozen=True)
class Promise:
    """What predictions rest on: camera, present adjustment, covariance (6, 6) of a prior, what is known of points."""

    camera: Camera
    adjusted: Adjustment
    hand_covariance: Floats | None
    known_points: KnownPoints | None = None

    def covariance(self, survey: Survey, point_m: Floats) -> Floats:
        """Covariance (6, 6) of a survey of points (M, 3), at the levels that the present passes have."""
        found, known = self.adjusted, self.known_points
        if known is not None and found.diagnostics.board is not None and not found.diagnostics.board.counts:
            known = known.without_board
        return predicted_covariance(survey, self.camera, found.pose, point_m, found.levels, self.hand_covariance, known)


def motions(survey: Survey, promise: Promise, point_m: Floats) -> tuple[Motion, ...]:
    """What four more passes of each kind would bring; the first is plain repetition of the present ones.

    `survey` is a replayed one of points (M, 3). A motion that takes the points out of view is left out.
    """
    rows = np.unique(np.linspace(0, survey.n_observations - 1, _ADDED).round().astype(int))
    some = _rows(survey, rows)
    found = []
    for words, move in _MOVES.items():
        moved = _seen_again(move(some, np.nanmean(point_m, axis=0)), promise.camera, promise.adjusted.pose, point_m)
        if np.isfinite(moved.u_px).sum() < _ENOUGH_POINTS * np.isfinite(some.u_px).sum():
            continue
        try:
            covariance = promise.covariance(_joined(survey, moved), point_m)
        except EstimationError:
            continue
        found.append(Motion(words, covariance))
    return tuple(found)


def best_motions(found: tuple[Motion, ...], index: int) -> list[tuple[str, float]]:
    """Motions that help one of the six numbers more than repetition does, best first, with its sigma."""
    if not found:
        return []
    sigma = {motion.words: float(np.sqrt(motion.covariance[index, index])) for motion in found}
    plain = sigma.get(_REPETITION, np.inf)
    better = [(words, value) for words, value in sigma.items() if words != _REPETITION and value < _WORTH * plain]
    return sorted(better, key=lambda pair: pair[1]) or [(_REPETITION, plain)]


def _alternating(amount: float, axis: int) -> Move:
    def move(some: Survey, _: Floats) -> Survey:
        turned = some.euler_rad.copy()
        turned[..., axis] += amount * _signs(len(turned))[:, None]
        return replace(some, euler_rad=turned)

    return move


def _from_another_side(angle_rad: float) -> Move:
    def move(some: Survey, centre: Floats) -> Survey:
        turned, position = some.euler_rad.copy(), some.position_m.copy()
        for row, angle in enumerate(angle_rad * _signs(len(turned))):
            cosine, sine = np.cos(angle), np.sin(angle)
            around = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
            position[row] = centre + (position[row] - centre) @ around.T
            turned[row, :, 2] += angle
        return replace(some, euler_rad=turned, position_m=position)

    return move


def _at_distance(factor: float) -> Move:
    def move(some: Survey, centre: Floats) -> Survey:
        position = some.position_m.copy()
        position[..., :2] = centre[:2] + factor * (position[..., :2] - centre[:2])
        return replace(some, position_m=position)

    return move


_REPETITION: Final = "like the present ones"
_MOVES: Final[dict[str, Move]] = {
    _REPETITION: lambda some, _: some,
    "with the vehicle rolled by 4 deg more, to either side in turn, the wheels of one side on a plank or in a furrow": (
        _alternating(_TILT_RAD, 0)
    ),
    "with the vehicle pitched by 4 deg more, nose up and nose down in turn, over a ramp": _alternating(_TILT_RAD, 1),
    "on paths turned about the pattern by 45 deg, left and right in turn": (
        _from_another_side(float(np.radians(45.0)))
    ),
    "at half the distance from the pattern": _at_distance(0.5),
    "at one and a half times the distance from the pattern": _at_distance(1.5),
}


def _signs(count: int) -> Floats:
    return np.where(np.arange(count) % 2 == 0, 1.0, -1.0)


def _rows(survey: Survey, rows: np.ndarray) -> Survey:
    return survey.select([int(number) for number in survey.number[rows]])


def _seen_again(moved: Survey, camera: Camera, pose: Floats, point_m: Floats) -> Survey:
    points = np.broadcast_to(point_m, moved.position_m.shape)
    at = crossing(camera, pose, moved.position_m, moved.euler_rad, points)
    seen = np.isfinite(moved.u_px) & np.isfinite(at.u_px)
    return replace(moved, position_m=at.position_m, u_px=np.where(seen, at.u_px, np.nan))


def _joined(first: Survey, second: Survey) -> Survey:
    return Survey(
        number=np.concatenate([first.number, first.number.max() + 1 + np.arange(second.n_observations)]),
        time_us=np.concatenate([first.time_us, second.time_us + _later_us(first, second)]),
        u_px=np.concatenate([first.u_px, second.u_px]),
        position_m=np.concatenate([first.position_m, second.position_m]),
        euler_rad=np.concatenate([first.euler_rad, second.euler_rad]),
        covariance=np.concatenate([first.covariance, second.covariance]),
        nav_gap_s=np.concatenate([first.nav_gap_s, second.nav_gap_s]),
        origin_m=first.origin_m,
        names=first.names,
    )


def _later_us(first: Survey, second: Survey) -> int:
    """What added passes' times are later by, so that they come after the present ones; 0 without times."""
    seen = first.time_us[np.isfinite(first.u_px)]
    if seen.max() == seen.min():
        return 0
    return int(seen.max() - second.time_us[np.isfinite(second.u_px)].min()) + _PAUSE_US

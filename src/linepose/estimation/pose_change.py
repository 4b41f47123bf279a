"""How far a pose has moved between two estimates, in sigmas, and which moves could have been seen at all.

A move is what `pose_difference` has: position (m) along body axes, then turn (rad) about them.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from linepose.arrays import Floats
from linepose.geometry.distance import p_value
from linepose.geometry.pose import N_PARAMETERS

MOVES: Final = ("forward_m", "right_m", "down_m", "turn_forward_deg", "turn_right_deg", "turn_down_deg")
PER_MOVE: Final = np.array([1.0] * 3 + [float(np.degrees(1.0))] * 3)  # from m and rad
GROUPS: Final = {"lever arm": (0, 3), "boresight": (3, 6), "all six": (0, 6)}
WHOLE: Final = "all six"
FALSE_ALARMS: Final = 0.05
POWER: Final = 0.8
SCALE: Final = np.array([0.3] * 3 + [float(np.deg2rad(5.0))] * 3)  # of moves that a recheck looks for, m and rad
_SEEN: Final = 0.1  # of the information that a sigma of the scale has, below which a direction is not seen
_ROUNDING: Final = 1e-10


@dataclass(frozen=True, eq=False)
class GroupTest:
    """A group of the move's numbers against no move: Mahalanobis distance, directions that are seen, p-value."""

    distance: float
    degrees_of_freedom: int
    p_value: float


@dataclass(frozen=True, eq=False)
class PoseChange:
    """What two estimates say of a move: its information (6, 6), and the information times the move, score (6,)."""

    information: Floats
    score: Floats

    @property
    def covariance(self) -> Floats:
        """Covariance (6, 6) of the move, m and rad; of what is not seen at all, very large."""
        values, vectors = np.linalg.eigh(self._scaled_information())
        inverse = (vectors / np.maximum(values, _ROUNDING)) @ vectors.T
        return inverse * np.outer(SCALE, SCALE)

    @property
    def move(self) -> Floats:
        """The most likely move (6,), m and rad; none along what is not seen."""
        return self.covariance @ self.score

    @property
    def sigma(self) -> Floats:
        """One standard deviation of each number of the move (6,)."""
        return np.sqrt(np.diag(self.covariance))

    def test(self, group: str) -> GroupTest:
        """Whether a group of `GROUPS` has moved, whatever the others did."""
        first, last = GROUPS[group]
        scale = SCALE[first:last]
        covariance = self.covariance[first:last, first:last] / np.outer(scale, scale)
        values, vectors = np.linalg.eigh(covariance)
        seen = values < 1 / _SEEN
        along = vectors[:, seen].T @ (self.move[first:last] / scale)
        distance = float(np.sqrt(np.sum(along**2 / values[seen])))
        count = int(np.sum(seen))
        return GroupTest(distance, count, float(p_value(distance, count)) if count else 1.0)

    def least_seen(self, false_alarms: float = FALSE_ALARMS, power: float = POWER) -> Floats:
        """The least move (6,) along or about each axis alone that the test of all six finds with this power."""
        from scipy.special import chdtri, chndtrinc

        count = self.test(WHOLE).degrees_of_freedom
        if not count:
            return np.full(N_PARAMETERS, np.inf)
        noncentrality = float(chndtrinc(chdtri(count, false_alarms), count, 1 - power))
        with np.errstate(divide="ignore"):
            return np.sqrt(noncentrality / np.maximum(np.diag(self.information), 0.0))

    def _scaled_information(self) -> Floats:
        return self.information * np.outer(SCALE, SCALE)


def in_words(move: str) -> tuple[str, str]:
    """What people read of a name of `MOVES`: the quantity, and its unit."""
    quantity, unit = move.rsplit("_", 1)
    return quantity.replace("turn_", "turn about "), unit


def change_of_estimates(difference: Floats, covariance: Floats) -> PoseChange:
    """The change from a difference (6,) of two estimates and its covariance (6, 6)."""
    information = _inverse(covariance)
    return PoseChange(information, information @ difference)


def change_of_shrunk(difference: Floats, covariance: Floats, seen: Floats) -> PoseChange:
    """The same where a prior has shrunk the second estimate, so that a move x shows as `seen` (6, 6) times x."""
    information = _inverse(covariance)
    return PoseChange(seen.T @ information @ seen, seen.T @ information @ difference)


def covariance_of_difference(covariances: Sequence[Floats], prior: Floats) -> Floats:
    """Covariance (6, 6) of the difference of two estimates with these, of which one prior (6, 6) is a part.

    Each is `S = (L + P^-1)^-1`, L the information of its data; what the prior errs by moves it by `1 - S L` times
    that, and cancels where both do so alike.
    """
    root = np.linalg.cholesky(prior)
    total, moved = np.zeros((6, 6)), np.zeros((6, 6))
    for sign, covariance in zip((1.0, -1.0), covariances, strict=True):
        scaled = root.T @ np.linalg.inv(covariance) @ root - np.eye(6)
        values, vectors = np.linalg.eigh((scaled + scaled.T) / 2)
        values = np.maximum(values, 0.0)  # draws of the posterior may be wider than the prior by chance
        own = root @ vectors
        total += (own * (values / (1 + values) ** 2)) @ own.T
        moved += sign * (own * (values / (1 + values))) @ np.linalg.solve(root.T, vectors).T
    return total + moved @ prior @ moved.T


def _inverse(covariance: Floats) -> Floats:
    """Inverse (6, 6) of a covariance, zero where it has nothing but rounding."""
    scaled = np.linalg.pinv(covariance / np.outer(SCALE, SCALE), rcond=_ROUNDING, hermitian=True)
    return scaled / np.outer(SCALE, SCALE)

"""What is known of points before any measurement: control points, heights, a terrain model, a board's own frame."""

from dataclasses import dataclass, field, replace
from typing import Final, Protocol

import numpy as np
from numpy.typing import NDArray

from linepose.adjustment.known_board import placed, spreads
from linepose.arrays import Floats
from linepose.errors import InputError

_DOWN: Final = 2
_ROUNDING: Final = 1e-9  # of the largest entry of an information
_LARGEST: Final = 1e12  # 1/m^2: of a micrometre
_RAYS: Final = 2  # that a point needs, of which nothing else is known


class Surface(Protocol):
    """The ground as a function of place."""

    def __call__(self, north_east_m: Floats) -> tuple[Floats, Floats]:
        """Down (K,) from the survey's origin (m), and its slopes by north and east (K, 2), at places (K, 2)."""
        ...


def _no_points() -> Floats:
    return np.zeros(0)


@dataclass(frozen=True)
class KnownPoints:
    """What is known of M points: position_m (M, 3) from the survey's origin, and its information (M, 3, 3).

    The information is zero of a point of which nothing is known, `diag(0, 0, 1/s^2)` of a height that is known to s,
    `I/s^2` of a control point. shifts (M,): one for points whose heights err by one amount in common, of sigma
    shift_sigma_m, else zero; without any all are zero. on_surface (M,): points that lie on a surface, known to
    surface_sigma_m, instead. board_m (M, 3): points that were measured in the frame of a board, each coordinate to
    board_sigma_m, while the board lies anywhere; NaN for any other.
    """

    position_m: Floats
    information: Floats
    shifts: Floats = field(default_factory=_no_points)
    shift_sigma_m: float | None = None
    surface: Surface | None = None
    on_surface: NDArray[np.bool_] = field(default_factory=lambda: np.zeros(0, dtype=bool))
    surface_sigma_m: float = 1.0
    board_m: Floats = field(default_factory=lambda: np.zeros((0, 3)))
    board_sigma_m: float = 1.0

    def __post_init__(self) -> None:
        """Fill in what says that there is none."""
        n = len(self.position_m)
        if len(self.shifts) != n:
            object.__setattr__(self, "shifts", np.zeros(n))
        if len(self.on_surface) != n:
            object.__setattr__(self, "on_surface", np.zeros(n, dtype=bool))
        if len(self.board_m) != n:
            object.__setattr__(self, "board_m", np.full((n, 3), np.nan))

    @property
    def any(self) -> NDArray[np.bool_]:
        """Of which points (M,) something is known."""
        return np.any(self.information != 0, axis=(1, 2)) | self.on_surface

    @property
    def apart(self) -> NDArray[np.bool_]:
        """Of which points (M,) something is known that is theirs alone, and may contradict the rest."""
        return np.any(self.information != 0, axis=(1, 2)) & ~self.on_surface & (self.shifts == 0)

    @property
    def on_board(self) -> NDArray[np.bool_]:
        """Which points (M,) were measured in the board's frame."""
        return np.isfinite(self.board_m[:, 0])

    @property
    def without_board(self) -> "KnownPoints":
        """The same without the board's geometry."""
        return replace(self, board_m=np.full(self.board_m.shape, np.nan))

    def usable(self, n_rays: NDArray[np.int64]) -> NDArray[np.bool_]:
        """Which points (M,) say something, seen by so many rays (M,): by two, or by one with what is known."""
        two = n_rays >= _RAYS
        held = spreads(self.board_m, two & self.on_board)
        return two | ((n_rays > 0) & (self.any | (self.on_board & held)))

    def on_its_board(self, points_m: Floats, n_rays: NDArray[np.int64]) -> Floats:
        """Points (K, 3) with those of the board where it fits those that two of the rays (K,) tell."""
        board, told = self.on_board, self.on_board & (n_rays >= _RAYS)
        if not spreads(self.board_m, told):
            return points_m
        fit = placed(self.board_m[told], points_m[told])
        middle = self.board_m[told].mean(axis=0)
        out = points_m.copy()
        out[board] = (self.board_m[board] - middle) @ fit.rotation.T + points_m[told].mean(axis=0)
        return out

    def checked(self, n_points: int) -> "KnownPoints":
        """The same with zero where nothing is known; raises InputError for what is no position or information."""
        shapes = np.shape(self.position_m), np.shape(self.information)
        if shapes != ((n_points, 3), (n_points, 3, 3)):
            raise InputError(
                "known points",
                f"shapes {shapes[0]} and {shapes[1]}",
                f"({n_points}, 3) and ({n_points}, 3, 3)",
                "give one row for each point of the survey, of zeros for one that is not known",
            )
        known = np.any(self.information != 0, axis=(1, 2))
        good = (np.isfinite(self.position_m).all(axis=1) | ~known) & _is_information(self.information)
        for point in np.flatnonzero(~good)[:1]:
            raise InputError(
                f"known points, point {point}",
                f"position {self.position_m[point].tolist()} with information {self.information[point].tolist()}",
                "finite numbers, symmetric, without negative eigenvalues, of sigmas of a micrometre or more",
                "give 1 / sigma^2 (1/m^2) of every known coordinate on the diagonal",
            )
        if np.any(self.on_board) and not (np.isfinite(self.board_sigma_m) and self.board_sigma_m >= _LARGEST**-0.5):
            found, expected = f"a sigma of {self.board_sigma_m} m", "a micrometre or more"
            raise InputError("known points, board", found, expected, "give how well the board's points were measured")
        return replace(self, position_m=np.where(known[:, None], self.position_m, 0.0))

    def select(self, points: NDArray[np.int64]) -> "KnownPoints":
        """The same of some of the points (K,)."""
        return replace(
            self,
            position_m=self.position_m[points],
            information=self.information[points],
            shifts=np.ascontiguousarray(self.shifts[points]),
            on_surface=self.on_surface[points],
            board_m=self.board_m[points],
        )

    def weighted(self, weight: Floats) -> "KnownPoints":
        """The same with what is known of each point counted by weights (M,)."""
        return replace(self, information=self.information * weight[:, None, None])

    def at(self, points_m: Floats) -> tuple[Floats, Floats]:
        """Position (M, 3) and information (M, 3, 3) as they are linear about points (M, 3)."""
        if self.surface is None or not np.any(self.on_surface):
            return self.position_m, self.information
        rows = np.flatnonzero(self.on_surface)
        down_m, slope = self.surface(points_m[rows, :_DOWN])
        normal = np.column_stack([-slope, np.ones(len(rows))])
        position, information = self.position_m.copy(), self.information.copy()
        position[rows, :_DOWN], position[rows, _DOWN] = points_m[rows, :_DOWN], down_m
        information[rows] = normal[:, :, None] * normal[:, None, :] / self.surface_sigma_m**2
        return position, information

    def heights(self, points_m: Floats) -> tuple[Floats, NDArray[np.bool_]]:
        """Known heights, as down (M,) from the origin (m), at places of points (M, 3), and which are known (M,)."""
        position, information = self.at(points_m)
        return position[:, _DOWN], information[:, _DOWN, _DOWN] > 0


def nothing_known(n_points: int) -> KnownPoints:
    """No knowledge of any of the points."""
    return KnownPoints(np.zeros((n_points, 3)), np.zeros((n_points, 3, 3)))


def _is_information(matrices: Floats) -> NDArray[np.bool_]:
    """Whether matrices (M, 3, 3) are information of a position."""
    largest = np.abs(matrices).max(axis=(1, 2), initial=0.0)
    good = np.asarray(largest <= _LARGEST)  # not of what is no number
    scaled = np.where(good[:, None, None], matrices, 0.0) / np.where(good & (largest > 0), largest, 1.0)[:, None, None]
    good &= np.abs(scaled - np.swapaxes(scaled, 1, 2)).max(axis=(1, 2), initial=0.0) <= _ROUNDING
    return good & (np.linalg.eigvalsh(scaled)[:, 0] >= -_ROUNDING)

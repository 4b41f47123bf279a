"""What every kind of target has: its points, what is printed of it, and how it is found."""

from dataclasses import dataclass
from typing import ClassVar, Final, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, PositiveInt, model_validator

from linepose.arrays import Floats
from linepose.settings import Settings, SettingsError
from linepose.survey.targets.artwork import Artwork

Picture = NDArray[np.uint8]  # (H, W), as seen from the board's front
Feature = Literal["dot", "corner"]
MOST_ROWS: Final = 100  # and columns: more than any print has whose parts a camera tells apart


@dataclass(frozen=True)
class Found:
    """Points seen in a picture: rows (n,) of the target's points, and places (n, 2), column and row of the picture."""

    row: NDArray[np.int64]
    place: Floats


@dataclass(frozen=True)
class Detail:
    """The smallest thing of a print that must be seen: what it is, its size (m), and how many pixels it takes."""

    name: str
    size_m: float
    n_pixels: float


class TargetSection(Settings):
    """What a target is described by. `kind` names it, `title` says what it is in a few words."""

    kind: str
    title: ClassVar[str]
    feature: ClassVar[Feature | None] = None  # what a point is in the picture

    def points(self) -> Floats:
        """Points in the board frame, in the order of `ids`; (n, 3) in m."""
        raise NotImplementedError

    def ids(self) -> tuple[int | str, ...]:
        """Names of the points, in the order of `points`."""
        return tuple(range(len(self.points())))

    def artwork(self) -> Artwork | None:
        """What is printed; None where there is no pattern."""
        return None

    def details(self) -> tuple[Detail, ...]:
        """What of the print must be seen."""
        return ()


class GridSection(TargetSection):
    """A target of rows and columns that can be printed."""

    fewest: ClassVar[int] = 1  # rows, and columns
    of_size: ClassVar[str] = ""  # what else a number of rows and columns must be

    rows: PositiveInt
    columns: PositiveInt
    known: bool = Field(
        False, description="Whether its dimensions were measured and count in the adjustment; needs `sigma_m`."
    )
    sigma_m: float | None = Field(
        None,
        ge=1e-6,
        le=1.0,
        description="How far points lie off these dimensions in each direction, as one sigma (m): print and bend.",
    )

    @model_validator(mode="after")
    def _has_a_size(self) -> Self:
        sides = sorted((self.rows, self.columns))
        if sides[0] < self.fewest or sides[1] > MOST_ROWS or not self.is_of_size():
            expected = f"{self.fewest} to {MOST_ROWS} rows and columns{self.of_size}"
            raise SettingsError(f"{self.rows} rows and {self.columns} columns", expected, "change rows or columns")
        return self

    @model_validator(mode="after")
    def _is_known_to_a_sigma(self) -> Self:
        if self.known and self.sigma_m is None:
            expected = "how well the points' places are known (m), with `known: true`"
            raise SettingsError("nothing", expected, "add sigma_m", "sigma_m")
        return self

    def is_of_size(self) -> bool:
        """Whether the number of rows and columns is what `of_size` says."""
        return True

    @classmethod
    def scaled(cls, rows: int | None, columns: int | None, spacing_m: float | None) -> Self:
        """A target with all its dimensions in proportion to the spacing; what is None is as by default."""
        raise NotImplementedError

    @property
    def spacing(self) -> float:
        """From one column to the next (m): what `scaled` takes."""
        raise NotImplementedError


class RectifiedSection(GridSection):
    """A grid that standard detectors find where it is seen without much distortion."""

    def find(self, picture: Picture) -> Found | None:
        """The points seen in a picture that shows the target without much distortion; None where it is not seen."""
        raise NotImplementedError

    def symmetries(self) -> list[NDArray[np.int64]]:
        """Ways to number the points (n,) that look alike when the board is turned; the plain one first."""
        return [np.arange(len(self.points()))]


def grid_points(n_rows: int, n_columns: int, row_spacing_m: float, column_spacing_m: float) -> Floats:
    """Points of a grid around the origin, row by row; (rows x columns, 3) in m."""
    row, column = np.indices((n_rows, n_columns)).reshape(2, -1)
    x = (column - (n_columns - 1) / 2) * column_spacing_m
    y = (row - (n_rows - 1) / 2) * row_spacing_m
    return np.stack([x, y, np.zeros(len(x))], axis=-1)


def turns_of_grid(n_rows: int, n_columns: int, half_turn: bool, quarter_turn: bool) -> list[NDArray[np.int64]]:
    """Numberings of a grid's points (n,) after the turns that it looks alike in, the plain one first."""
    plain = np.arange(n_rows * n_columns).reshape(n_rows, n_columns)
    turns = [0, *([2] if half_turn else []), *([1, 3] if quarter_turn and n_rows == n_columns else [])]
    return [np.rot90(plain, turn).ravel() for turn in turns]

"""Target `chessboard`: black and white squares; the points are the corners between them, row by row."""

from typing import ClassVar, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, PositiveFloat, PositiveInt

from linepose.arrays import Floats
from linepose.survey.targets.artwork import Artwork, Rectangle
from linepose.survey.targets.base import Detail, Feature, Found, Picture, RectifiedSection, grid_points, turns_of_grid

_SQUARE_M = 0.060


class ChessboardSection(RectifiedSection):
    """Black and white squares, counted as printed; the points are the inner corners, ids row by row."""

    title: ClassVar[str] = "black and white squares; points are the corners between them"
    feature: ClassVar[Feature | None] = "corner"
    fewest: ClassVar[int] = 4  # of squares: OpenCV wants three inner corners
    of_size: ClassVar[str] = " of squares"

    kind: Literal["chessboard"] = Field("chessboard", description="`chessboard`: black and white squares.")
    rows: PositiveInt = Field(7, description="Rows of squares, at least 4; one fewer row of corners.")
    columns: PositiveInt = Field(9, description="Columns of squares, at least 4; one fewer column of corners.")
    square_m: PositiveFloat = Field(_SQUARE_M, description="Side of a square (m).")

    @classmethod
    def scaled(cls, rows: int | None, columns: int | None, spacing_m: float | None) -> Self:
        """Squares of this side."""
        fields = cls.model_fields
        return cls(
            rows=rows or fields["rows"].default,
            columns=columns or fields["columns"].default,
            square_m=spacing_m or _SQUARE_M,
        )

    @property
    def spacing(self) -> float:
        """Side of a square (m)."""
        return self.square_m

    def points(self) -> Floats:
        """Corners between the squares."""
        return grid_points(self.rows - 1, self.columns - 1, self.square_m, self.square_m)

    def artwork(self) -> Artwork:
        """The squares, the first one black, with half a square of white paper around them."""
        return Artwork(
            (self.columns + 1) * self.square_m,
            (self.rows + 1) * self.square_m,
            black_squares(self.rows, self.columns, self.square_m),
        )

    def details(self) -> tuple[Detail, ...]:
        """The squares."""
        return (Detail("square_m", self.square_m, 5.0),)

    def find(self, picture: Picture) -> Found | None:
        """All inner corners, by OpenCV's detector that works with sectors."""
        import cv2

        size = (self.columns - 1, self.rows - 1)
        flags = cv2.CALIB_CB_NORMALIZE_IMAGE | cv2.CALIB_CB_EXHAUSTIVE | cv2.CALIB_CB_ACCURACY
        seen, corners = cv2.findChessboardCornersSB(picture, size, flags=flags)
        if not seen or corners is None:
            return None
        place = np.asarray(corners, dtype=float).reshape(-1, 2)
        turns = turns_of_grid(self.rows - 1, self.columns - 1, half_turn=True, quarter_turn=True)
        numbered = [turn for turn in turns if self._begins_black(picture, place, turn)]
        return Found(numbered[0], place) if numbered else None

    def _begins_black(self, picture: Picture, place: Floats, row: NDArray[np.int64]) -> bool:
        """Whether the first square is darker than the next, as printed, where places (n, 2) are of points (n,)."""
        of_point = np.empty_like(place)
        of_point[row] = place
        first, along, across = of_point[0], of_point[1] - of_point[0], of_point[self.columns - 1] - of_point[0]
        centres = first + 0.5 * np.array([-along - across, along - across])
        u, v = np.rint(centres).astype(int).T
        light = picture[v.clip(0, picture.shape[0] - 1), u.clip(0, picture.shape[1] - 1)]
        return bool(light[0] < light[1])

    def symmetries(self) -> list[NDArray[np.int64]]:
        """Every turn after which the squares look alike: which one is meant, nothing tells."""
        odd, even = self.rows % 2 == 1, (self.rows + self.columns) % 2 == 0
        return turns_of_grid(self.rows - 1, self.columns - 1, half_turn=even, quarter_turn=even and odd)


def black_squares(n_rows: int, n_columns: int, square_m: float) -> tuple[Rectangle, ...]:
    """The black squares of a chessboard around the origin, of which the first is black."""
    row, column = np.indices((n_rows, n_columns)).reshape(2, -1)
    black = (row + column) % 2 == 0
    x, y = (column - n_columns / 2) * square_m, (row - n_rows / 2) * square_m
    return tuple(Rectangle(a, b, square_m, square_m, white=False) for a, b in zip(x[black], y[black], strict=True))

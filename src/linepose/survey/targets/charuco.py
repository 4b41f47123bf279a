"""Target `charuco`: a chessboard with a numbered marker in each white square, so that a part of it is enough."""

from functools import cached_property
from typing import Any, ClassVar, Literal, Self

import numpy as np
from pydantic import Field, PositiveFloat, PositiveInt, model_validator

from linepose.arrays import Floats
from linepose.settings import SettingsError
from linepose.survey.targets.artwork import Artwork, Rectangle
from linepose.survey.targets.base import Detail, Feature, Found, Picture, RectifiedSection, grid_points
from linepose.survey.targets.chessboard import black_squares
from linepose.survey.targets.markers import dictionary, marker, n_cells, n_markers, parameters

_SQUARE_M = 0.070
_MARKER = 0.75  # of the square's side
_FEWEST_CORNERS = 4


class CharucoSection(RectifiedSection):
    """A chessboard with a marker in each white square; the points are the inner corners, ids row by row."""

    title: ClassVar[str] = "a chessboard with a marker in each white square; a part of it is enough"
    feature: ClassVar[Feature | None] = "corner"
    fewest: ClassVar[int] = 3
    of_size: ClassVar[str] = " of squares"

    kind: Literal["charuco"] = Field("charuco", description="`charuco`: a chessboard with markers.")
    rows: PositiveInt = Field(7, description="Rows of squares, at least 3; one fewer row of corners.")
    columns: PositiveInt = Field(9, description="Columns of squares, at least 3; one fewer column of corners.")
    square_m: PositiveFloat = Field(_SQUARE_M, description="Side of a square (m).")
    marker_m: PositiveFloat = Field(round(_SQUARE_M * _MARKER, 9), description="Side of a marker (m).")
    dictionary: Literal["4X4_50", "4X4_100", "5X5_100", "6X6_250"] = Field(
        "4X4_50", description="OpenCV's dictionary of the markers."
    )

    @model_validator(mode="after")
    def _can_be_found(self) -> Self:
        if self.marker_m >= self.square_m:
            found = f"marker_m {self.marker_m:g} with square_m {self.square_m:g}"
            raise SettingsError(found, "marker_m below square_m", "correct one of them")
        known = int(self.dictionary.partition("_")[2])
        if self.rows * self.columns // 2 > known:
            found = f"{self.rows} x {self.columns} squares with dictionary {self.dictionary}"
            expected = f"at most {known} white squares, or a larger dictionary"
            raise SettingsError(found, expected, "lower rows or columns, or take another dictionary")
        return self

    @classmethod
    def scaled(cls, rows: int | None, columns: int | None, spacing_m: float | None) -> Self:
        """Markers three quarters as wide as the squares, of the smallest dictionary that has enough."""
        fields, square = cls.model_fields, spacing_m or _SQUARE_M
        n_rows, n_columns = rows or fields["rows"].default, columns or fields["columns"].default
        name: Any = next((one for one in ("4X4_50", "4X4_100") if n_rows * n_columns // 2 <= n_markers(one)), "6X6_250")
        return cls(
            rows=n_rows,
            columns=n_columns,
            square_m=square,
            marker_m=round(square * _MARKER, 9),
            dictionary=name,
        )

    @property
    def spacing(self) -> float:
        """Side of a square (m)."""
        return self.square_m

    def points(self) -> Floats:
        """Corners between the squares."""
        return grid_points(self.rows - 1, self.columns - 1, self.square_m, self.square_m)

    def artwork(self) -> Artwork:
        """The squares, the first one black, and the markers; half a square of white paper around them."""
        shapes: list[Rectangle] = list(black_squares(self.rows, self.columns, self.square_m))
        row, column = np.nonzero(np.indices((self.rows, self.columns)).sum(axis=0) % 2)
        x, y = (column + 0.5 - self.columns / 2) * self.square_m, (row + 0.5 - self.rows / 2) * self.square_m
        for number, (a, b) in enumerate(zip(x.tolist(), y.tolist(), strict=True)):
            shapes += marker(self.dictionary, number, a, b, self.marker_m)
        return Artwork((self.columns + 1) * self.square_m, (self.rows + 1) * self.square_m, tuple(shapes))

    def details(self) -> tuple[Detail, ...]:
        """The markers, whose cells must be told apart."""
        return (Detail("cell of marker_m", self.marker_m / n_cells(self.dictionary), 3.0),)

    def find(self, picture: Picture) -> Found | None:
        """The inner corners between markers that were read."""
        corners, ids, _, _ = self._detector.detectBoard(picture)
        if ids is None or len(ids) < _FEWEST_CORNERS:
            return None
        return Found(np.asarray(ids, dtype=np.int64).ravel(), np.asarray(corners, dtype=float).reshape(-1, 2))

    @cached_property
    def _detector(self) -> Any:
        import cv2

        board = cv2.aruco.CharucoBoard(
            (self.columns, self.rows), self.square_m, self.marker_m, dictionary(self.dictionary)
        )
        return cv2.aruco.CharucoDetector(board, detectorParams=parameters())

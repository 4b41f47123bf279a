"""Target `dots`: a grid of plain black dots on white, found in rectified scans as OpenCV finds circle grids."""

from typing import ClassVar, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, PositiveFloat, PositiveInt, model_validator

from linepose.arrays import Floats
from linepose.settings import SettingsError
from linepose.survey.targets.artwork import Artwork, Disc
from linepose.survey.targets.base import Detail, Feature, Found, Picture, RectifiedSection, grid_points, turns_of_grid

_SPACING_M = 0.060
_DIAMETER = 0.5  # of the spacing
_SMALLEST_AREA_PX = 8
_LEAST_ROUND = 0.6


class DotsSection(RectifiedSection):
    """Black dots on white in rows and columns; ids run row by row."""

    title: ClassVar[str] = "black dots on white in rows and columns"
    feature: ClassVar[Feature | None] = "dot"
    fewest: ClassVar[int] = 2

    kind: Literal["dots"] = Field("dots", description="`dots`: black dots on white in rows and columns.")
    rows: PositiveInt = Field(7, description="Rows of dots, at least 2.")
    columns: PositiveInt = Field(9, description="Columns of dots, at least 2.")
    spacing_m: PositiveFloat = Field(_SPACING_M, description="From one dot to the next (m).")
    diameter_m: PositiveFloat = Field(_SPACING_M * _DIAMETER, description="Of the dots (m).")

    @model_validator(mode="after")
    def _are_apart(self) -> Self:
        if self.diameter_m >= self.spacing_m:
            found = f"diameter_m {self.diameter_m:g} with spacing_m {self.spacing_m:g}"
            raise SettingsError(found, "diameter_m below spacing_m", "correct one of them")
        return self

    @classmethod
    def scaled(cls, rows: int | None, columns: int | None, spacing_m: float | None) -> Self:
        """Dots half as wide as their spacing."""
        spacing = spacing_m or _SPACING_M
        fields = cls.model_fields
        return cls(
            rows=rows or fields["rows"].default,
            columns=columns or fields["columns"].default,
            spacing_m=spacing,
            diameter_m=round(spacing * _DIAMETER, 9),
        )

    @property
    def spacing(self) -> float:
        """From one dot to the next (m)."""
        return self.spacing_m

    def points(self) -> Floats:
        """Centres of the dots."""
        return grid_points(self.rows, self.columns, self.spacing_m, self.spacing_m)

    def artwork(self) -> Artwork:
        """Black dots, with half a spacing of white paper around them."""
        discs = tuple(Disc(x, y, self.diameter_m, white=False) for x, y, _ in self.points().tolist())
        return Artwork(self.columns * self.spacing_m, self.rows * self.spacing_m, discs)

    def details(self) -> tuple[Detail, ...]:
        """The dots."""
        return (Detail("diameter_m", self.diameter_m, 4.0),)

    def find(self, picture: Picture) -> Found | None:
        """The whole grid, as OpenCV finds it among blobs."""
        import cv2

        parameters = cv2.SimpleBlobDetector.Params()
        parameters.filterByColor, parameters.blobColor = True, 0
        parameters.filterByArea = True
        parameters.minArea, parameters.maxArea = _SMALLEST_AREA_PX, picture.size / (4 * self.rows * self.columns)
        parameters.filterByCircularity, parameters.minCircularity = True, _LEAST_ROUND
        parameters.filterByInertia = False
        parameters.filterByConvexity = False
        parameters.minDistBetweenBlobs = 2.0
        detector = cv2.SimpleBlobDetector.create(parameters)
        flags = cv2.CALIB_CB_SYMMETRIC_GRID | cv2.CALIB_CB_CLUSTERING
        seen, centres = cv2.findCirclesGrid(picture, (self.columns, self.rows), flags=flags, blobDetector=detector)
        if not seen or centres is None:
            return None
        return Found(np.arange(self.rows * self.columns), np.asarray(centres, dtype=float).reshape(-1, 2))

    def symmetries(self) -> list[NDArray[np.int64]]:
        """A grid looks alike after half a turn, a square one after each quarter."""
        return turns_of_grid(self.rows, self.columns, half_turn=True, quarter_turn=True)

"""Target `apriltags`: a grid of AprilTags; the points are their corners, four a tag, so that a part is enough."""

from typing import ClassVar, Literal, Self

import numpy as np
from pydantic import Field, NonNegativeInt, PositiveFloat, PositiveInt, model_validator

from linepose.arrays import Floats
from linepose.settings import SettingsError
from linepose.survey.targets.artwork import Artwork, Rectangle
from linepose.survey.targets.base import Detail, Feature, Found, Picture, RectifiedSection, grid_points
from linepose.survey.targets.markers import dictionary, marker, n_cells, parameters

_TAG_M = 0.080
_SPACING = 1.3  # times the tag's side, as Kalibr has it
_N_TAGS = {"16h5": 30, "25h9": 35, "36h11": 587}
_CORNERS = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) / 2


class ApriltagsSection(RectifiedSection):
    """AprilTags in rows and columns, row by row; point 4 n + k is corner k of tag n, clockwise from top left."""

    title: ClassVar[str] = "AprilTags in rows and columns; points are their corners; a part of it is enough"
    feature: ClassVar[Feature | None] = "corner"

    kind: Literal["apriltags"] = Field("apriltags", description="`apriltags`: AprilTags in rows and columns.")
    rows: PositiveInt = Field(4, description="Rows of tags.")
    columns: PositiveInt = Field(6, description="Columns of tags.")
    tag_m: PositiveFloat = Field(_TAG_M, description="Side of a tag's black border (m).")
    spacing_m: PositiveFloat = Field(round(_TAG_M * _SPACING, 9), description="From one tag to the next (m).")
    family: Literal["16h5", "25h9", "36h11"] = Field("36h11", description="Family of the tags.")
    first_tag: NonNegativeInt = Field(0, description="Number of the first tag.")

    @model_validator(mode="after")
    def _are_apart(self) -> Self:
        if self.tag_m >= self.spacing_m:
            found = f"tag_m {self.tag_m:g} with spacing_m {self.spacing_m:g}"
            raise SettingsError(found, "tag_m below spacing_m", "correct one of them")
        if self.first_tag + self.rows * self.columns > _N_TAGS[self.family]:
            found = f"{self.rows} rows of {self.columns} tags from number {self.first_tag}"
            expected = f"tag numbers below {_N_TAGS[self.family]}, all that family {self.family} has"
            raise SettingsError(found, expected, "lower rows, columns or first_tag, or take another family")
        return self

    @classmethod
    def scaled(cls, rows: int | None, columns: int | None, spacing_m: float | None) -> Self:
        """Tags with three tenths of their side between them."""
        fields = cls.model_fields
        spacing = spacing_m or fields["spacing_m"].default
        return cls(
            rows=rows or fields["rows"].default,
            columns=columns or fields["columns"].default,
            tag_m=round(spacing / _SPACING, 9),
            spacing_m=spacing,
        )

    @property
    def spacing(self) -> float:
        """From one tag to the next (m)."""
        return self.spacing_m

    def ids(self) -> tuple[int | str, ...]:
        """Four times the tag's number, and the corner."""
        first = 4 * self.first_tag
        return tuple(range(first, first + 4 * self.rows * self.columns))

    def points(self) -> Floats:
        """Corners of the tags, clockwise from top left, tag by tag."""
        centres = grid_points(self.rows, self.columns, self.spacing_m, self.spacing_m)
        corners = np.pad(_CORNERS * self.tag_m, ((0, 0), (0, 1)))
        return (centres[:, None] + corners).reshape(-1, 3)

    def artwork(self) -> Artwork:
        """The tags, with the same white paper around them as between them."""
        shapes: list[Rectangle] = []
        for number, (x, y, _) in enumerate(
            grid_points(self.rows, self.columns, self.spacing_m, self.spacing_m).tolist(), start=self.first_tag
        ):
            shapes += marker(self.family, number, x, y, self.tag_m)
        border = self.spacing_m - self.tag_m
        return Artwork(self.columns * self.spacing_m + border, self.rows * self.spacing_m + border, tuple(shapes))

    def details(self) -> tuple[Detail, ...]:
        """The tags, whose cells must be told apart."""
        return (Detail("cell of tag_m", self.tag_m / n_cells(self.family), 3.0),)

    def find(self, picture: Picture) -> Found | None:
        """The corners of all tags of the grid that were read."""
        import cv2

        detector = cv2.aruco.ArucoDetector(dictionary(self.family), parameters())
        corners, ids, _ = detector.detectMarkers(picture)
        if ids is None:
            return None
        tag = np.asarray(ids, dtype=np.int64).ravel() - self.first_tag
        ours = (tag >= 0) & (tag < self.rows * self.columns) & (np.bincount(tag.clip(0))[tag.clip(0)] == 1)
        if not ours.any():
            return None
        place = np.asarray(corners, dtype=float).reshape(-1, 4, 2)[ours]
        return Found((4 * tag[ours, None] + np.arange(4)).ravel(), place.reshape(-1, 2))

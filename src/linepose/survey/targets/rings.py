"""Target `rings`: dots within rings, and a mark beside the first of them; by default the paper's board (section 3.2).

Found in raw scans whatever their stretch and slant. Ids run to and fro: along x in the first row, back in the second.
"""

from typing import ClassVar, Literal, Self

import numpy as np
from pydantic import Field, PositiveFloat, PositiveInt, model_validator

from linepose.arrays import Floats
from linepose.settings import SettingsError
from linepose.survey import pattern
from linepose.survey.targets.artwork import Artwork, Disc, Rectangle, Shape
from linepose.survey.targets.base import Detail, Feature, GridSection

_BORDER_M = 0.0055  # of black beyond the corner mark, in the paper's size
_FEWEST_POINTS = 6
_DIGITS = 9  # of lengths in metres


class RingsSection(GridSection):
    """Dots within rings, found in raw scans; the defaults are the paper's A1 board."""

    title: ClassVar[str] = "dots within rings and a corner mark, found whatever the drive; the paper's"
    feature: ClassVar[Feature | None] = "dot"
    fewest: ClassVar[int] = 2
    of_size: ClassVar[str] = (
        f", {_FEWEST_POINTS} rings or more, and not as many rows as columns, so that a mirrored scan can be told"
    )

    kind: Literal["rings"] = Field("rings", description="`rings`: dots within rings and a corner mark.")
    rows: PositiveInt = Field(pattern.N_ROWS, description="Rows of rings; not as many as columns.")
    columns: PositiveInt = Field(pattern.N_COLUMNS, description="Columns of rings.")
    row_spacing_m: PositiveFloat = Field(pattern.ROW_SPACING_M, description="From one row to the next (m).")
    column_spacing_m: PositiveFloat = Field(pattern.COLUMN_SPACING_M, description="From one column to the next (m).")
    dot_diameter_m: PositiveFloat = Field(pattern.DOT_DIAMETER_M, description="Of the dots (m).")
    ring_inner_diameter_m: PositiveFloat = Field(pattern.RING_INNER_DIAMETER_M, description="Of the rings, inside (m).")
    ring_outer_diameter_m: PositiveFloat = Field(
        pattern.RING_OUTER_DIAMETER_M, description="Of the rings, outside (m)."
    )
    corner_mark_side_m: PositiveFloat = Field(
        pattern.CORNER_MARK_SIDE_M, description="Of the white square beside point 0 (m)."
    )
    corner_mark_offset_m: tuple[float, float] = Field(
        (-0.0828, -0.0951), description="Centre of that square from point 0: along the columns, along the rows (m)."
    )

    @model_validator(mode="after")
    def _are_within_each_other(self) -> Self:
        if not self.dot_diameter_m < self.ring_inner_diameter_m < self.ring_outer_diameter_m:
            found = f"{self.dot_diameter_m:g}, {self.ring_inner_diameter_m:g}, {self.ring_outer_diameter_m:g}"
            expected = "dot_diameter_m < ring_inner_diameter_m < ring_outer_diameter_m"
            raise SettingsError(found, expected, "correct one of them")
        if self.ring_outer_diameter_m >= min(self.row_spacing_m, self.column_spacing_m):
            nearest = min(self.row_spacing_m, self.column_spacing_m)
            found = f"ring_outer_diameter_m {self.ring_outer_diameter_m:g} with rings {nearest:g} m apart"
            expected = "ring_outer_diameter_m below row_spacing_m and column_spacing_m"
            raise SettingsError(found, expected, "correct one of them")
        return self

    def is_of_size(self) -> bool:
        """Whether enough rings are there, and not as many rows as columns."""
        return self.rows != self.columns and self.rows * self.columns >= _FEWEST_POINTS

    @classmethod
    def scaled(cls, rows: int | None, columns: int | None, spacing_m: float | None) -> Self:
        """As the paper's, every length in proportion to the spacing of the columns."""
        scale = (spacing_m or pattern.COLUMN_SPACING_M) / pattern.COLUMN_SPACING_M
        fields = cls.model_fields
        lengths = {
            name: round(fields[name].default * scale, _DIGITS)
            for name in fields
            if name.endswith("_m") and isinstance(fields[name].default, float)
        }
        x, y = fields["corner_mark_offset_m"].default
        return cls(
            rows=rows or pattern.N_ROWS,
            columns=columns or pattern.N_COLUMNS,
            corner_mark_offset_m=(round(x * scale, _DIGITS), round(y * scale, _DIGITS)),
            **lengths,
        )

    @property
    def spacing(self) -> float:
        """From one column to the next (m)."""
        return self.column_spacing_m

    def points(self) -> Floats:
        """Centres of the rings, by id: to and fro."""
        return pattern.to_and_fro(self.rows, self.columns, self.row_spacing_m, self.column_spacing_m)

    @property
    def corner_mark_centre_m(self) -> tuple[float, float]:
        """Centre of the corner mark in the board frame (m)."""
        x, y = self.points()[0, :2] + self.corner_mark_offset_m
        return round(float(x), _DIGITS), round(float(y), _DIGITS)

    def artwork(self) -> Artwork:
        """White rings, dots and mark on a black field."""
        mark_x, mark_y = self.corner_mark_centre_m
        half_mark = self.corner_mark_side_m / 2
        border = half_mark + _BORDER_M * self.corner_mark_side_m / pattern.CORNER_MARK_SIDE_M
        beyond = np.abs(self.points()[:, :2]).max(axis=0) + self.ring_outer_diameter_m / 2 + border - half_mark
        half_x, half_y = np.maximum(beyond, [abs(mark_x) + border, abs(mark_y) + border]).tolist()
        shapes: list[Shape] = [Rectangle(-half_x, -half_y, 2 * half_x, 2 * half_y, white=False)]
        discs = (self.ring_outer_diameter_m, True), (self.ring_inner_diameter_m, False), (self.dot_diameter_m, True)
        for diameter_m, white in discs:
            shapes += [Disc(x, y, diameter_m, white) for x, y, _ in self.points().tolist()]
        shapes.append(Rectangle(mark_x - half_mark, mark_y - half_mark, 2 * half_mark, 2 * half_mark, white=True))
        return Artwork(2 * half_x, 2 * half_y, tuple(shapes))

    def details(self) -> tuple[Detail, ...]:
        """The dot, and the dark hole around it."""
        return (
            Detail("dot_diameter_m", self.dot_diameter_m, 1.0),
            Detail("ring_inner_diameter_m", self.ring_inner_diameter_m, 5.0),
        )

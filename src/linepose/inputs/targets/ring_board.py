"""What detection needs of a board of rings, worked out once: its points, its ids by cell, and lengths."""

from dataclasses import dataclass
from functools import lru_cache
from typing import Final

import numpy as np

from linepose.arrays import Floats
from linepose.survey.targets.rings import RingsSection

# in hole radii: how far beyond the hole's edge is bright, as a share of the ring's width, and beyond the ring's is dark
_INTO_RING: Final = 0.28 / 0.6
_BEYOND_RING: Final = 0.28
_LARGEST_GAP_SHARE: Final = 0.4  # of the gap to the next ring
_DIGITS: Final = 9  # so that decimal lengths stay what they are


@dataclass(frozen=True)
class RingBoard:
    """A board of rings: points (n, 2) in m, ids by cell (column, row), lengths in m, and radii in hole radii."""

    points_m: Floats
    id_of_cell: dict[tuple[int, int], int]
    n_rows: int
    n_columns: int
    shortest_spacing_m: float
    longest_spacing_m: float
    hole_radius_m: float
    bright_radius: float
    dark_radius: float
    corner_mark_centre_m: tuple[float, float]
    corner_mark_side_m: float

    @property
    def n_points(self) -> int:
        """How many rings there are."""
        return len(self.points_m)


@lru_cache(maxsize=8)
def ring_board(section: RingsSection) -> RingBoard:
    """The board that a platform's file describes."""
    points_m = section.points()[:, :2]
    cell = (points_m - points_m.min(axis=0)) / np.ptp(points_m, axis=0) * [section.columns - 1, section.rows - 1]
    hole_radius_m = section.ring_inner_diameter_m / 2
    outer = section.ring_outer_diameter_m / section.ring_inner_diameter_m
    spacings = section.row_spacing_m, section.column_spacing_m
    gap = (min(spacings) - section.ring_outer_diameter_m) / hole_radius_m
    return RingBoard(
        points_m=points_m,
        id_of_cell={(round(x), round(y)): number for number, (x, y) in enumerate(cell)},
        n_rows=section.rows,
        n_columns=section.columns,
        shortest_spacing_m=min(spacings),
        longest_spacing_m=max(spacings),
        hole_radius_m=hole_radius_m,
        bright_radius=round(1 + _INTO_RING * (outer - 1), _DIGITS),
        dark_radius=round(outer + min(_BEYOND_RING, _LARGEST_GAP_SHARE * gap), _DIGITS),
        corner_mark_centre_m=section.corner_mark_centre_m,
        corner_mark_side_m=section.corner_mark_side_m,
    )

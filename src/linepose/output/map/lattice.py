"""The cells of a scan's raster map, north up, and which of the scan's pixels can lie in which of them."""

from collections import defaultdict
from dataclasses import dataclass
from functools import partial
from typing import Final

import numpy as np

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.output.map.blocks import in_blocks

CHUNK: Final = 64  # lines, and pixels, of the parts of a scan whose extent is known
_MOST_CELLS: Final = 4_000_000_000
_SPACING_LINES: Final = 101
_DIGITS: Final = 2  # of a cell's size that is not given
_LONGEST: Final = 8.0  # between neighbouring pixels, in cells or usual distances, across which cells are filled

Tile = tuple[int, int]


@dataclass(frozen=True, eq=False)
class Lattice:
    """Cells of `cell_m`, `n_rows` southwards and `n_columns` eastwards from the corner at whole multiples of it.

    `first_row`, `first_column`: of the lattice of all maps of this cell, whose row grows southwards. `boxes` (C, 4):
    least and largest row and column of each chunk of the scan, chunk by chunk of its lines, then of its pixels; NaN
    where no pixel of it has a place. `longest` (cells): between neighbours, beyond which nothing is filled.
    """

    cell_m: float
    first_row: int
    first_column: int
    n_rows: int
    n_columns: int
    boxes: Floats
    longest: float

    @property
    def corner_m(self) -> tuple[float, float]:
        """Easting and northing of the north-western corner."""
        return self.first_column * self.cell_m, -self.first_row * self.cell_m

    def chunks_of_tiles(self, size: int) -> dict[Tile, list[int]]:
        """Chunks that reach into each tile of size x size cells, by the tile's row and column; tiles in their order."""
        found: dict[Tile, list[int]] = defaultdict(list)
        for chunk in np.flatnonzero(np.isfinite(self.boxes[:, 0])):
            top, bottom, left, right = (self.boxes[chunk] // size).astype(int)
            for row in range(max(top, 0), min(bottom, (self.n_rows - 1) // size) + 1):
                for column in range(max(left, 0), min(right, (self.n_columns - 1) // size) + 1):
                    found[row, column].append(int(chunk))
        return dict(sorted(found.items()))


def lattice_of(igm: Floats, cell_m: float | None, scan: str, n_cores: int) -> Lattice | None:
    """The cells of the places (L, 3, P) of a scan, of this size or as its pixels lie apart; None without any place.

    Raises InputError naming the scan where the cells would be too many.
    """
    apart_m = _usual_distance(igm)
    boxes_m = np.concatenate(in_blocks(len(igm), CHUNK, partial(_boxes, igm), n_cores))
    seen = np.isfinite(boxes_m[:, 0])
    if not seen.any():
        return None
    if cell_m is None:
        cell_m = _rounded(apart_m) if apart_m > 0 else 1.0
    least, largest = boxes_m[seen].min(axis=0), boxes_m[seen].max(axis=0)
    first = int(np.floor(-largest[1] / cell_m)), int(np.floor(least[2] / cell_m))
    last = int(np.floor(-least[0] / cell_m)), int(np.floor(largest[3] / cell_m))
    n_rows, n_columns = last[0] - first[0] + 1, last[1] - first[1] + 1
    if n_rows * n_columns > _MOST_CELLS:
        found, expected = f"a map of {n_rows} x {n_columns} cells of {cell_m:g} m", f"at most {_MOST_CELLS}"
        least_m = cell_m * float(np.sqrt(n_rows * n_columns / _MOST_CELLS))
        raise InputError(scan, found, expected, f"write map.cell_m: {_rounded(1.01 * least_m):g} or more")
    rows = np.stack([-boxes_m[:, 1], -boxes_m[:, 0], boxes_m[:, 2], boxes_m[:, 3]], axis=-1) / cell_m
    boxes = np.floor(rows) - np.array([first[0], first[0], first[1], first[1]])
    return Lattice(cell_m, *first, n_rows, n_columns, boxes, _LONGEST * max(1.0, apart_m / cell_m))


def _boxes(igm: Floats, first: int, end: int) -> Floats:
    """Least and largest northing, least and largest easting (C, 4) of the chunks of one chunk's lines.

    A chunk has the next one's first line and pixel with it, to which its own are neighbours.
    """
    place = np.asarray(igm[first : end + 1, :2])
    boxes = []
    for pixel in range(0, place.shape[2], CHUNK):
        east, north = np.moveaxis(place[:, :, pixel : pixel + CHUNK + 1], 1, 0)
        known = np.isfinite(east)
        if known.any():
            boxes.append([north[known].min(), north[known].max(), east[known].min(), east[known].max()])
        else:
            boxes.append([np.nan] * 4)
    return np.array(boxes)


def _usual_distance(igm: Floats) -> float:
    """The larger of the median distances (m) between neighbouring pixels and between neighbouring lines; 0 without."""
    lines = np.unique(np.linspace(0, max(len(igm) - 2, 0), _SPACING_LINES).astype(int))
    medians = [0.0]
    this = np.asarray(igm[lines])[:, :2]
    following = np.asarray(igm[np.minimum(lines + 1, len(igm) - 1)])[:, :2]
    for apart in (np.diff(this, axis=2), following - this):
        distance = np.hypot(apart[:, 0], apart[:, 1])
        if np.isfinite(distance).any():
            medians.append(float(np.nanmedian(distance)))
    return max(medians)


def _rounded(value: float) -> float:
    """The next larger number of two digits."""
    step = 10.0 ** (np.floor(np.log10(value)) - _DIGITS + 1)
    return float(f"{np.ceil(value / step) * step:.{_DIGITS}g}")

"""From the cells of a map back to the scan: pixel and line of each, for any tile of the map."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from linepose.arrays import Floats
from linepose.output.map.lattice import CHUNK, Lattice, Tile
from linepose.output.map.mesh_kernel import cells_in_mesh, pixels_in_cells

_NONE: Final = -1


@dataclass(frozen=True, eq=False)
class Looked:
    """Line and pixel of each cell of a tile (H, W), counted from 0; -1 where the scan saw nothing.

    `is_filled` (H, W): no pixel's centre lies in the cell, and the nearest one beside it stands for it. `between` (2,
    H, W): fractional line and pixel of the cell's centre, that of the cell's pixel at the scan's edge.
    """

    line: NDArray[np.int64]
    pixel: NDArray[np.int64]
    is_filled: NDArray[np.bool_]
    between: Floats

    @property
    def is_known(self) -> NDArray[np.bool_]:
        """Whether the scan saw a cell; (H, W)."""
        return np.asarray(self.line >= 0)


def look_up(igm: Floats, lattice: Lattice, tile: Tile, size: int, chunks: Sequence[int], exactly: bool) -> Looked:
    """What the cells of a tile are in the scan of places (L, 3, P), whose `chunks` reach into it.

    `exactly`: `between` is wanted of cells that hold a pixel, too.
    """
    row, column = tile[0] * size, tile[1] * size
    shape = min(size, lattice.n_rows - row), min(size, lattice.n_columns - column)
    corner = np.array([lattice.first_row + row, lattice.first_column + column], dtype=float)
    own, mesh = ((np.full(shape, np.inf), np.full(shape, _NONE), np.full(shape, _NONE)) for _ in range(2))
    across = -(-igm.shape[2] // CHUNK)
    parts = []
    for chunk in chunks:
        line, pixel = chunk // across * CHUNK, chunk % across * CHUNK
        place = np.ascontiguousarray(igm[line : line + CHUNK + 1, :2, pixel : pixel + CHUNK + 1])
        at = np.array([line, pixel])
        parts.append((place, at))
        lines, pixels = min(CHUNK, len(place)), min(CHUNK, place.shape[2])
        pixels_in_cells(place, lines, pixels, at, lattice.cell_m, corner, *own)
    between = np.full((2, *shape), np.nan)
    skip = np.full(shape, _NONE) if exactly else own[1]
    for place, at in parts:
        cells_in_mesh(place, at, lattice.cell_m, corner, lattice.longest, *mesh, between, skip)
    has_own = own[1] >= 0
    line, pixel = np.where(has_own, own[1], mesh[1]), np.where(has_own, own[2], mesh[2])
    alone = np.isnan(between[0])
    between[:, alone] = np.stack([line, pixel])[:, alone]
    return Looked(line, pixel, ~has_own & (mesh[1] >= 0), between)

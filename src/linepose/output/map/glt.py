"""ENVI's geographic lookup table: sample and line of the scan for each cell of the map."""

import os
from pathlib import Path
from typing import Final

import numpy as np

from linepose.arrays import Floats
from linepose.output.map.blocks import in_order
from linepose.output.map.files import envi_header, write_at
from linepose.output.map.frame import SurveyMap
from linepose.output.map.lattice import Lattice, Tile
from linepose.output.map.lookup import look_up

_TILE: Final = 256
_BANDS: Final = ("GLT sample", "GLT line")


def write_glt(igm: Floats, lattice: Lattice, path: Path, n_cores: int) -> dict[str, int]:
    """Write samples and lines, counted from 1, interleaved by line; the same bytes on any cores.

    Negative where no pixel lies in the cell and the nearest one beside it stands for it; zero where the scan saw
    nothing. Returns how many cells hold a pixel of their own, and how many are filled.
    """
    width = lattice.n_columns
    chunks = lattice.chunks_of_tiles(_TILE)
    handle = os.open(path, os.O_WRONLY)

    def write(tile: Tile) -> tuple[int, int]:
        found = look_up(igm, lattice, tile, _TILE, chunks[tile], exactly=False)
        sign = np.where(found.is_filled, -1, 1)
        values = np.stack([(found.pixel + 1) * sign, (found.line + 1) * sign], axis=1).astype("<i4")
        if found.is_known.any():
            for row, both in enumerate(values, start=tile[0] * _TILE):
                for band, cells in enumerate(both):
                    write_at(handle, cells, ((row * len(_BANDS) + band) * width + tile[1] * _TILE) * 4)
        filled = int(found.is_filled.sum())
        return int(found.is_known.sum()) - filled, filled

    try:
        os.ftruncate(handle, lattice.n_rows * width * len(_BANDS) * 4)
        counts = np.array([count for _, count in in_order(chunks, write, n_cores)]).sum(axis=0)
    finally:
        os.close(handle)
    return {"n_cells": int(counts[0]), "n_filled": int(counts[1])}


def glt_header(lattice: Lattice, frame: SurveyMap, scan: str) -> str:
    """Text of the header of the lookup table, with where its cells lie."""
    east, north = lattice.corner_m
    about = f"sample and line of {scan} for each cell of the map, negative where filled from beside"
    header = envi_header((lattice.n_rows, lattice.n_columns), _BANDS, "int32", about)
    cell = f"1, 1, {east!r}, {north!r}, {lattice.cell_m!r}, {lattice.cell_m!r}"
    if frame.frame is None:
        return header + f"map info = {{Arbitrary, {cell}, 0, units=Meters}}\n"
    crs = frame.frame.crs.to_2d()
    name = crs.name.replace(",", " ")
    wkt = crs.to_wkt("WKT1_ESRI")
    return header + f"map info = {{{name}, {cell}, units=Meters}}\ncoordinate system string = {{{wkt}}}\n"

"""Places and sigmas of a whole scan on disk: an ENVI IGM and a sigma file, block by block of lines."""

import os
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from linepose.arrays import Floats
from linepose.output.map.blocks import in_blocks
from linepose.output.map.files import envi_header, write_at
from linepose.output.map.places import N_PLACE, N_SIGMA, STATES, ScanOnMap, count_states

BLOCK_LINES: Final = 256
_PLACE_BANDS: Final = ("IGM easting (m)", "IGM northing (m)", "IGM height (m)")
_SIGMA_BANDS: Final = ("sigma easting (m)", "sigma northing (m)", "sigma height (m)", "radius of 95 % (m)")


@dataclass(frozen=True, eq=False)
class Extent:
    """What is known of the places that were written.

    `corners_m`: least and greatest easting, northing (2, 2); `spacing_m`: median distance of pixels beside each other
    in a line; `counts` of pixels by STATES; `northing_m` (B, 2): least and greatest of each block of BLOCK_LINES lines.
    NaN where no pixel has a place.
    """

    corners_m: Floats
    spacing_m: float
    counts: dict[str, int]
    northing_m: Floats


def write_places(scan: ScanOnMap, igm: Path, sigma: Path, n_cores: int) -> Extent:
    """Write places (L, 3, P), double, and sigmas (L, 4, P), float, interleaved by line; the same bytes on any cores."""
    pixels = scan.shape[1]
    handles = [os.open(path, os.O_WRONLY) for path in (igm, sigma)]

    def write(first: int, end: int) -> tuple[Floats, float, dict[str, int]]:
        found = scan.places(first, end)
        write_at(handles[0], found.place_m, first * N_PLACE * pixels * 8)
        write_at(handles[1], found.sigma_m, first * N_SIGMA * pixels * 4)
        east_north = found.place_m[:, :2]
        if not found.is_found.any():
            return np.full((2, 2), np.nan), np.nan, count_states(found.state)
        corners = np.stack([np.nanmin(east_north, axis=(0, 2)), np.nanmax(east_north, axis=(0, 2))])
        apart = np.hypot(*np.moveaxis(np.diff(east_north[:: max(1, (end - first) // 8)], axis=2), 1, 0))
        apart = apart[np.isfinite(apart)]
        return corners, float(np.median(apart)) if apart.size else np.nan, count_states(found.state)

    try:
        parts = in_blocks(scan.shape[0], BLOCK_LINES, write, n_cores)
    finally:
        for handle in handles:
            os.close(handle)
    return _extent(parts)


def _extent(parts: list[tuple[Floats, float, dict[str, int]]]) -> Extent:
    corners = np.array([part[0] for part in parts])
    known = np.isfinite(corners[:, 0, 0])
    total = Counter[str]()
    for part in parts:
        total.update(part[2])
    counts = {name: total[name] for name in STATES}
    if not known.any():
        return Extent(np.full((2, 2), np.nan), np.nan, counts, corners[:, :, 1])
    whole = np.stack([corners[known, 0].min(axis=0), corners[known, 1].max(axis=0)])
    spacing = np.array([part[1] for part in parts])
    return Extent(whole, float(np.nanmedian(spacing)), counts, corners[:, :, 1])


def places_header(scan: ScanOnMap) -> str:
    """Text of the header of the places."""
    crs = scan.frame.crs or "local coordinates"
    about = f"x, y, z of each pixel of {scan.name}: easting, northing, height in {crs}"
    return envi_header(scan.shape, _PLACE_BANDS, "float64", about)


def sigma_header(scan: ScanOnMap) -> str:
    """Text of the header of the sigmas."""
    about = f"one standard deviation of each pixel of {scan.name}, and the radius that holds 95 %"
    return envi_header(scan.shape, _SIGMA_BANDS, "float32", about)

"""Places and sigmas of a whole scan on disk: an ENVI IGM and a sigma file, block by block of lines."""

import os
from pathlib import Path
from typing import Final

from linepose.output.map.blocks import in_blocks
from linepose.output.map.files import envi_header, write_at
from linepose.output.map.places import N_PLACE, N_SIGMA, STATES, ScanOnMap, count_states

BLOCK_LINES: Final = 256
_PLACE_BANDS: Final = ("IGM easting (m)", "IGM northing (m)", "IGM height (m)")
_SIGMA_BANDS: Final = ("sigma easting (m)", "sigma northing (m)", "sigma height (m)", "radius of 95 % (m)")


def write_places(scan: ScanOnMap, igm: Path, sigma: Path, n_cores: int) -> dict[str, int]:
    """Write places (L, 3, P), double, and sigmas (L, 4, P), float, interleaved by line; the same bytes on any cores.

    Returns how many pixels there are of each of STATES.
    """
    pixels = scan.shape[1]
    handles = [os.open(path, os.O_WRONLY) for path in (igm, sigma)]

    def write(first: int, end: int) -> dict[str, int]:
        found = scan.places(first, end)
        write_at(handles[0], found.place_m, first * N_PLACE * pixels * 8)
        write_at(handles[1], found.sigma_m, first * N_SIGMA * pixels * 4)
        return count_states(found.state)

    try:
        counts = in_blocks(scan.shape[0], BLOCK_LINES, write, n_cores)
    finally:
        for handle in handles:
            os.close(handle)
    return {name: sum(one[name] for one in counts) for name in STATES}


def places_header(scan: ScanOnMap) -> str:
    """Text of the header of the places."""
    crs = scan.frame.crs or "local coordinates"
    about = f"x, y, z of each pixel of {scan.name}: easting, northing, height in {crs}"
    return envi_header(scan.shape, _PLACE_BANDS, "float64", about)


def sigma_header(scan: ScanOnMap) -> str:
    """Text of the header of the sigmas."""
    about = f"one standard deviation of each pixel of {scan.name}, and the radius that holds 95 %"
    return envi_header(scan.shape, _SIGMA_BANDS, "float32", about)

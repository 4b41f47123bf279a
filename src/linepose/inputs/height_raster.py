"""Heights in a raster that rasterio reads, such as a GeoTIFF: of the ground that points lie on, or that scans show."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from linepose.errors import InputError

if TYPE_CHECKING:
    from affine import Affine

_CELLS: Final = (1e-12, 1e7)  # sizes, in metres or degrees, beyond which a cell has none
_SMALLEST: Final = 2  # cells along either axis
_LARGEST: Final = 50_000_000  # cells that are read


@dataclass(frozen=True, eq=False)
class HeightRaster:
    """Heights (H, W), NaN where there is none; `transform` from column and row to the coordinates of `crs`, or None."""

    height_m: NDArray[np.float32]
    transform: "Affine"
    crs: Any


def read_heights(path: Path, key: str) -> HeightRaster:
    """The heights of a file that a key of the platform's file names.

    Raises InputError where there is no such file, or it is no raster of one band with heights.
    """
    import rasterio
    from rasterio.errors import RasterioError

    if not path.is_file():
        raise InputError(str(path), "no such file", "a height model", f"put it there, or correct {key}")
    try:
        with rasterio.open(path) as raster:
            if raster.count != 1 or min(raster.shape) < _SMALLEST or raster.width * raster.height > _LARGEST:
                found = f"{raster.count} bands of {raster.width} x {raster.height} cells"
                expected = f"one band of at least {_SMALLEST} x {_SMALLEST} and at most {_LARGEST} cells"
                raise InputError(str(path), found, expected, "cut the survey's part of one band out of it")
            if not _has_cells(raster.transform):
                found = f"cells without a size ({', '.join(f'{value:g}' for value in tuple(raster.transform)[:6])})"
                raise InputError(str(path), found, "a size and place of the cells", f"restore it, or correct {key}")
            heights = raster.read(1, masked=True).astype(np.float32).filled(np.nan)
            made = HeightRaster(heights, raster.transform, raster.crs)
    except (RasterioError, UnicodeError) as error:  # words of the file that are no text
        found = " ".join(str(error).split())[:80]
        raise InputError(
            str(path), found, "a raster of heights, as a GeoTIFF", f"restore it, or correct {key}"
        ) from None
    heights[~np.isfinite(heights)] = np.nan
    if np.all(np.isnan(heights)):
        raise InputError(str(path), "no height in any cell", "a height model", f"restore it, or correct {key}")
    return made


def _has_cells(transform: "Affine") -> bool:
    """Whether the cells of a raster have a size, in metres or degrees, a place, and two directions."""
    values = np.array(tuple(transform)[:6])
    sizes = np.hypot(values[[0, 1]], values[[3, 4]])
    within = bool(np.all((sizes > _CELLS[0]) & (sizes < _CELLS[1])))
    return bool(np.all(np.isfinite(values))) and within and not transform.is_degenerate

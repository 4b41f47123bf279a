"""A cloud-optimised GeoTIFF of chosen bands of a scan on the map."""

import errno
import shutil
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Literal

import numpy as np
from numpy.typing import NDArray

from linepose.arrays import Floats
from linepose.inputs.scans.scan_bands import ScanBands
from linepose.output.map.blocks import in_order
from linepose.output.map.frame import SurveyMap
from linepose.output.map.lattice import Lattice, Tile
from linepose.output.map.lookup import look_up

if TYPE_CHECKING:
    from rasterio.crs import CRS

Resampling = Literal["nearest", "bilinear"]
Compression = Literal["none", "deflate", "zstd"]

_SIZES: Final = (512, 256, 128)  # cells along the sides of a tile
_TILE_BYTES: Final = 33_000_000
_OVERVIEWS: Final = 1.4  # a file with its overviews, beside one without
_CACHE_BYTES: Final = 256_000_000
_NO_ROOM_BYTES: Final = 64_000_000


@dataclass(frozen=True)
class Layers:
    """What is written of a scan: bands, counted from 1, how they are resampled, and how the file is compressed."""

    bands: tuple[int, ...]
    resampling: Resampling
    compression: Compression


def write_geotiff(
    igm: Floats, lattice: Lattice, frame: SurveyMap, scan: ScanBands, layers: Layers, path: Path, n_cores: int
) -> None:
    """Write the bands of a scan of places (L, 3, P); the same bytes on any number of cores.

    A cell that the scan did not see is NaN, zero where values are whole and not negative, else the least number of the
    type. Beside `path` stands a folder with a copy while it is written. Raises OSError where the disk has no room.
    """
    import rasterio
    from rasterio.enums import Resampling as Overviews
    from rasterio.shutil import copy

    size = _tile_size(scan.dtype.itemsize * len(layers.bands))
    chunks = lattice.chunks_of_tiles(size)
    needed = int((1 + _OVERVIEWS) * len(chunks) * size**2 * scan.dtype.itemsize * len(layers.bands))
    if shutil.disk_usage(path.parent).free < needed:
        raise OSError(errno.ENOSPC, "no room")
    work = Path(tempfile.mkdtemp(dir=path.parent, prefix=f"{path.name}-"))
    options = {"BLOCKSIZE": size, "COMPRESS": layers.compression.upper(), "SPARSE_OK": True, "BIGTIFF": "IF_SAFER"}
    try:
        with rasterio.Env(GDAL_CACHEMAX=_CACHE_BYTES, GDAL_NUM_THREADS=n_cores, SPARSE_OK_OVERVIEW=True):
            _write_tiles(igm, lattice, frame, scan, layers, work / "tiles.tif", size, chunks, n_cores)
            with rasterio.open(work / "tiles.tif", "r+") as file:
                # made in advance: the driver makes them of all bands at once, ten times slower
                file.build_overviews(_overviews(lattice, size), Overviews[layers.resampling])
            copy(work / "tiles.tif", work / "map.tif", driver="COG", **options)
        (work / "map.tif").replace(path)
    except Exception as error:  # of a write that fails GDAL tells by errors of many classes
        if shutil.disk_usage(path.parent).free < _NO_ROOM_BYTES:
            raise OSError(errno.ENOSPC, "no room") from error
        raise
    finally:
        shutil.rmtree(work, ignore_errors=True)


def _write_tiles(
    igm: Floats,
    lattice: Lattice,
    frame: SurveyMap,
    scan: ScanBands,
    layers: Layers,
    path: Path,
    size: int,
    chunks: dict[Tile, list[int]],
    n_cores: int,
) -> None:
    """Write all tiles that the scan saw into a plain file, from which the other is made."""
    import rasterio
    from affine import Affine
    from rasterio.windows import Window

    numbers = [band - 1 for band in layers.bands]
    nothing = no_data(scan.dtype)
    is_linear = layers.resampling == "bilinear"

    def values(tile: Tile) -> NDArray[Any] | None:
        found = look_up(igm, lattice, tile, size, chunks[tile], exactly=is_linear)
        known = found.is_known
        if not known.any():
            return None
        made = np.full((len(numbers), *known.shape), nothing, dtype=scan.dtype)
        if is_linear:
            line, pixel = found.between[:, known]
            made[:, known] = scan.linear(line, pixel, numbers)
        else:
            made[:, known] = scan.nearest(found.line[known], found.pixel[known], numbers)
        return made

    east, north = lattice.corner_m
    profile = {
        "driver": "GTiff",
        "height": lattice.n_rows,
        "width": lattice.n_columns,
        "count": len(numbers),
        "dtype": scan.dtype,
        "nodata": nothing,
        "crs": _crs(frame),
        "transform": Affine(lattice.cell_m, 0.0, east, 0.0, -lattice.cell_m, north),
        "tiled": True,
        "blockxsize": size,
        "blockysize": size,
        "interleave": "band",
        "sparse_ok": True,
        "bigtiff": "YES",
    }
    with rasterio.open(path, "w", **profile) as file:
        file.descriptions = [f"band {band}" for band in layers.bands]
        for (row, column), made in in_order(chunks, values, n_cores):
            if made is not None:
                file.write(made, window=Window(column * size, row * size, made.shape[2], made.shape[1]))


def no_data(dtype: np.dtype[Any]) -> float:
    """The number for cells that the scan did not see: NaN, or the least whole number of the type."""
    return float("nan") if dtype.kind == "f" else int(np.iinfo(dtype).min)


def _tile_size(cell_bytes: int) -> int:
    return next((size for size in _SIZES if size**2 * cell_bytes <= _TILE_BYTES), _SIZES[-1])


def _overviews(lattice: Lattice, size: int) -> list[int]:
    """Factors of the overviews: halves, until one tile holds the whole."""
    largest = max(lattice.n_rows, lattice.n_columns)
    return [2**k for k in range(1, 32) if 2 ** (k - 1) * size < largest]


def _crs(frame: SurveyMap) -> "CRS | None":
    from rasterio.crs import CRS

    return None if frame.frame is None else CRS.from_wkt(frame.frame.crs.to_2d().to_wkt())

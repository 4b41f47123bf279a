"""Scans as PNG, TIFF or JPEG pictures, in all bits that they have; lines run downwards.

Pillow reads PNG, tifffile TIFF of any number of bands. TIFF of a compression that tifffile leaves to others goes
through Pillow where its values are not cut.
"""

import logging
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageFile

from linepose.errors import InputError
from linepose.inputs.scans.image_size import check_image_size, check_width

_GREY_MODES: Final = {"L", "I", "I;16", "I;16B", "F", "RGB"}
_TIFF: Final = {".tif", ".tiff"}
_JPEG: Final = {".jpg", ".jpeg"}
_BYTE_MODES: Final = {"L", "RGB", "P", "1"}  # Pillow's of at most 8 bits a value
_MOST_VALUES: Final = 2_000_000_000  # of all bands: 4 GB of 16 bit
_MOST_COMPRESSED: Final = 10_000  # bytes of values in one of the file: what is said to hold more has no values
_INVERTED, _PALETTE, _YCBCR = 0, 3, 6  # TIFF's photometric interpretations
_BANDS: Final = {"S", "C"}  # tifffile's axes of the values of one place
_CHUNK_LINES: Final = 1024
_JPEG_IN_TIFF: Final = {6, 7, 34892}  # compressions
_COST_OF_8_BITS: Final = (
    "dots are as exact where the scene fills the range, half as exact where it fills a tenth of it; better save all "
    "bits of the recorder"
)
_COST_OF_JPEG: Final = (
    "quality 95 costs nothing, quality 50 makes dots half as exact (0.04 px), and 8 bits are left; better save PNG, "
    "TIFF or ENVI"
)

log = logging.getLogger(__name__)


def picture_size(path: Path) -> tuple[int, int]:
    """Lines and pixels of a picture, from its header alone; raises InputError as `read_picture`.

    What is lost in a picture of 8 bits, or in JPEG, is told.
    """
    with _faults_of(path):
        if path.suffix.lower() in _TIFF:
            with _tiff(path) as file:
                size, dtype = _tiff_size(file, path), file.series[0].dtype
                _tell_losses(path, dtype is not None and dtype.itemsize == 1, file.series[0].keyframe.compression)
                return size
        with _opened(path) as image:
            deep = isinstance(image, ImageFile.ImageFile) and "RGB;16" in str(image.tile)
            _tell_losses(path, image.mode in _BYTE_MODES and not deep)
            return image.height, image.width


def _tell_losses(path: Path, is_8_bit: bool, compression: int = 1) -> None:
    """Warn of what was lost when a recorder's values were saved so; `compression` is TIFF's number."""
    if path.suffix.lower() in _JPEG or compression in _JPEG_IN_TIFF:
        log.warning("%s: JPEG: %s", path, _COST_OF_JPEG)
    elif is_8_bit:
        log.warning("%s: 8 bits a value: %s", path, _COST_OF_8_BITS)


def read_picture(path: Path, n_pixels: int | None = None) -> NDArray[np.float32]:
    """Intensities (L, P) of a PNG, TIFF or JPEG file, the mean of the bands or channels of a coloured one.

    Raises InputError where the file is broken, too large, of an unsupported kind, or not `n_pixels` wide.
    """
    with _faults_of(path):
        size = picture_size(path)
        check_image_size(*size, path)
        check_width(size[1], n_pixels, path)
        mean = _tiff_mean(path) if path.suffix.lower() in _TIFF else _pillow_mean(path)
    if not np.all(np.isfinite(mean)):
        raise InputError(str(path), "intensities that are no numbers", "finite intensities", "restore the scan")
    return mean


@contextmanager
def _faults_of(path: Path) -> Iterator[None]:
    """Whatever a decoder raises of a broken file, told as an InputError."""
    try:
        yield
    except (InputError, MemoryError):
        raise
    except Exception as error:
        found = " ".join(str(error).split()) or type(error).__name__
        raise InputError(str(path), found[:200], "a whole PNG, TIFF or JPEG file", "restore the scan") from None


@contextmanager
def _opened(path: Path) -> Iterator[Image.Image]:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", Image.DecompressionBombWarning)  # the size is checked here
        image = Image.open(path)
    with image:
        yield image


def _pillow_mean(path: Path) -> NDArray[np.float32]:
    with _opened(path) as image:
        if image.mode not in _GREY_MODES:
            expected, remedy = "grey or RGB", "convert the scan to 8 or 16 bit grey"
            raise InputError(str(path), f"pixel format {image.mode}", expected, remedy)
        deep = isinstance(image, ImageFile.ImageFile) and "RGB;16" in str(image.tile)
        if not deep:
            values = np.asarray(image, dtype=np.float32)
            return values.mean(axis=2, dtype=np.float32) if values.ndim == 3 else values
    if path.suffix.lower() in _TIFF:
        remedy = "save it without compression, or with Deflate"
        raise InputError(str(path), "16-bit colour in a compression that would be cut to 8 bits", "all bits", remedy)
    # Pillow has no mode for 16-bit colour: the upper and the lower byte of each value are decoded apart
    return 256 * _byte_mean(path, "RGB;16B") + _byte_mean(path, "RGB;16L")


def _byte_mean(path: Path, raw_mode: str) -> NDArray[np.float32]:
    with _opened(path) as image:
        assert isinstance(image, ImageFile.ImageFile)
        image.tile = [tile._replace(args=raw_mode) for tile in image.tile]
        return np.asarray(np.asarray(image).mean(axis=2, dtype=np.float32))


@contextmanager
def _tiff(path: Path) -> Iterator[Any]:
    import tifffile  # late: only these files need it

    with tifffile.TiffFile(path) as file:
        _check_pages(file, path)
        yield file


def _check_pages(file: Any, path: Path) -> None:
    """Raise InputError where pages lead back to one before them: tifffile would follow them for ever."""
    seen: set[int] = set()
    for page in file.pages:
        if page.offset in seen:
            raise InputError(str(path), "pages that lead back to each other", "a whole TIFF file", "restore the scan")
        seen.add(page.offset)


def _tiff_size(file: Any, path: Path) -> tuple[int, int]:
    """Lines and pixels of the first picture; raises InputError where there are several pages of it."""
    series = file.series[0]
    sizes = dict(zip(series.axes, series.shape, strict=True))
    pages = int(np.prod([size for axis, size in sizes.items() if axis not in {"Y", "X", *_BANDS}]))
    if pages != 1 or not {"Y", "X"} <= set(sizes):
        expected, remedy = "one picture, its lines one below the other", "save the lines as one picture"
        raise InputError(str(path), f"{pages} pictures of {sizes.get('X', 0)} pixels", expected, remedy)
    return int(sizes["Y"]), int(sizes["X"])


def _tiff_mean(path: Path) -> NDArray[np.float32]:
    with _tiff(path) as file:
        series, page = file.series[0], file.series[0].keyframe
        told = _unsupported(series, page)
        if told:
            raise InputError(str(path), told, "grey, RGB or bands of numbers", "convert the scan to 8 or 16 bit grey")
        if series.size > _MOST_VALUES:
            found, remedy = f"{series.size} values", "cut the scan into views of the board"
            raise InputError(str(path), found, f"at most {_MOST_VALUES}", remedy)
        segments = [segment for one in series.pages for segment in _segments(one)]
        beyond = any(offset + count > file.filehandle.size for offset, count in segments)
        if beyond or series.nbytes > _MOST_COMPRESSED * sum(count for _, count in segments):
            raise InputError(str(path), "a file that is truncated", "a whole TIFF file", "restore the scan")
        if page.photometric == _YCBCR or not _decodable(page):
            return _pillow_mean(path)
        values = series.asarray()
        axes = series.axes
    lines = np.moveaxis(values, (axes.index("Y"), axes.index("X")), (0, 1))
    lines = lines.reshape(*lines.shape[:2], -1)
    mean = np.empty(lines.shape[:2], dtype=np.float32)
    for first in range(0, len(mean), _CHUNK_LINES):
        mean[first : first + _CHUNK_LINES] = lines[first : first + _CHUNK_LINES].mean(axis=2, dtype=np.float64)
    if page.photometric == _INVERTED and lines.dtype.kind == "u":
        mean = np.float32(np.iinfo(lines.dtype).max) - mean
    return mean


def _unsupported(series: Any, page: Any) -> str | None:
    """What the picture has that is no intensity, if anything."""
    if page.photometric == _PALETTE:
        return "pixel format of a palette"
    if set(page.extrasamples) & {1, 2}:
        return "pixel format with an alpha channel"
    if series.dtype is None or series.dtype.kind not in "uif":
        return f"pixel format {series.dtype}"
    return None


def _segments(page: Any) -> Iterator[tuple[int, int]]:
    yield from zip(page.dataoffsets, page.databytecounts, strict=True)


def _decodable(page: Any) -> bool:
    """Whether tifffile has what the compression needs; without, its decoder is an error that is raised when called."""
    from tifffile import TIFF

    try:
        TIFF.DECOMPRESSORS[page.compression]
        TIFF.UNPREDICTORS[page.predictor]
    except KeyError:
        return False
    return True

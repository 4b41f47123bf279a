"""Scans: images of stacked scan lines with a time stamp for each line, read from ENVI, PNG or TIFF files.

The time stamps of `NAME.hdr` (or .png, .tif) stand in `NAME-times.csv`: microseconds since 1970, one a row, below an
optional heading; linepose.inputs.scans.line_times reads what devices write instead. Whatever a file claims about its
size is checked before memory is taken for it.
"""

import warnings
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray
from PIL import Image, UnidentifiedImageError
from spectral.io import envi
from spectral.io.spyfile import SpyFile
from spectral.utilities.errors import SpyException

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.inputs.number_files import check_microseconds

Intensity = NDArray[np.float32]

_LARGEST: Final = {"lines": 10_000_000, "samples": 100_000, "bands": 10_000}
_LARGEST_IMAGE: Final = 500_000_000  # pixels of a scan: 2 GB as float32
_CHUNK_BYTES: Final = 64_000_000
_REAL_TYPES: Final = {"1", "2", "3", "4", "5", "12", "13", "14", "15"}  # ENVI's codes of numbers that are not complex
_INTERLEAVES: Final = {"bil": 1, "bip": 2, "bsq": 0}  # axis of the bands in the file
_GREY_MODES: Final = {"L", "I", "I;16", "I;16B", "F", "RGB"}
_BRIEFLY: Final = 60


@dataclass(frozen=True)
class Scan:
    """Mean intensity (L, P) of L lines and P pixels, the time stamp (L,) of each line, increasing, and a name."""

    intensity: Intensity
    time_us: NDArray[np.int64]
    name: str

    def time_at(self, line: Floats) -> NDArray[np.int64]:
        """Time stamps (us) at fractional lines (...), between those of the two lines around, or beyond the last."""
        first = np.clip(np.floor(line), 0, len(self.time_us) - 2).astype(np.int64)
        step = self.time_us[first + 1] - self.time_us[first]
        return self.time_us[first] + np.rint((line - first) * step).astype(np.int64)


LineTimes = Callable[[Path, int], NDArray[np.int64]]  # time stamps (us) of a scan file of so many lines


def read_scan(path: Path, line_times: LineTimes | None = None) -> Scan:
    """The scan of an ENVI header (.hdr), PNG or TIFF file, with the time stamps that `line_times` finds for it.

    Without, they stand in `NAME-times.csv`. Raises InputError where a file is missing, truncated, of an unsupported
    kind, or contradicts another.
    """
    intensity = read_intensity(path)
    times = line_times(path, len(intensity)) if line_times else read_line_times(times_path(path), len(intensity))
    return Scan(intensity, times, path.stem)


def read_intensity(path: Path) -> Intensity:
    """Mean intensities (L, P) of a scan file, without its time stamps; raises InputError like `read_scan`."""
    if not path.is_file():
        raise InputError(str(path), "no such file", "a scan", "restore it, or correct source.scans")
    reader = _READERS.get(path.suffix.lower())
    if reader is None:
        raise InputError(str(path), f"file type {path.suffix!r}", f"one of {', '.join(_READERS)}", "convert the scan")
    return reader(path)


def scan_size(path: Path) -> tuple[int, int]:
    """Lines and pixels of a scan, from its header alone: no intensity is read; raises InputError as `read_scan`."""
    if not path.is_file():
        raise InputError(str(path), "no such file", "a scan", "restore it, or correct source.scans")
    if path.suffix.lower() == ".hdr":
        n_lines, n_samples, _ = _open_envi(path).shape
        return int(n_lines), int(n_samples)
    if path.suffix.lower() not in _READERS:
        raise InputError(str(path), f"file type {path.suffix!r}", f"one of {', '.join(_READERS)}", "convert the scan")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", Image.DecompressionBombWarning)
            with Image.open(path) as image:
                return image.height, image.width
    except (UnidentifiedImageError, Image.DecompressionBombError, OSError, SyntaxError, ValueError) as error:
        found = " ".join(str(error).split())
        raise InputError(str(path), found, "a whole PNG or TIFF file", "restore the scan") from None


def times_path(path: Path) -> Path:
    """Where the time stamps of a scan file stand."""
    return path.with_name(f"{path.stem}-times.csv")


def read_line_times(path: Path, n_lines: int) -> NDArray[np.int64]:
    """Time stamps (n_lines,) in microseconds; raises InputError where they are too few, too many or not increasing."""
    times, heading = read_times(path)
    check_line_times(times, n_lines, path, heading)
    return times


def read_times(path: Path) -> tuple[NDArray[np.int64], int]:
    """Whole numbers, one a row, and how many rows (0 or 1) the heading takes; raises InputError for anything else."""
    if not path.is_file():
        raise InputError(str(path), "no such file", "the time stamp of each line", "put it beside the scan")
    try:
        rows = [row.strip() for row in path.read_text(encoding="utf-8").splitlines() if row.strip()]
    except UnicodeDecodeError:
        raise InputError(str(path), "bytes that are not text", "a time stamp a row", "restore the file") from None
    heading = int(bool(rows) and rows[0] == "time_us")
    times = np.empty(len(rows) - heading, dtype=np.int64)
    for index, cell in enumerate(rows[heading:]):
        try:
            times[index] = int(cell)
        except (ValueError, OverflowError):
            place, found = f"{path}, row {index + heading + 1}", repr(cell[:_BRIEFLY])
            raise InputError(place, found, "a whole number of microseconds", "mend the row") from None
    return times, heading


def check_line_times(times: NDArray[np.int64], n_lines: int, path: Path, heading: int) -> None:
    """Raise InputError where the time stamps (us) are not one a line, or not increasing.

    `heading` is the number of rows above the first of them in the file.
    """
    if len(times) != n_lines:
        remedy = "restore the file that is incomplete"
        raise InputError(str(path), f"{len(times)} time stamps", f"{n_lines}, one for each line of the scan", remedy)
    check_microseconds(times, path, first_row=heading + 1)
    backwards = np.flatnonzero(np.diff(times) <= 0)
    if backwards.size:
        row = int(backwards[0]) + 1
        place, expected = f"{path}, row {row + heading + 1}", f"a time after the line before it ({times[row - 1]})"
        raise InputError(place, f"time {times[row]}", expected, "correct the camera's clock or remove the lines")


def spectral_mean(path: Path) -> Intensity:
    """Mean over the bands of an ENVI file; (L, P). The data are mapped, never read as a whole.

    Raises InputError where the header is not one, or contradicts the data file.
    """
    image = _open_envi(path)
    n_lines, n_samples, n_bands = image.shape
    mean = np.empty((n_lines, n_samples), dtype=np.float32)
    accumulator = _accumulator(np.dtype(image.dtype), n_bands)
    axis = _INTERLEAVES[str(image.metadata["interleave"]).lower()]
    step = max(1, _CHUNK_BYTES // (n_samples * n_bands * np.dtype(image.dtype).itemsize))
    for first in range(0, n_lines, step):
        # mapped anew for each chunk, so that pages read earlier do not count as this process's memory
        lines = image.open_memmap(interleave="source")
        chunk = lines[:, first : first + step] if axis == 0 else lines[first : first + step]
        mean[first : first + step] = chunk.sum(axis=axis, dtype=accumulator) / np.float32(n_bands)
    if not np.all(np.isfinite(mean)):
        raise InputError(str(path), "intensities that are no numbers", "finite intensities", "restore the scan")
    return mean


def _accumulator(dtype: np.dtype[Any], n_bands: int) -> np.dtype[Any]:
    """The narrowest type that holds the sum over the bands exactly, or float64."""
    if dtype.kind == "u" and dtype.itemsize <= 2 and n_bands <= 2**16:
        return np.dtype(np.uint32)
    return np.dtype(np.float64)


def _open_envi(path: Path) -> SpyFile:
    """The ENVI file behind a header that has been checked against it."""
    header = _read_header(path)
    sizes = {key: _whole(header, key, path) for key in _LARGEST}
    for key, size in sizes.items():
        if not 1 <= size <= _LARGEST[key]:
            raise InputError(f"{path}: {key}", str(size)[:_BRIEFLY], f"1 to {_LARGEST[key]}", "restore the header")
    _check_image_size(sizes["lines"], sizes["samples"], path)
    if str(header.get("file type", "ENVI Standard")).lower() != "envi standard":
        found = repr(header["file type"])[:_BRIEFLY]
        raise InputError(f"{path}: file type", found, "ENVI Standard", "convert the scan")
    interleave = str(header.get("interleave", "")).lower()
    if interleave not in _INTERLEAVES:
        found = repr(header.get("interleave"))[:_BRIEFLY]
        raise InputError(f"{path}: interleave", found, f"one of {', '.join(_INTERLEAVES)}", "restore the header")
    code = str(header.get("data type"))
    if code not in _REAL_TYPES:
        expected = f"one of ENVI's types {', '.join(sorted(_REAL_TYPES, key=int))}"
        raise InputError(
            f"{path}: data type", code[:_BRIEFLY], expected, "convert the scan, for example to uint16 (12)"
        )
    offset = _whole(header, "header offset", path) if "header offset" in header else 0
    if str(header.get("byte order")) not in {"0", "1"}:
        found = str(header.get("byte order"))[:_BRIEFLY]
        raise InputError(f"{path}: byte order", found, "0 or 1", "restore the header")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            image: SpyFile = envi.open(str(path.resolve()))
    except envi.EnviDataFileNotFoundError:
        expected = f"{path.stem}.{interleave}, .img, .dat, .raw or .bin beside it"
        raise InputError(str(path), "no data file", expected, "put the data file there") from None
    except (SpyException, ValueError, OSError) as error:
        found = " ".join(str(error).split())
        raise InputError(str(path), found, "an ENVI header with its data file beside it", "restore both") from None
    n_values = sizes["lines"] * sizes["samples"] * sizes["bands"]
    data_path = path.with_name(Path(image.filename).name)
    _check_data_size(data_path, offset + n_values * np.dtype(image.dtype).itemsize, sizes)
    return image


def _check_data_size(path: Path, expected: int, sizes: dict[str, int]) -> None:
    found = path.stat().st_size
    if found != expected:
        told = " x ".join(f"{size} {key}" for key, size in sizes.items())
        kind = "truncated" if found < expected else "longer than its header says"
        remedy = "restore the data file and its header"
        raise InputError(str(path), f"{found} bytes, {kind}", f"{expected} bytes ({told})", remedy)


def _read_header(path: Path) -> dict[str, Any]:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # spectral remarks on capital letters in keys
            header: dict[str, Any] = envi.read_envi_header(str(path))
    except (SpyException, UnicodeDecodeError, IndexError):
        raise InputError(str(path), "a file that is no ENVI header", "an ENVI header", "restore the header") from None
    return header


def _whole(header: dict[str, Any], key: str, path: Path) -> int:
    try:
        return int(header[key])
    except KeyError:
        raise InputError(f"{path}: {key}", "no such key", "a whole number", "restore the header") from None
    except (TypeError, ValueError):
        found = repr(header[key])[:_BRIEFLY]
        raise InputError(f"{path}: {key}", found, "a whole number", "restore the header") from None


def _check_image_size(n_lines: int, n_samples: int, path: Path) -> None:
    if n_lines * n_samples > _LARGEST_IMAGE:
        found = f"{n_lines} lines of {n_samples} samples"
        remedy = "cut the scan into views of the board, or restore the header"
        raise InputError(str(path), found, f"at most {_LARGEST_IMAGE} pixels", remedy)


def read_image(path: Path) -> Intensity:
    """Intensities (L, P) of a PNG or TIFF file, the mean of the channels of a coloured one; lines run downwards.

    Raises InputError where the file is broken, too large or of an unsupported kind.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", Image.DecompressionBombWarning)  # the size is checked here
            image = Image.open(path)
        with image:
            _check_image_size(image.height, image.width, path)
            if image.mode not in _GREY_MODES:
                raise InputError(
                    str(path), f"pixel format {image.mode}", "grey or RGB", "convert the scan to 8 or 16 bit grey"
                )
            values = np.asarray(image, dtype=np.float32)
    except (UnidentifiedImageError, Image.DecompressionBombError, OSError, SyntaxError, ValueError) as error:
        found = " ".join(str(error).split())
        raise InputError(str(path), found, "a whole PNG or TIFF file", "restore the scan") from None
    return values.mean(axis=2, dtype=np.float32) if values.ndim == 3 else values


_READERS: Final[dict[str, Callable[[Path], Intensity]]] = {
    ".hdr": spectral_mean,
    ".png": read_image,
    ".tif": read_image,
    ".tiff": read_image,
}

"""Scans: images of stacked scan lines with a time stamp for each line, read from ENVI, PNG, TIFF or JPEG files.

The time stamps of `NAME.hdr` (or .png, .tif) stand in `NAME-times.csv`, one a row; linepose.inputs.scans.line_times
reads what devices write instead. Whatever a file claims about its size is checked before memory is taken for it.
"""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.inputs.scans.csv_times import read_times
from linepose.inputs.scans.envi_data import open_envi, spectral_mean
from linepose.inputs.scans.pictures import picture_size, read_picture
from linepose.inputs.scans.time_faults import checked_line_times

Intensity = NDArray[np.float32]


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


def read_scan(path: Path, line_times: LineTimes | None = None, n_pixels: int | None = None) -> Scan:
    """The scan of an ENVI header (.hdr), PNG, TIFF or JPEG file, with the time stamps that `line_times` finds for it.

    Without, they stand in `NAME-times.csv`. Raises InputError where a file is missing, truncated, of an unsupported
    kind, contradicts another, or is not `n_pixels` wide, which is told before pixels are read.
    """
    intensity = read_intensity(path, n_pixels)
    times = line_times(path, len(intensity)) if line_times else read_line_times(times_path(path), len(intensity))
    return Scan(intensity, times, path.stem)


def read_intensity(path: Path, n_pixels: int | None = None) -> Intensity:
    """Mean intensities (L, P) of a scan file, without its time stamps; raises InputError like `read_scan`."""
    if not path.is_file():
        raise InputError(str(path), "no such file", "a scan", "restore it, or correct source.scans")
    reader = _READERS.get(path.suffix.lower())
    if reader is None:
        raise InputError(str(path), f"file type {path.suffix!r}", f"one of {', '.join(_READERS)}", "convert the scan")
    return reader(path, n_pixels)


def scan_size(path: Path) -> tuple[int, int]:
    """Lines and pixels of a scan, from its header alone: no intensity is read; raises InputError as `read_scan`."""
    if not path.is_file():
        raise InputError(str(path), "no such file", "a scan", "restore it, or correct source.scans")
    if path.suffix.lower() == ".hdr":
        layout = open_envi(path).layout
        return layout.lines, layout.samples
    if path.suffix.lower() not in _READERS:
        raise InputError(str(path), f"file type {path.suffix!r}", f"one of {', '.join(_READERS)}", "convert the scan")
    return picture_size(path)


def times_path(path: Path) -> Path:
    """Where the time stamps of a scan file stand."""
    return path.with_name(f"{path.stem}-times.csv")


def read_line_times(path: Path, n_lines: int) -> NDArray[np.int64]:
    """Time stamps (n_lines,) in microseconds; raises InputError where they are too few, too many or not increasing."""
    times, heading = read_times(path)
    return checked_line_times(times, n_lines, path, heading)


_READERS: Final[dict[str, Callable[[Path, int | None], Intensity]]] = {
    ".hdr": spectral_mean,
    ".png": read_picture,
    ".tif": read_picture,
    ".tiff": read_picture,
    ".jpg": read_picture,
    ".jpeg": read_picture,
}

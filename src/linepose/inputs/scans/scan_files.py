"""Scans: images of stacked scan lines with a time stamp for each line, read from ENVI, PNG or TIFF files.

The time stamps of `NAME.hdr` (or .png, .tif) stand in `NAME-times.csv`: microseconds since 1970, one a row, below an
optional heading; linepose.inputs.scans.line_times reads what devices write instead. Whatever a file claims about its
size is checked before memory is taken for it.
"""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.inputs.number_files import check_microseconds
from linepose.inputs.scans.envi_data import open_envi, spectral_mean
from linepose.inputs.scans.pictures import picture_size, read_picture

Intensity = NDArray[np.float32]

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


def read_scan(path: Path, line_times: LineTimes | None = None, n_pixels: int | None = None) -> Scan:
    """The scan of an ENVI header (.hdr), PNG or TIFF file, with the time stamps that `line_times` finds for it.

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


_READERS: Final[dict[str, Callable[[Path, int | None], Intensity]]] = {
    ".hdr": spectral_mean,
    ".png": read_picture,
    ".tif": read_picture,
    ".tiff": read_picture,
}

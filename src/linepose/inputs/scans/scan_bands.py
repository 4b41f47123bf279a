"""Chosen bands of a scan at chosen pixels: read where they stand, never the scan as a whole."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linepose.arrays import Floats
from linepose.inputs.scans.envi_data import open_envi
from linepose.inputs.scans.scan_files import read_intensity


@dataclass(frozen=True, eq=False)
class ScanBands:
    """The values of a scan of so many lines, pixels and bands: of an ENVI file, or the one band of a picture.

    `values` returns them all (V,), mapped anew for each use so that pages read earlier do not count as this process's
    memory; `steps`: how far apart in them are lines, pixels and bands.
    """

    shape: tuple[int, int, int]
    dtype: np.dtype[Any]
    values: Callable[[], NDArray[Any]]
    steps: tuple[int, int, int]

    def nearest(self, line: NDArray[np.int64], pixel: NDArray[np.int64], bands: Sequence[int]) -> NDArray[Any]:
        """Values (B, N) of bands (B,), counted from 0, at lines and pixels (N,)."""
        flat = self.values()
        start = line * self.steps[0] + pixel * self.steps[1]
        if self.steps[2] == 1 and len(bands) > 1:  # all bands of a pixel stand together
            n_bands = self.shape[2]
            return np.ascontiguousarray(flat.reshape(-1, n_bands)[start // n_bands][:, list(bands)].T).astype(
                self.dtype
            )
        found = np.empty((len(bands), len(start)), dtype=self.dtype)
        for row, band in enumerate(bands):
            found[row] = flat[start + band * self.steps[2]]
        return found

    def linear(self, line: Floats, pixel: Floats, bands: Sequence[int]) -> NDArray[Any]:
        """Values (B, N) of bands (B,) at fractional lines and pixels (N,), linear between the four around.

        Whole numbers stay such: rounded.
        """
        ends = []
        for at, size in ((line, self.shape[0]), (pixel, self.shape[1])):
            first = np.clip(np.floor(at), 0, max(size - 2, 0)).astype(np.int64)
            share = np.clip(at - first, 0.0, 1.0)
            ends.append(((first, 1 - share), (np.minimum(first + 1, size - 1), share)))
        total = np.zeros((len(bands), len(line)))
        for of_line, line_weight in ends[0]:
            for of_pixel, pixel_weight in ends[1]:
                weight = line_weight * pixel_weight
                total += np.where(weight > 0, self.nearest(of_line, of_pixel, bands) * weight, 0.0)
        return (np.rint(total) if self.dtype.kind in "iu" else total).astype(self.dtype)


def open_bands(path: Path) -> ScanBands:
    """The bands of a scan file; a picture has one, the mean of its channels. Raises InputError as `read_scan`."""
    if path.suffix.lower() != ".hdr":
        intensity = read_intensity(path)
        return ScanBands((*intensity.shape, 1), intensity.dtype, intensity.ravel, (intensity.shape[1], 1, 1))
    file = open_envi(path)
    lines, pixels, bands = file.layout.lines, file.layout.samples, file.layout.bands
    steps = {
        "bil": (bands * pixels, 1, pixels),
        "bip": (bands * pixels, bands, 1),
        "bsq": (pixels, 1, lines * pixels),
    }[file.layout.interleave]
    return ScanBands((lines, pixels, bands), file.dtype.newbyteorder("="), lambda: file.mapped().reshape(-1), steps)

"""Writing scans as ENVI files: band interleaved by line, unsigned 16 bit, and the time stamp of each line beside."""

from collections.abc import Iterable
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from spectral.io.envi import write_envi_header

from linepose.arrays import Floats

_UINT16 = 12  # ENVI's data type code


def write_scan(path: Path, blocks: Iterable[NDArray[np.uint16]], wavelengths_nm: Floats) -> int:
    """Writes `path`.bil and `path`.hdr from blocks of lines (l, B, S), one after the other; returns the lines."""
    lines, bands, samples = 0, 0, 0
    with path.with_suffix(".bil").open("wb") as data:
        for block in blocks:
            lines, bands, samples = lines + block.shape[0], block.shape[1], block.shape[2]
            block.astype("<u2", copy=False).tofile(data)
    header = {
        "description": "simulated line scan",
        "samples": samples,
        "lines": lines,
        "bands": bands,
        "header offset": 0,
        "file type": "ENVI Standard",
        "data type": _UINT16,
        "interleave": "bil",
        "byte order": 0,
        "wavelength units": "nm",
        "wavelength": [f"{one:.2f}" for one in wavelengths_nm],
    }
    write_envi_header(str(path.with_suffix(".hdr")), header)
    return lines


def write_line_times(path: Path, time_us: NDArray[np.int64]) -> None:
    """Writes `path`-times.csv: the time stamp of each line (microseconds), one a row, under a heading."""
    pd.DataFrame({"time_us": time_us}).to_csv(path.with_name(path.name + "-times.csv"), index=False)

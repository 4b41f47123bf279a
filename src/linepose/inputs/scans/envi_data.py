"""Data files of ENVI headers: found beside them, compared with their size, mapped by the package spectral."""

import logging
import os
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray
from spectral.io import envi
from spectral.io.bilfile import BilFile
from spectral.io.bipfile import BipFile
from spectral.io.bsqfile import BsqFile
from spectral.io.spyfile import SpyFile

from linepose.errors import InputError
from linepose.inputs.patterns import check_readable
from linepose.inputs.scans.envi_header import read_envi_header
from linepose.inputs.scans.header_layout import EnviHeader
from linepose.inputs.scans.image_size import check_image_size, check_width

_CHUNK_BYTES: Final = 64_000_000
_BAND_AXES: Final = {"bil": 1, "bip": 2, "bsq": 0}  # axis of the bands in the file
_FILES: Final = {"bil": BilFile, "bip": BipFile, "bsq": BsqFile}
_ENDINGS: Final = ("img", "dat", "hyspex", "raw", "bin", "bil", "bip", "bsq")
_OTHERS: Final = {".hdr", ".csv", ".txt", ".png", ".jpg", ".jpeg", ".json", ".xml", ".nav", ".lcf", ".times", ".tif"}
_NAME_THE_DATA: Final = "put the data file there, or add the line `data file = NAME` to the header"

log = logging.getLogger(__name__)


@dataclass(frozen=True)
class EnviFile:
    """A data file of this layout, whose number of lines agrees with its size."""

    layout: EnviHeader
    path: Path

    @property
    def dtype(self) -> np.dtype[Any]:
        """Type of the values, in the file's byte order."""
        return np.dtype(envi.envi_to_dtype[str(self.layout.data_type)]).newbyteorder(
            "<" if self.layout.byte_order == 0 else ">"
        )

    def mapped(self) -> NDArray[Any]:
        """The values (three axes, in the order of the file), mapped and not read."""
        layout = self.layout
        header = {
            "lines": layout.lines,
            "samples": layout.samples,
            "bands": layout.bands,
            "header offset": layout.offset,
            "data type": layout.data_type,
            "interleave": layout.interleave,
            "byte order": layout.byte_order,
        }
        parameters = envi.gen_params(header)
        parameters.filename = os.fspath(self.path.resolve())
        image: SpyFile = _FILES[layout.interleave](parameters, header)
        return np.asarray(image.open_memmap(interleave="source"))


def spectral_mean(path: Path, n_pixels: int | None = None) -> NDArray[np.float32]:
    """Mean over the bands of an ENVI file; (L, P). The data are mapped, never read as a whole.

    Raises InputError where the header is not one, contradicts the data file, or is not `n_pixels` wide.
    """
    file = open_envi(path)
    layout = file.layout
    check_width(layout.samples, n_pixels, path)
    mean = np.empty((layout.lines, layout.samples), dtype=np.float32)
    accumulator = _accumulator(file.dtype, layout.bands)
    axis = _BAND_AXES[layout.interleave]
    step = max(1, _CHUNK_BYTES // (layout.samples * layout.bands * file.dtype.itemsize))
    for first in range(0, layout.lines, step):
        # mapped anew for each chunk, so that pages read earlier do not count as this process's memory
        lines = file.mapped()
        chunk = lines[:, first : first + step] if axis == 0 else lines[first : first + step]
        mean[first : first + step] = chunk.sum(axis=axis, dtype=accumulator) / np.float32(layout.bands)
    if not np.all(np.isfinite(mean)):
        raise InputError(str(path), "intensities that are no numbers", "finite intensities", "restore the scan")
    return mean


def _accumulator(dtype: np.dtype[Any], n_bands: int) -> np.dtype[Any]:
    """The narrowest type that holds the sum over the bands exactly, or float64."""
    if dtype.kind == "u" and dtype.itemsize <= 2 and n_bands <= 2**16:
        return np.dtype(np.uint32)
    return np.dtype(np.float64)


def open_envi(path: Path) -> EnviFile:
    """The data file of a header, whose size has been checked; raises InputError where one contradicts the other.

    The lines of a broken-off recording (`lines = 0`) follow from the size, and a last line that is not whole is
    passed over with a warning.
    """
    layout = read_envi_header(path)
    check_image_size(layout.lines, layout.samples, path)
    file = EnviFile(layout, _data_path(path, layout.data_file))
    check_readable(file.path)
    size = file.path.stat().st_size
    line_bytes = layout.samples * layout.bands * file.dtype.itemsize
    if layout.lines == 0:
        lines = max(0, size - layout.offset) // line_bytes
        log.warning("%s: lines = 0, as of a broken-off recording: %d lines by the size of the data", path, lines)
        layout = replace(layout, lines=lines)
        check_image_size(lines, layout.samples, path)
    expected = layout.offset + layout.lines * line_bytes
    told = f"{layout.lines} lines x {layout.samples} samples x {layout.bands} bands"
    beyond = size - expected
    if beyond < 0 or layout.lines == 0:
        expected = max(expected, layout.offset + line_bytes)
        raise _wrong_size(file.path, f"{size} bytes, truncated", f"{expected} bytes ({told})")
    if beyond >= line_bytes or (beyond and layout.interleave == "bsq" and layout.bands > 1):
        raise _wrong_size(file.path, f"{size} bytes, longer than its header says", f"{expected} bytes ({told})")
    if beyond:
        log.warning("%s: %d bytes after the last whole line are passed over", file.path, beyond)
    return EnviFile(layout, file.path)


def _wrong_size(path: Path, found: str, expected: str) -> InputError:
    return InputError(str(path), found, expected, "restore the data file and its header")


def _data_path(header: Path, named: str | None) -> Path:
    """The data file beside a header: that which its key `data file` names, else of its name.

    Of its name without an ending or with a usual one, else the only one so named.
    """
    if named is not None:
        given = header.parent / named
        if not given.is_file():
            told, remedy = f"no file {named}, which its key `data file` names", "put it there, or correct the key"
            raise InputError(str(header), told, "the data beside the header", remedy)
        return given
    stem = header.with_suffix("")
    beside = {path.name: path for path in header.parent.iterdir() if path.is_file() and path != header}
    by_lower_case = {name.lower(): path for name, path in sorted(beside.items(), reverse=True)}
    names = (stem.name, *(f"{stem.name}.{ending}" for ending in _ENDINGS))
    usual = [beside.get(name) or by_lower_case.get(name.lower()) for name in names]
    found = list(dict.fromkeys(path for path in usual if path is not None))
    if len(found) > 1:
        told = "%s: %s is read, not %s; where that is wrong, add the line `data file = NAME` to the header"
        log.warning(told, header, found[0].name, " nor ".join(path.name for path in found[1:]))
    if found:
        return found[0]
    others = [path for path in beside.values() if path.stem == stem.name and path.suffix.lower() not in _OTHERS]
    if len(others) == 1:
        return others[0]
    if others:
        found_names = f"{len(others)} files that may be its data: {', '.join(sorted(path.name for path in others)[:3])}"
        raise InputError(str(header), found_names, f"one, or {stem.name}.raw", _NAME_THE_DATA)
    endings = ", ".join(f".{ending}" for ending in _ENDINGS[1:])
    expected = f"{stem.name}.{_ENDINGS[0]}, {endings}, or without an ending, beside it"
    raise InputError(str(header), "no data file", expected, _NAME_THE_DATA)

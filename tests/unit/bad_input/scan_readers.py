"""Readers of scans and of their lines' times."""

import io
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import tifffile
from PIL import Image

from linepose.inputs.scans.line_times import line_times_of
from linepose.inputs.scans.scan_files import read_intensity, scan_size
from linepose.inputs.source import ScansSection
from unit.bad_input.holds import image_holds, times_hold
from unit.bad_input.reader import CASES, TIME_US, Reader, drive, written
from unit.inputs import writers
from unit.inputs.scans import test_time_sources

N_LINES, N_PIXELS, N_BANDS = 12, 8, 3
HEADER = b"""ENVI
samples = 8
lines = 12
bands = 3
header offset = 0
file type = ENVI Standard
data type = 12
interleave = bil
byte order = 0
acquisition date = DATE(yyyy-mm-dd): 2024-05-01
Start Time = UTC TIME: 10:00:00
fps = 100.00
wavelength = { 400.0,
 500.0, 600.0}
"""
ARCGIS = b"nrows 12\nNCOLS         8\nNBANDS 3\nLAYOUT BIL\nNBITS 16\nBYTEORDER I\nBANDROWBYTES 16\nULXMAP 1.5\n"
CUBE = np.arange(N_PIXELS * N_LINES * N_BANDS, dtype="<u2").tobytes()


def _picture(kind: str, mode: str) -> bytes:
    data = io.BytesIO()
    values = np.arange(96, dtype=np.uint16).reshape(N_LINES, N_PIXELS) * 600
    image = Image.fromarray(values) if mode == "I;16" else Image.fromarray((values >> 8).astype(np.uint8)).convert(mode)
    image.save(data, kind)
    return data.getvalue()


def _tiff(**how: Any) -> bytes:
    data = io.BytesIO()
    cube = np.frombuffer(CUBE, dtype="<u2").reshape(N_LINES, N_PIXELS, N_BANDS)
    tifffile.imwrite(data, cube, photometric="rgb", **how)
    return data.getvalue()


def _image(name: str, files: Callable[[], dict[str, bytes]], spoilt: str, scan: str, is_text: bool) -> Reader:
    def read(folder: Path) -> Any:
        scan_size(folder / scan)
        return read_intensity(folder / scan)

    return Reader(name, files, spoilt, read, image_holds, is_text, (f"scan {Path(scan).suffix}",))


def _scans() -> list[Reader]:
    header, arcgis = {"scan.hdr": HEADER, "scan.raw": CUBE}, {"scan.hdr": ARCGIS, "scan.bil": CUBE}
    pictures = {
        "png": ("scan.png", lambda: _picture("PNG", "I;16")),
        "png rgb": ("scan.png", lambda: _picture("PNG", "RGB")),
        "tiff": ("scan.tif", lambda: _picture("TIFF", "I;16")),
        "tiff colour": ("scan.tiff", lambda: _tiff(compression="zlib")),
        "bigtiff": ("scan.tiff", lambda: _tiff(bigtiff=True, rowsperstrip=5)),
        "jpeg": ("scan.jpg", lambda: _picture("JPEG", "RGB")),
        "jpeg grey": ("scan.jpeg", lambda: _picture("JPEG", "L")),
    }
    made = []
    for name, (file, make) in pictures.items():
        files = lambda file=file, make=make: {file: make()}  # noqa: E731
        made.append(_image(name, files, file, file, False))
    return [
        _image("envi header", lambda: header, "scan.hdr", "scan.hdr", True),
        _image("envi data", lambda: header, "scan.raw", "scan.hdr", False),
        _image("arcgis header", lambda: arcgis, "scan.hdr", "scan.hdr", True),
        *made,
    ]


def _times(
    name: str, kind: str, files: Callable[[], dict[str, bytes]], spoilt: str, scan: str = "scan.hdr", **keys: Any
) -> Reader:
    source = ScansSection(kind="scans", time_stamps=kind, **keys)  # type: ignore[arg-type]

    def read(folder: Path) -> Any:
        return line_times_of(source)(folder / scan, N_LINES)

    return Reader(name, files, spoilt, read, times_hold, True, (f"line times {kind}",))


def _events() -> bytes:
    second = test_time_sources.OF_WEEK_S
    return b"".join(test_time_sources.event("MARK2TIME", second + row * 0.01) for row in range(N_LINES))


def _hyspex() -> bytes:
    rows = range(N_LINES)
    return "".join(f"{row} 10.5 60.25 250.5 0.1 0.2 30.0 {280_800 + row * 0.01:.3f}\n" for row in rows).encode()


def _line_times() -> list[Reader]:
    stamps = "\n".join(map(str, TIME_US)).encode() + b"\n"
    texts = "\n".join(f"2024-05-01T12:00:{row:02d}.25Z" for row in range(N_LINES)).encode() + b"\n"
    seconds = "\n".join(f"{time / 1e6:.6f}" for time in TIME_US).encode() + b"\n"
    frames = "Frame#\tTimestamp\n" + "".join(f"{row}\t{time}\n" for row, time in enumerate(TIME_US))
    of_run = "".join(f"{row / 10}\n" for row in range(N_LINES)).encode()
    location = lambda: written(lambda path: writers.write_location(path, drive()), "run.lcf")  # noqa: E731
    resonon = lambda: {"run.times": of_run, "run.lcf": location()}  # noqa: E731
    scan = {"scan.hdr": HEADER, "scan.raw": CUBE}
    specim = lambda: scan | {"scan.nav": (CASES / "specim_nav_nmea" / "scan.nav").read_bytes()}  # noqa: E731
    events = lambda: scan | {"scan.gps": _events()}  # noqa: E731
    drive_events = lambda: scan | {"drive.gps": _events()}  # noqa: E731
    hyspex = lambda: scan | {"scan.txt": _hyspex()}  # noqa: E731
    return [
        _times("csv times", "csv", lambda: {"scan-times.csv": stamps}, "scan-times.csv"),
        _times("csv times as text", "csv", lambda: {"scan-times.csv": texts}, "scan-times.csv"),
        _times("csv times in seconds", "csv", lambda: {"scan-times.csv": seconds}, "scan-times.csv"),
        _times(
            "headwall times",
            "headwall",
            lambda: {"frameIndex_0.txt": frames.encode()},
            "frameIndex_0.txt",
            "raw_0.hdr",
        ),
        _times("resonon times", "resonon", resonon, "run.times", "run.hdr"),
        _times("resonon start", "resonon", resonon, "run.lcf", "run.hdr"),
        _times("specim nav", "specim", specim, "scan.nav"),
        _times("specim header", "specim", lambda: scan, "scan.hdr"),
        _times("hyspex times", "hyspex", hyspex, "scan.txt", gps_week=2290),
        _times("hyspex header", "hyspex", hyspex, "scan.hdr"),
        _times("events", "novatel", events, "scan.gps"),
        _times("events of all scans", "novatel", drive_events, "drive.gps", scans="*.hdr", time_file="drive.gps"),
        _times("rate of the header", "rate", lambda: scan, "scan.hdr"),
    ]


def scan_readers() -> list[Reader]:
    """All of them."""
    return [*_scans(), *_line_times()]

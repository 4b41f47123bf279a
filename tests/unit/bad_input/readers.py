"""Each reader with a folder of whole files, the file that is spoilt, and what must hold of whatever it returns."""

import io
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import pandas as pd
from PIL import Image

from linepose.config.platform import load_platform, platform_faults
from linepose.config.project import load_project
from linepose.config.study import load_dataset
from linepose.config.yaml_file import read_yaml
from linepose.inputs.labels.labelled_views import read_labelled_views
from linepose.inputs.labels.reading import read_point_labels
from linepose.inputs.navigation import read_navigation
from linepose.inputs.navigation.covariance_file import read_covariances
from linepose.inputs.navigation.registry import FORMATS
from linepose.inputs.scans.line_times import line_times_of
from linepose.inputs.scans.scan_files import read_intensity
from linepose.inputs.source import ScansSection
from linepose.pipeline.project_folder import CONFIG
from linepose.survey.observations import OBSERVATIONS
from linepose.tables import read_table, write_table
from unit.inputs import novatel_writer, writers
from unit.inputs.drive import drive_of
from unit.inputs.navigation import test_nmea, test_presets

TIME_US = 1_440_000_000_000_000 + 100_000 * np.arange(12)
CONFIG_FOLDER = Path(__file__).parents[3] / "config"
CASES = Path(__file__).parents[1] / "inputs" / "cases"


@dataclass(frozen=True)
class Reader:
    """A reader: its files by name, which of them is spoilt, what reads the folder, what holds, whether it is text."""

    name: str
    files: dict[str, bytes]
    spoilt: str
    read: Callable[[Path], Any]
    holds: Callable[[Any], bool] = field(default=lambda _: True)
    is_text: bool = True

    def whole(self) -> bytes:
        """The file before it is spoilt."""
        return self.files[self.spoilt]


def log_holds(record: Any) -> bool:
    """Poses in order between 1980 and 2100, of numbers, turned by at most two turns; covariances of numbers."""
    log = record.log
    good = np.all(np.diff(log.time_us) > 0) and log.time_us[0] > 3e14 and log.time_us[-1] < 4.2e15
    good = good and np.all(np.isfinite(log.position_m)) and np.all(np.abs(log.euler_rad) < 12.7)
    if record.covariances is None:
        return bool(good)
    return bool(good and np.all(np.isfinite(record.covariances.covariance)))


def times_hold(times: Any) -> bool:
    """Times of lines in order."""
    return bool(np.all(np.diff(times) > 0) and times[0] > 3e14 and times[-1] < 4.2e15)


def labels_hold(table: pd.DataFrame) -> bool:
    """Points and observations that there are, places of numbers."""
    return bool(table["point"].between(0, 29).all() and np.isfinite(table[["u_px", "line"]]).all(axis=None))


def views_hold(table: pd.DataFrame) -> bool:
    """Points of numbers on the sensor."""
    return bool(np.isfinite(table).all(axis=None) and table["u_px"].between(-0.5, 647.5).all())


@cache
def own_table() -> pd.DataFrame:
    """A short drive in our own table."""
    names = ["north_m", "east_m", "down_m", "roll_rad", "pitch_rad", "yaw_rad"]
    values = np.outer(np.arange(len(TIME_US)), [0.5, 0.2, 0.01, 0.002, 0.001, 0.01])
    return pd.DataFrame(values, columns=names).assign(time_us=TIME_US)


@cache
def drive() -> Any:
    """The same drive near Sydney."""
    return drive_of(own_table(), np.diag([1e-4] * 3 + [1e-6] * 3))


def _written(write: Callable[[Path], Any], name: str) -> bytes:
    with TemporaryDirectory() as folder:
        write(Path(folder) / name)
        return (Path(folder) / name).read_bytes()


def _log(name: str, data: bytes, file: str, is_text: bool = True, **keys: Any) -> Reader:
    section = FORMATS.member(keys["format"]).section(file=file, **keys)
    return Reader(name, {file: data}, file, lambda folder: read_navigation(section, folder), log_holds, is_text)


def _novatel(binary: bool) -> bytes:
    rows = range(len(TIME_US))
    return b"".join(
        novatel_writer.pva("INSPVA", drive(), row, binary) + novatel_writer.stdev(drive(), row, binary) for row in rows
    )


def _odometry(path: Path) -> None:
    with writers.Bag(path, 1) as bag:
        for time in TIME_US:
            bag.odometry("/odometry", time, [1.0, 2.0, 3.0], [0.0, 0.0, 0.0, 1.0], np.eye(6) * 1e-4)


def _fixes(path: Path) -> None:
    with writers.Bag(path, 1) as bag:
        for row, time in enumerate(TIME_US):
            bag.imu("/imu", time, [0.0, 0.0, 0.0, 1.0], np.eye(3) * 1e-6)
            bag.fix("/fix", time, drive().geodetic[row], np.eye(3) * 1e-4)


def _navigation() -> list[Reader]:
    table, geodetic = own_table(), writers.geodetic_table(drive())
    columns = {"time": "t", "position": ("lat", "lon", "h"), "attitude": ("roll", "pitch", "heading")}
    sigmas = {"sigma_position": ("sn", "se", "sd"), "sigma_attitude": ("sr", "sp", "sh")}
    keys = {"format": "table", "columns": columns | sigmas, "time_unit": "s", "coordinates": "geodetic"}
    keys |= {"angle_unit": "degrees"}
    parquet = io.BytesIO()
    table.to_parquet(parquet, index=False)
    days = {"gps_week": 2288}
    return [
        Reader("own csv", {"log.csv": table.to_csv(index=False).encode()}, "log.csv", _own("log.csv"), log_holds),
        Reader(
            "own parquet", {"log.parquet": parquet.getvalue()}, "log.parquet", _own("log.parquet"), log_holds, False
        ),
        _log("table csv", geodetic.to_csv(index=False).encode(), "log.csv", **keys),
        _log(
            "inertial explorer",
            test_presets.INERTIAL_EXPLORER.encode(),
            "log.txt",
            format="table",
            preset="inertial_explorer",
        ),
        _log("pospac", test_presets.POSPAC.encode(), "log.txt", format="table", preset="pospac", **days),
        _log("headwall log", test_presets.HEADWALL.encode(), "log.txt", format="table", preset="headwall"),
        _log("tum", test_presets.TUM.encode(), "log.txt", format="table", preset="tum"),
        _log("oxts", test_presets.OXTS.encode(), "log.csv", format="table", preset="oxts"),
        _log("nmea", "".join([test_nmea.rmc(36_000), *test_nmea.drive()]).encode(), "log.nmea", format="nmea"),
        _log("novatel ascii", _novatel(False), "run.gps", format="novatel"),
        _log("novatel binary", _novatel(True), "run.gps", False, format="novatel"),
        _log(
            "sbet",
            _written(lambda path: writers.write_sbet(path, drive()), "run.out"),
            "run.out",
            False,
            format="sbet",
            gps_week=1859,
        ),
        _log(
            "resonon",
            _written(lambda path: writers.write_location(path, drive()), "run.lcf"),
            "run.lcf",
            format="resonon",
        ),
        _log("rosbag odometry", _written(_odometry, "run.bag"), "run.bag", False, format="rosbag"),
        _log("rosbag fixes", _written(_fixes, "run.bag"), "run.bag", False, format="rosbag"),
    ]


def _own(file: str) -> Callable[[Path], Any]:
    return lambda folder: read_navigation(file, folder)


_HEADER = b"""ENVI
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
_CUBE = np.arange(8 * 12 * 3, dtype="<u2").tobytes()


def _picture(kind: str, mode: str) -> bytes:
    data = io.BytesIO()
    values = np.arange(96, dtype=np.uint16).reshape(12, 8) * 600
    image = Image.fromarray(values) if mode == "I;16" else Image.fromarray((values >> 8).astype(np.uint8)).convert(mode)
    image.save(data, kind)
    return data.getvalue()


def _scans() -> list[Reader]:
    header = {"scan.hdr": _HEADER, "scan.raw": _CUBE}

    def image(name: str) -> Callable[[Path], Any]:
        return lambda folder: read_intensity(folder / name)

    def of_size(mean: Any) -> bool:
        return bool(mean.ndim == 2 and mean.size and np.all(np.isfinite(mean)))

    return [
        Reader("envi header", header, "scan.hdr", image("scan.hdr"), of_size),
        Reader("envi data", header, "scan.raw", image("scan.hdr"), of_size, False),
        Reader("png", {"scan.png": _picture("PNG", "I;16")}, "scan.png", image("scan.png"), of_size, False),
        Reader("png rgb", {"scan.png": _picture("PNG", "RGB")}, "scan.png", image("scan.png"), of_size, False),
        Reader("tiff", {"scan.tif": _picture("TIFF", "I;16")}, "scan.tif", image("scan.tif"), of_size, False),
    ]


def _line_times(name: str, kind: str, files: dict[str, bytes], spoilt: str, scan: str) -> Reader:
    source = ScansSection(kind="scans", time_stamps=kind)  # type: ignore[arg-type]
    return Reader(name, files, spoilt, lambda folder: line_times_of(source)(folder / scan, 12), times_hold)


def _times() -> list[Reader]:
    stamps = "\n".join(map(str, TIME_US)).encode() + b"\n"
    texts = "\n".join(f"2024-05-01T12:00:{row:02d}.25Z" for row in range(12)).encode() + b"\n"
    seconds = "\n".join(f"{time / 1e6:.6f}" for time in TIME_US).encode() + b"\n"
    frames = "Frame#\tTimestamp\n" + "".join(f"{row}\t{time}\n" for row, time in enumerate(TIME_US))
    location = _written(lambda path: writers.write_location(path, drive()), "run.lcf")
    of_run = "".join(f"{row / 10}\n" for row in range(12)).encode()
    nav = (CASES / "specim_nav_nmea" / "scan.nav").read_bytes()
    specim = {"scan.hdr": _HEADER, "scan.raw": _CUBE, "scan.nav": nav}
    return [
        _line_times("csv times", "csv", {"scan-times.csv": stamps}, "scan-times.csv", "scan.hdr"),
        _line_times("csv times as text", "csv", {"scan-times.csv": texts}, "scan-times.csv", "scan.hdr"),
        _line_times("csv times in seconds", "csv", {"scan-times.csv": seconds}, "scan-times.csv", "scan.hdr"),
        _line_times(
            "headwall times", "headwall", {"frameIndex_0.txt": frames.encode()}, "frameIndex_0.txt", "raw_0.hdr"
        ),
        _line_times("resonon times", "resonon", {"run.times": of_run, "run.lcf": location}, "run.times", "run.hdr"),
        _line_times("specim nav", "specim", specim, "scan.nav", "scan.hdr"),
        _line_times(
            "specim header", "specim", {name: specim[name] for name in ("scan.hdr", "scan.raw")}, "scan.hdr", "scan.hdr"
        ),
    ]


_CVAT = b"""<?xml version="1.0" encoding="utf-8"?>
<annotations><version>1.1</version>
<image id="0" name="run-01.png" width="640" height="100">
<points label="point" points="10.5,20.5"><attribute name="id">7</attribute></points>
<points label="8" points="30.5,40.5"></points>
</image></annotations>
"""
_LABELS = b"observation,point,u_px,line\n1,0,10.5,20\n1,1,30.25,40\n1,2,50,60.5\n"


def _label(name: str, data: bytes, file: str) -> Reader:
    scans = {1: Path("run-01.hdr")}
    return Reader(name, {file: data}, file, lambda folder: read_point_labels(folder, file, scans, 640), labels_hold)


def _numbers() -> list[Reader]:
    covariance = np.diag(np.full(12, 1e-4)).ravel()
    rows = [",".join([str(time), *(f"{one:g}" for one in covariance)]) for time in TIME_US[:3]]
    view = "".join(f"{time},{row},{300 + row},6.2,3.3,-1,0.01,0.02,0.3\n" for row, time in enumerate(TIME_US))

    def views(folder: Path) -> pd.DataFrame:
        return read_labelled_views([folder / "view.csv"], 648)

    return [
        Reader(
            "covariances",
            {"nav.csv": "\n".join(rows).encode()},
            "nav.csv",
            lambda at: read_covariances(at / "nav.csv", (3, 4, 5)),
        ),
        Reader("labelled views", {"view.csv": view.encode()}, "view.csv", views, views_hold),
    ]


def _platform(folder: Path) -> None:
    platform_faults(folder, "made-up")
    load_platform(folder, "made-up")


def _study(folder: Path) -> None:
    load_project(read_yaml(folder / CONFIG.name), folder)


def _configuration() -> list[Reader]:
    platform = (CONFIG_FOLDER / "platforms" / "shrimp-sim.yaml").read_bytes()
    study = (CONFIG_FOLDER / "config.yaml").read_bytes().partition(b"datasets:")[0]
    study += (CONFIG_FOLDER / "config.yaml").read_bytes().partition(b"\n\ncoverage:")[2].join([b"coverage:", b""])
    lines = [line for line in study.splitlines(keepends=True) if not line.startswith(b"  - ladybird")]
    study = b"".join(lines)
    study += b"platforms_folder: .\n"
    data = (CONFIG_FOLDER / "datasets" / "ladybird.yaml").read_bytes()
    return [
        Reader("platform yaml", {"made-up.yaml": platform}, "made-up.yaml", _platform),
        Reader("config yaml", {"config.yaml": study, "shrimp-sim.yaml": platform}, "config.yaml", _study),
        Reader(
            "data set yaml",
            {"ladybird.yaml": data},
            "ladybird.yaml",
            lambda folder: load_dataset(folder / "ladybird.yaml"),
        ),
    ]


def _results() -> list[Reader]:
    table = pd.DataFrame({one.name: np.arange(1, 9, dtype=one.type.to_pandas_dtype()) for one in OBSERVATIONS})
    data = _written(lambda path: write_table(table, path, OBSERVATIONS), "observations.parquet")

    def same(found: pd.DataFrame) -> bool:
        return found[table.columns.tolist()].equals(table)

    read = lambda folder: read_table(folder / "observations.parquet", OBSERVATIONS)  # noqa: E731
    return [Reader("results parquet", {"observations.parquet": data}, "observations.parquet", read, same, False)]


@cache
def readers() -> dict[str, Reader]:
    """All readers by their names."""
    labels = [
        _label("labels csv", _LABELS, "labels.csv"),
        _label("cvat", _CVAT, "annotations.xml"),
        _label("labelme", (CASES / "labelme_group_id" / "run-01.json").read_bytes(), "run-01.json"),
    ]
    found = [*_navigation(), *_scans(), *_times(), *labels, *_numbers(), *_configuration(), *_results()]
    return {one.name: one for one in found}


READERS = (
    "own csv",
    "own parquet",
    "table csv",
    "inertial explorer",
    "pospac",
    "headwall log",
    "tum",
    "oxts",
    "nmea",
    "novatel ascii",
    "novatel binary",
    "sbet",
    "resonon",
    "rosbag odometry",
    "rosbag fixes",
    "envi header",
    "envi data",
    "png",
    "png rgb",
    "tiff",
    "csv times",
    "csv times as text",
    "csv times in seconds",
    "headwall times",
    "resonon times",
    "specim nav",
    "specim header",
    "labels csv",
    "cvat",
    "labelme",
    "covariances",
    "labelled views",
    "platform yaml",
    "config yaml",
    "data set yaml",
    "results parquet",
)

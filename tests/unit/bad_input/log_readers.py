"""Readers of navigation logs that are no bags: our own tables, others' tables, and what devices write."""

import io
from collections.abc import Callable
from pathlib import Path
from typing import Any

from linepose.inputs.navigation import read_navigation
from linepose.inputs.navigation.registry import FORMATS, recognised
from unit.bad_input.holds import log_holds
from unit.bad_input.reader import TIME_US, Reader, drive, own_table, written
from unit.inputs import novatel_writer, writers
from unit.inputs.navigation import test_autopilots, test_nmea, test_presets


def log_reader(
    name: str,
    make: Callable[[], bytes],
    file: str,
    is_text: bool = True,
    package: str | None = None,
    of: tuple[str, ...] = (),
    **keys: Any,
) -> Reader:
    """The reader of a log of one file, of a format with its keys; the file is recognised first, as `new` does."""
    preset = (f"preset {keys['preset']}",) if "preset" in keys else ()

    def read(folder: Path) -> Any:
        recognised(folder / file)
        section = FORMATS.member(keys["format"]).section(file=file, **keys)
        return read_navigation(section, folder)

    covered = (f"navigation format {keys['format']}", *preset, *of)
    return Reader(name, lambda: {file: make()}, file, read, log_holds, is_text, covered, package)


def _own(name: str, file: str, make: Callable[[], bytes], is_text: bool) -> Reader:
    return Reader(
        name, lambda: {file: make()}, file, lambda folder: read_navigation(file, folder), log_holds, is_text, (name,)
    )


def _parquet() -> bytes:
    data = io.BytesIO()
    own_table().to_parquet(data, index=False)
    return data.getvalue()


def _geodetic_parquet() -> bytes:
    data = io.BytesIO()
    writers.geodetic_table(drive()).to_parquet(data, index=False)
    return data.getvalue()


def _novatel(binary: bool) -> bytes:
    rows = range(len(TIME_US))
    return b"".join(
        novatel_writer.pva("INSPVA", drive(), row, binary) + novatel_writer.stdev(drive(), row, binary) for row in rows
    )


def _presets() -> list[Reader]:
    week = {"gps_week": 2288}
    keys: dict[str, dict[str, Any]] = {
        "inertial_explorer": {},
        "pospac": week,
        "hyspex": week,
        "headwall": {},
        "tum": {},
        "oxts": {},
        "rtklib": {"columns": {"attitude": ("8", "9", "10")}},
    }
    return [
        log_reader(f"preset {name}", test_presets.TEXTS[name].encode, "log.txt", format="table", preset=name, **more)
        for name, more in keys.items()
    ]


def _kitti(name: str, spoilt: str) -> Reader:
    rest = " ".join(["0"] * 24)
    rows = {
        f"oxts/data/{number:010d}.txt": f"-33.8892 151.1937 42.5 0.1 -0.2 1.5 {rest}\n".encode() for number in range(3)
    }
    times = "".join(f"2023-11-14 22:13:20.{number}50000000\n" for number in (2, 3, 4)).encode()

    def read(folder: Path) -> Any:
        recognised(folder / spoilt)
        section = FORMATS.member("table").section(format="table", file="oxts/data/*.txt", preset="kitti")
        return read_navigation(section, folder)

    return Reader(name, lambda: rows | {"oxts/timestamps.txt": times}, spoilt, read, log_holds, True, ("preset kitti",))


def _attitude_log() -> Reader:
    attitudes = "t,roll,pitch,yaw\n" + "".join(f"{1_700_000_000.25 + row / 10:.3f},5,-10,30\n" for row in range(2))
    columns = {"time": "t", "attitude": ("roll", "pitch", "yaw")}
    section = {"file": "ahrs.csv", "time_unit": "s", "angle_unit": "degrees", "columns": columns}

    def read(folder: Path) -> Any:
        keys = {"format": "table", "file": "log.pos", "preset": "rtklib", "attitude_log": section}
        return read_navigation(FORMATS.member("table").section(**keys), folder)

    files = {"log.pos": test_presets.RTKLIB.encode(), "ahrs.csv": attitudes.encode()}
    return Reader("attitude log", lambda: files, "ahrs.csv", read, log_holds, True, ("attitude log",))


def log_readers() -> list[Reader]:
    """All of them."""
    columns = {"time": "t", "position": ("lat", "lon", "h"), "attitude": ("roll", "pitch", "heading")}
    sigmas = {"sigma_position": ("sn", "se", "sd"), "sigma_attitude": ("sr", "sp", "sh")}
    keys: dict[str, Any] = {"format": "table", "columns": columns | sigmas, "time_unit": "s", "angle_unit": "degrees"}
    keys |= {"coordinates": "geodetic"}
    geodetic = lambda: writers.geodetic_table(drive()).to_csv(index=False).encode()  # noqa: E731
    sbet = lambda: written(lambda path: writers.write_sbet(path, drive()), "run.out")  # noqa: E731
    location = lambda: written(lambda path: writers.write_location(path, drive()), "run.lcf")  # noqa: E731
    nmea = lambda: "".join([test_nmea.rmc(36_000), *test_nmea.drive()]).encode()  # noqa: E731
    ulog = lambda: written(test_autopilots.ulog, "flight.ulg")  # noqa: E731
    dataflash = lambda: written(test_autopilots.dataflash, "flight.bin")  # noqa: E731
    return [
        _own("own csv", "log.csv", lambda: own_table().to_csv(index=False).encode(), True),
        _own("own parquet", "log.parquet", _parquet, False),
        log_reader("table csv", geodetic, "log.csv", **keys),
        log_reader("table parquet", _geodetic_parquet, "log.parquet", False, **keys),
        *_presets(),
        _kitti("preset kitti", "oxts/data/0000000001.txt"),
        _kitti("kitti times", "oxts/timestamps.txt"),
        _attitude_log(),
        log_reader("nmea", nmea, "log.nmea", format="nmea"),
        log_reader("novatel ascii", lambda: _novatel(False), "run.gps", format="novatel"),
        log_reader("novatel binary", lambda: _novatel(True), "run.gps", False, format="novatel"),
        log_reader("sbet", sbet, "run.out", False, format="sbet", gps_week=1859),
        log_reader("resonon", location, "run.lcf", format="resonon"),
        log_reader("px4", ulog, "flight.ulg", False, "pyulog", format="px4"),
        log_reader("ardupilot", dataflash, "flight.bin", False, "pymavlink", format="ardupilot"),
    ]

"""Poses of an autopilot's log: attitudes and positions since it was switched on, and when that was by GPS."""

import importlib
import logging
import os
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryFile
from types import ModuleType
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, PositiveFloat

from linepose.arrays import Floats
from linepose.errors import InputError, printable
from linepose.inputs.navigation.format import GeodeticSection
from linepose.inputs.navigation.poses import Poses, check_increasing
from linepose.inputs.navigation.positions_between import DEFAULT_GAP_S, positions_between
from linepose.inputs.navigation.usable_rows import placed, usable_rows

Stamps = NDArray[np.int64]

_STDERR: Final = 2

log = logging.getLogger(__name__)


class AutopilotSection(GeodeticSection):
    """What both formats of autopilots may say."""

    maximum_fix_gap_s: PositiveFloat = Field(
        DEFAULT_GAP_S, description="Longest time between two positions over which they are interpolated (s)."
    )


@dataclass(frozen=True)
class FlightLog:
    """What an autopilot logged, at times (us) since it was switched on.

    `euler_rad` (A, 3) at `attitude_us`; `geodetic` (F, 3), latitude, longitude (deg), height (m), at `fix_us`; and
    `unix_us` (G,) that GPS said at `gps_us`. `names` are those of the three kinds of message.
    """

    attitude_us: Stamps
    euler_rad: Floats
    fix_us: Stamps
    geodetic: Floats
    gps_us: Stamps
    unix_us: Stamps
    names: tuple[str, str, str]


def begins_with(path: Path, start: bytes) -> dict[str, Any] | None:
    """No keys for a file that begins so; None for any other."""
    if path.is_dir():
        return None
    with path.open("rb") as file:
        return {} if file.read(len(start)) == start else None


def package(name: str, path: Path) -> ModuleType:
    """A package of the extra `autopilot`; raises InputError that names it where it is not installed."""
    try:
        return importlib.import_module(name)
    except ImportError:
        found, expected = f"no package {name.partition('.')[0]}", "it, to read an autopilot's log"
        raise InputError(str(path), found, expected, "pip install 'linepose[autopilot]'") from None


@contextmanager
def told_in_one_line(path: Path, name: str) -> Iterator[list[str]]:
    """What a package prints of broken parts of a log, a line a byte at worst, becomes one warning that counts it.

    The caller may add remarks to the list.
    """
    remarks: list[str] = []
    with TemporaryFile("w+", errors="replace") as said:
        with redirect_stdout(said), redirect_stderr(said), _compiled_stderr(said.fileno()):
            yield remarks
        said.flush()
        said.seek(0)
        remarks += [line.strip() for line in said if line.strip()]
    if remarks:
        told = "%s: parts of the log are broken and left out: %d remarks of %s, the first: %s"
        log.warning(told, path, len(remarks), name, printable(remarks[0]))


@contextmanager
def _compiled_stderr(to: int) -> Iterator[None]:
    """What compiled code writes to the standard error goes to this file descriptor."""
    kept = os.dup(_STDERR)
    try:
        os.dup2(to, _STDERR)
        yield
    finally:
        os.dup2(kept, _STDERR)
        os.close(kept)


def autopilot_poses(flight: FlightLog, path: Path, maximum_gap_s: float) -> Poses:
    """Poses at the times of the attitudes, in Unix time, with positions linear between those of the log.

    Raises InputError naming the message that the log lacks.
    """
    for name, times in zip(flight.names, (flight.attitude_us, flight.fix_us, flight.gps_us), strict=True):
        if len(times) < 2:
            found, expected = f"{len(times)} messages {name}", "two or more"
            raise InputError(str(path), found, expected, f"log {name} throughout the drive, with a fix")
    started_us = int(np.median(flight.unix_us - flight.gps_us))
    log.warning("%s: times are those of the GPS messages (%s), which come late by up to 0.2 s", path, flight.names[2])
    fix_us, geodetic = _used(flight.fix_us, flight.geodetic, f"{path}, {flight.names[1]}")
    kept = placed(geodetic, f"{path}, {flight.names[1]}")
    fix_us, geodetic = fix_us[kept], geodetic[kept]
    attitude_us, euler = _used(flight.attitude_us, flight.euler_rad, f"{path}, {flight.names[0]}")
    place = f"{path}, {flight.names[0]}"
    between = positions_between(attitude_us, fix_us, geodetic, maximum_gap_s, place)
    return Poses(attitude_us[between.near] + started_us, between.position, euler[between.near], place, between.gap_key)


def _used(times: Stamps, values: Floats, place: str) -> tuple[Stamps, Floats]:
    rows = usable_rows(times, values, place)
    check_increasing(times[rows], place, rows + 1)
    return times[rows], values[rows]

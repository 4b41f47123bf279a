"""Keys of the format `table` for a text log whose heading names its columns as people do: time, lat, lon, roll, ..."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np

_HEAD_BYTES: Final = 20_000
_LINES_ABOVE: Final = 50  # within which the heading must stand
_FULL_TURN_RAD: Final = 2 * np.pi
_WEEK_S: Final = 604_800
_UNIT_S: Final = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}
_CALENDAR_S: Final = {"unix": (1.1e9, 4.1e9), "gps": (0.78e9, 3.8e9)}  # 2005 to 2100
_UNITS: Final = {
    "s": "s", "sec": "s", "secs": "s", "seconds": "s", "ms": "ms", "msec": "ms", "us": "us", "µs": "us", "usec": "us",
    "ns": "ns", "nsec": "ns", "deg": "degrees", "degree": "degrees", "degrees": "degrees", "°": "degrees",
    "rad": "radians", "radians": "radians", "m": "m", "metres": "m", "meters": "m",
}  # fmt: skip

_TIME: Final = (
    "time", "timestamp", "time_stamp", "t", "stamp", "unix", "gps", "unix_time", "unixtime", "epoch", "utc",
    "utc_time", "datetime", "date_time", "gps_time", "gpstime", "gps_seconds", "gps_sow", "sow", "tow", "gps_tow",
    "time_of_week",
)  # fmt: skip
_WEEK: Final = ("week", "gps_week", "gpsweek")
_NORTH: Final = ("north", "northing", "n", "pos_north", "position_north", "x_north")
_EAST: Final = ("east", "easting", "e", "pos_east", "position_east", "x_east")
_DOWN: Final = ("down", "d", "pos_down", "position_down")
_X: Final = ("x", "pos_x")
_HEIGHT: Final = (
    "height", "alt", "altitude", "h", "hgt", "h_ell", "ellipsoid_height", "ellipsoidal_height", "elevation", "ele",
)  # fmt: skip
_POSITIONS: Final[Mapping[str, Sequence[tuple[Sequence[str], ...]]]] = {
    "geodetic": [(("latitude", "lat"), ("longitude", "lon", "long", "lng"), _HEIGHT)],
    "ned": [(_NORTH, _EAST, _DOWN)],
    "enu": [(_EAST, _NORTH, ("up", "u", "z", *_HEIGHT)), (_X, ("y", "pos_y"), ("z", "pos_z"))],
}
_HEADING: Final = ("heading", "azimuth", "hdg", "true_heading")
_ATTITUDES: Final[Sequence[tuple[Sequence[str], ...]]] = [
    (("roll", "phi"), ("pitch", "theta"), (*_HEADING, "yaw", "psi")),
    tuple((f"q{one}", f"q_{one}", f"quat_{one}", f"orientation_{one}") for one in "xyzw"),
]
_SIGMA_BEFORE: Final = ("sd_", "sigma_", "std_", "stddev_")
_SIGMA_BEHIND: Final = ("_sd", "_sigma", "_std", "_stddev")
_SIGMAS_NED: Final = (
    (*_NORTH, "lat", "latitude"),
    (*_EAST, "lon", "longitude"),
    (*_DOWN, "up", "u", *_HEIGHT),
)


@dataclass(frozen=True)
class _Heading:
    """The names of a log's columns as they are written, and what each is called and measured in."""

    names: tuple[str, ...]
    plain: tuple[str, ...]
    units: tuple[str | None, ...]
    rows: tuple[tuple[str, ...], ...]  # of cells, from the start, the middle and the end of the log

    def find(self, wanted: Sequence[str]) -> str | None:
        """The first column of one of these names; earlier names count first."""
        return next((self.names[self.plain.index(one)] for one in wanted if one in self.plain), None)

    def find_all(self, wanted: Sequence[Sequence[str]]) -> tuple[str, ...] | None:
        """A column for each of these, all different; None where one is missing."""
        found = [self.find(one) for one in wanted]
        return tuple(filter(None, found)) if all(found) and len(set(found)) == len(found) else None

    def unit(self, name: str) -> str | None:
        """The unit that a column's name says."""
        return self.units[self.names.index(name)]

    def cells(self, name: str) -> list[str]:
        """A column's cells in the rows that were looked into."""
        return [row[self.names.index(name)] for row in self.rows]

    def numbers(self, name: str, decimal: str) -> np.ndarray:
        """A column's numbers there; empty where one is none."""
        try:
            return np.array([float(cell.replace(decimal, ".")) for cell in self.cells(name) if cell])
        except ValueError:
            return np.empty(0)


def keys_by_names(path: Path) -> dict[str, Any] | None:
    """The keys of a text log by the names of its columns and the size of its numbers; None where these do not tell all.

    A guess in what no name says: angles beyond a full turn of radians are degrees, times are in the unit in which they
    lie in this century, and quaternions, or angles beside x, y, z, have the axes of ROS.
    """
    try:
        pieces = _pieces(path)
    except OSError:
        return None
    if any("\0" in piece for piece in pieces):
        return None
    for delimiter in ("\t", ";", ",", " "):
        keys = _keys(pieces, delimiter)
        if keys is not None:
            return keys
    return None


def _pieces(path: Path) -> list[str]:
    """The start of a file, and whole lines of its middle and its end where it is long."""
    with path.open("rb") as file:
        size = file.seek(0, 2)
        starts = [0] if size < 3 * _HEAD_BYTES else [0, size // 2, size - _HEAD_BYTES]
        pieces = []
        for start in starts:
            file.seek(start)
            lines = file.read(_HEAD_BYTES).decode("utf-8-sig", errors="replace").split("\n")
            whole = lines[:-1] if start + _HEAD_BYTES < size else lines
            pieces.append("\n".join(whole if start == 0 else whole[1:]))
    return pieces


def _keys(pieces: Sequence[str], delimiter: str) -> dict[str, Any] | None:
    lines = pieces[0].splitlines()
    for row, line in enumerate(lines[:_LINES_ABOVE]):
        sign = line.lstrip()[:1] if line.lstrip()[:1] in {"#", "%"} else ""
        names = _cells(line.lstrip().removeprefix(sign), delimiter)
        plain, units = zip(*map(_plain, names), strict=True) if names else ((), ())
        if "" in plain or len(set(names)) < len(names) or not set(_TIME) & set(plain):
            continue
        below = [_cells(one, delimiter) for one in lines[row + 1 :] if one.strip() and one.lstrip()[:1] != sign]
        unit_rows = next((at for at, cells in enumerate(below) if _is_row(cells)), len(below))
        further = [_cells(one, delimiter) for piece in pieces[1:] for one in piece.splitlines()]
        rows = [tuple(one) for one in below[unit_rows:] + further if len(one) == len(names)]
        found = _columns(_Heading(tuple(names), plain, units, tuple(rows))) if rows else None
        if found is None:
            continue
        layout: dict[str, Any] = {"delimiter": delimiter} if delimiter != "," else {}
        if any(one.strip() for one in lines[:row]) or sign:
            layout["heading_words"] = [found["columns"]["time"], *found["columns"]["position"]]
        layout |= {"comment": sign} if sign else {}
        layout |= {"unit_rows": unit_rows} if unit_rows else {}
        return layout | found
    return None


def _cells(line: str, delimiter: str) -> list[str]:
    parts = line.split() if delimiter == " " else line.split(delimiter)
    return [part.strip().strip('"') for part in parts]


def _is_row(cells: Sequence[str]) -> bool:
    """Whether a line is one of values: more than half of its cells begin like a number."""
    return sum(bool(re.match(r"[-+]?\.?\d", cell)) for cell in cells) > len(cells) / 2


def _plain(name: str) -> tuple[str, str | None]:
    """What a column is called, in lower case without its unit, and the unit."""
    inside = re.search(r"[\[(]\s*(.*?)\s*[\])]", name)
    said = re.sub(r"[\[(].*?[\])]", "", name).strip().lower()
    said = re.sub(r"[^a-z0-9°µ]+", "_", said).strip("_")
    words = said.split("_")
    unit = next((_UNITS[one] for one in (inside[1].lower().split() if inside else ()) if one in _UNITS), None)
    if len(words) > 1 and words[-1] in _UNITS:
        return "_".join(words[:-1]), unit or _UNITS[words[-1]]
    return said, unit


def _columns(heading: _Heading) -> dict[str, Any] | None:
    """Columns, clock, axes and units; None where the names do not tell a time, a position and an attitude."""
    time = heading.find(_TIME)
    places = ((axes, heading.find_all(one)) for axes, ways in _POSITIONS.items() for one in ways)
    axes, position = next(((axes, found) for axes, found in places if found), ("", None))
    attitude = next(filter(None, map(heading.find_all, _ATTITUDES)), None)
    if time is None or position is None or attitude is None:
        return None
    decimal = "," if any(re.fullmatch(r"[-+]?\d+,\d+", cell) for cell in heading.cells(position[0])) else "."
    week = heading.find(_WEEK)
    clock = _clock(heading, time, week, decimal)
    if clock is None:
        return None
    columns: dict[str, Any] = {"time": time, "position": list(position), "attitude": list(attitude)}
    columns |= {"week": week} if week and clock.get("time_scale") == "gps_week" else {}
    unit = _angle_unit(heading, attitude, decimal)
    columns |= _sigmas(heading, axes, attitude, unit)
    keys: dict[str, Any] = clock | {"coordinates": axes} | ({"decimal": decimal} if decimal != "." else {})
    if len(attitude) == 3:
        keys["angle_unit"] = unit
    if axes == "enu" and (len(attitude) > 3 or _plain(position[0])[0] in _X):  # as robots have it, and not maps
        keys["attitude_axes"] = "enu"
    if axes == "geodetic":
        keys |= _latitude_unit(heading, position[0])
    return keys | {"columns": columns}


def _clock(heading: _Heading, time: str, week: str | None, decimal: str) -> dict[str, str] | None:
    """`time_scale` and `time_unit`; None where neither the name nor the size of the times tells them."""
    of_gps = _plain(time)[0].startswith("gps")
    first = next(filter(None, heading.cells(time)), "")
    if re.match(r"\d{4}[-/]\d\d[-/]\d\d[T ]", first):
        return {"time_scale": "gps_iso" if of_gps else "iso"}
    times = heading.numbers(time, decimal)
    if not times.size:
        return None
    said = heading.unit(time)
    scale = "gps" if of_gps else "unix"
    low, high = _CALENDAR_S[scale]
    for unit in _UNIT_S if said is None else [said] if said in _UNIT_S else []:
        if low <= times.min() * _UNIT_S[unit] and times.max() * _UNIT_S[unit] <= high:
            return {"time_scale": scale, "time_unit": unit}
    unit = said if said in _UNIT_S else "s"
    counts_in_week = week is not None or of_gps or _plain(time)[0] in {"sow", "tow", "time_of_week"}
    if counts_in_week and times.min() >= 0 and times.max() * _UNIT_S[unit] <= _WEEK_S:
        return {"time_scale": "gps_week", "time_unit": unit}
    return None


def _angle_unit(heading: _Heading, attitude: Sequence[str], decimal: str) -> str:
    """What the names say, else degrees where an angle goes beyond a full turn of radians."""
    said = next((unit for unit in map(heading.unit, attitude) if unit in {"degrees", "radians"}), None)
    largest = max((abs(heading.numbers(one, decimal)).max(initial=0.0) for one in attitude), default=0.0)
    return said or ("degrees" if largest > _FULL_TURN_RAD else "radians")


def _latitude_unit(heading: _Heading, latitude: str) -> dict[str, str]:
    if heading.unit(latitude) == "radians":
        return {"latitude_unit": "radians"}
    is_number = all(re.fullmatch(r"[-+]?[\d.,eE+-]+", cell) for cell in heading.cells(latitude) if cell)
    return {} if is_number else {"latitude_unit": "dms"}


def _sigmas(heading: _Heading, axes: str, attitude: Sequence[str], unit: str) -> dict[str, list[str]]:
    """The columns of standard deviations, where there are those of all positions and, in their unit, of all angles."""

    def named(names: Sequence[str]) -> list[str]:
        return [f"{one}{name}" for name in names for one in _SIGMA_BEFORE] + [
            f"{name}{one}" for name in names for one in _SIGMA_BEHIND
        ]

    of_position = heading.find_all([named(one) for one in _SIGMAS_NED])
    ways = [one for one in _ATTITUDES if len(one) == 3]
    of_attitude = heading.find_all([named(one) for one in ways[0]]) if len(attitude) == 3 else None
    if of_position is None or of_attitude is None or {heading.unit(one) for one in of_attitude} - {None, unit}:
        return {}
    north, east, down = of_position
    return {
        "sigma_position": [east, north, down] if axes == "enu" else [north, east, down],
        "sigma_attitude": list(of_attitude),
    }

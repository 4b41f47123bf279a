"""From latitude, longitude and ellipsoidal height (WGS 84) to north, east, down in metres, and back.

Two frames: the plane that touches the ellipsoid at an origin (lengths and angles are true, for surveys of a few
kilometres), or a projected CRS such as UTM (the map's own coordinates; lengths of UTM differ by up to 0.1 %, and north
is the grid's, so that headings are turned by the meridian convergence). Heights are never scaled, so that a
system whose lengths are far from true is told, or refused.
"""

import logging
from dataclasses import dataclass
from functools import cache
from typing import Final

import numpy as np
import pyarrow as pa
from numpy.typing import ArrayLike
from pyproj import CRS, Proj, Transformer
from pyproj.exceptions import CRSError, ProjError

from linepose.arrays import Floats, exact_decimal
from linepose.errors import InputError
from linepose.geometry import rotations
from linepose.inputs.axes import NED_FROM_ENU
from linepose.tables import optional_floats, texts

GEODETIC: Final = "EPSG:4979"  # WGS 84: latitude, longitude (deg), ellipsoidal height (m)

_TOLD_SCALE_ERROR: Final = 1e-3  # of a system's lengths: that of UTM at the edge of a zone
_LARGEST_SCALE_ERROR: Final = 1e-2  # as large as the best lever arms are known: 1 cm of 1 m
_FARTHEST_M: Final = 1e5  # of local coordinates from their origin: eastings of UTM are larger
_HIGHEST_M: Final = 2e4
_MARGIN_DEG: Final = 3.0  # around the area that a projected system is made for

log = logging.getLogger(__name__)

MAP_FRAME: Final = pa.schema([*texts("crs"), *optional_floats("latitude_deg", "longitude_deg", "height_m")])


@dataclass(frozen=True)
class LocalFrame:
    """What north, east, down are measured in: a projected `crs`, or the tangent plane at `origin`.

    `origin` is latitude, longitude (deg) and ellipsoidal height (m), None for a projected CRS.
    """

    crs: str
    origin: tuple[float, float, float] | None


def tangent_frame(origin: tuple[float, float, float]) -> LocalFrame:
    """North, east, down from an origin at latitude, longitude (deg) and height (m)."""
    return LocalFrame(GEODETIC, origin)


def projected_frame(crs: str) -> LocalFrame:
    """Northing, easting and minus the height of a projected CRS ("EPSG:32633"); raises InputError for any other.

    So does one that counts in feet: all lengths are metres.
    """
    place, expected = "source.navigation.crs", "a projected CRS in metres, for example EPSG:32633"
    known = _projected_crs(crs)
    if known is None:
        raise InputError(place, repr(crs), expected, "correct or remove the key")
    units = {axis.unit_name for axis in known.axis_info if axis.unit_conversion_factor != 1.0}
    if units:
        found = f"{crs!r}, which counts in units of {', '.join(sorted(units))}"
        raise InputError(place, found, expected, "give a system of the place in metres, or remove the key")
    return LocalFrame(crs, None)


def check_is_near(frame: LocalFrame, latitude_deg: float, longitude_deg: float, place: str) -> None:
    """Raise InputError where a projected CRS is made for another part of the Earth than this position.

    So does one whose metres are none there, such as Web Mercator's.
    """
    known = _projected_crs(frame.crs)
    if known is None:
        return
    area = known.area_of_use
    if area is not None and not _is_within(area.bounds, latitude_deg, longitude_deg):
        raise InputError(
            place,
            f"{frame.crs}, made for {area.name}, with positions at {latitude_deg:.2f}, {longitude_deg:.2f} deg",
            f"a system of the place, such as {utm_crs(latitude_deg, longitude_deg)}",
            "correct or remove the key",
        )
    _check_scale(frame, latitude_deg, longitude_deg, place)


def _is_within(bounds: tuple[float, float, float, float], latitude_deg: float, longitude_deg: float) -> bool:
    """Whether a place lies in an area of west, south, east and north (deg), or a margin around it."""
    west, south, east, north = bounds
    east_of_west = (longitude_deg - west + _MARGIN_DEG) % 360.0
    width = east - west + (360.0 if east < west else 0.0) + 2 * _MARGIN_DEG
    return east_of_west <= width and south - _MARGIN_DEG <= latitude_deg <= north + _MARGIN_DEG


def _check_scale(frame: LocalFrame, latitude_deg: float, longitude_deg: float, place: str) -> None:
    factors = _projection(frame.crs).get_factors(longitude_deg, latitude_deg)
    worst = max(factors.meridional_scale, factors.parallel_scale, key=lambda scale: abs(scale - 1.0))
    better = utm_crs(latitude_deg, longitude_deg)
    where = f"{latitude_deg:.2f}, {longitude_deg:.2f} deg"
    if not abs(worst - 1.0) <= _LARGEST_SCALE_ERROR:
        raise InputError(
            place,
            f"{frame.crs}, in which a metre is {worst:.3f} m long at {where}",
            f"a system of true lengths there, such as {better}",
            "correct or remove the key",
        )
    if abs(worst - 1.0) > _TOLD_SCALE_ERROR:
        told = "%s: in %s a metre is %.4f m long at %s, but heights are true; %s is closer"
        log.warning(told, place, frame.crs, worst, where, better)


def utm_crs(latitude_deg: float, longitude_deg: float) -> str:
    """EPSG code of the UTM zone (WGS 84) by longitude alone."""
    zone = int((longitude_deg + 180.0) % 360.0 // 6.0) + 1
    return f"EPSG:{(32600 if latitude_deg >= 0 else 32700) + zone}"


def local_from_geodetic(frame: LocalFrame, geodetic: ArrayLike) -> tuple[Floats, Floats]:
    """Positions (K, 3) north, east, down (m), and turns (K, 3, 3), of latitude, longitude (deg), height (m) (K, 3).

    A turn takes vectors from true north, east, down at the point to the axes of the frame.
    """
    latitude, longitude, height = np.asarray(geodetic, dtype=float).T
    if frame.origin is None:
        east, north = _to_projected(frame.crs).transform(longitude, latitude)
        convergence = np.deg2rad(_projection(frame.crs).get_factors(longitude, latitude).meridian_convergence)
        about_down = np.stack([np.zeros_like(height), np.zeros_like(height), -convergence], axis=-1)
        return np.stack([north, east, -height], axis=-1), rotations.matrix_from_euler(about_down)
    enu = np.stack(_topocentric(frame.origin).transform(longitude, latitude, height), axis=-1)
    return enu @ NED_FROM_ENU.T, ecef_from_ned(frame.origin[0], frame.origin[1]).T @ ecef_from_ned(latitude, longitude)


def geodetic_from_local(frame: LocalFrame, position_m: ArrayLike) -> Floats:
    """Latitude, longitude (deg), ellipsoidal height (m) of positions north, east, down (m); (K, 3) to (K, 3)."""
    position = np.asarray(position_m, dtype=float)
    if frame.origin is None:
        longitude, latitude = _to_projected(frame.crs).transform(position[:, 1], position[:, 0], direction="INVERSE")
        return np.stack([latitude, longitude, -position[:, 2]], axis=-1)
    enu = position @ NED_FROM_ENU
    east, north, up = enu.T
    longitude, latitude, height = _topocentric(frame.origin).transform(east, north, up, direction="INVERSE")
    return np.stack([latitude, longitude, height], axis=-1)


def check_local(position_m: ArrayLike, key: str, projected_key: str) -> None:
    """Raise InputError where all positions north, east, down (m) (K, 3) are too far from their origin to be local.

    `key` is what gave the origin, `projected_key` what stands in its place for coordinates of a projected system.
    """
    position = np.asarray(position_m, dtype=float)
    known = position[np.isfinite(position).all(axis=-1)]
    if not len(known):
        return
    level, height = np.hypot(known[:, 0], known[:, 1]), np.abs(known[:, 2])
    if level.min() <= _FARTHEST_M and height.min() <= _HIGHEST_M:
        return
    north, east, down = known[int(np.argmin(level + height))] / 1e3
    raise InputError(
        key,
        f"positions {north:.0f} km north, {east:.0f} km east and {-down:.0f} km above it",
        f"local coordinates, within {_FARTHEST_M / 1e3:.0f} km of their origin and {_HIGHEST_M / 1e3:.0f} km in height",
        f"write {projected_key}: EPSG:... in its place where they are northings and eastings of a projected system, "
        "or correct the origin",
    )


def check_geodetic(geodetic: Floats, place: str) -> None:
    """Raise InputError naming the first row of (K, 3) that is no latitude, longitude (deg) and height (m)."""
    wrong = np.flatnonzero(
        ~np.all(np.isfinite(geodetic), axis=1) | (np.abs(geodetic[:, 0]) > 90) | (np.abs(geodetic[:, 1]) > 360)
    )
    if wrong.size:
        latitude, longitude, height = geodetic[wrong[0]]
        raise InputError(
            f"{place}, record {wrong[0] + 1}",
            f"latitude {latitude:g}, longitude {longitude:g} deg, height {height:g} m",
            "a place on Earth",
            "check the columns and their unit, or remove the record",
        )


def ecef_from_ned(latitude_deg: ArrayLike, longitude_deg: ArrayLike) -> Floats:
    """Matrices (..., 3, 3) whose columns are north, east and down in Earth-fixed axes."""
    latitude, longitude = np.deg2rad(latitude_deg), np.deg2rad(longitude_deg)
    sin_lat, cos_lat, sin_lon, cos_lon = np.sin(latitude), np.cos(latitude), np.sin(longitude), np.cos(longitude)
    north = np.stack([-sin_lat * cos_lon, -sin_lat * sin_lon, cos_lat], axis=-1)
    east = np.stack([-sin_lon, cos_lon, np.zeros_like(sin_lon)], axis=-1)
    down = np.stack([-cos_lat * cos_lon, -cos_lat * sin_lon, -sin_lat], axis=-1)
    return np.stack([north, east, down], axis=-1)


def _topocentric(origin: tuple[float, float, float]) -> Transformer:
    latitude, longitude, height = map(exact_decimal, origin)
    return _pipeline(
        "+proj=pipeline +step +proj=unitconvert +xy_in=deg +xy_out=rad +step +proj=cart +ellps=WGS84 "
        f"+step +proj=topocentric +ellps=WGS84 +lat_0={latitude} +lon_0={longitude} +h_0={height}"
    )


@cache
def _projected_crs(crs: str) -> CRS | None:
    """The system of this name; None where there is none, or it is not projected."""
    try:
        known = CRS.from_user_input(crs)
    except CRSError:
        return None
    return known if known.is_projected else None


@cache
def _pipeline(text: str) -> Transformer:
    return Transformer.from_pipeline(text)


@cache
def _to_projected(crs: str) -> Transformer:
    return Transformer.from_crs("EPSG:4326", crs, always_xy=True)


@cache
def _projection(crs: str) -> Proj:
    try:
        return Proj(crs)
    except (CRSError, ProjError):
        raise InputError("source.navigation.crs", repr(crs), "a projected CRS", "correct or remove the key") from None

"""Where north, east and down are on the Earth: easting, northing and height on a map, and WGS84 beside them."""

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import ArrayLike

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.inputs.local_frame import GEODETIC, check_local, geodetic_from_local, tangent_frame, utm_crs

if TYPE_CHECKING:
    from pyproj import CRS, Transformer

Origin = tuple[float, float, float]

_TO_EAST_NORTH_UP: Final = np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]])
_STEP_M: Final = 1.0  # for derivatives of a map that bends over kilometres


@dataclass(frozen=True)
class MapFrame:
    """What a survey's north, east, down are measured in, and the map that points go to.

    `name` is the map's projected reference system. With an `origin` (latitude, longitude in deg, ellipsoidal height in
    m, WGS84) the survey lies in the plane that touches the Earth there; without one north and east are the map's own.
    `key` is what gave the origin, where it was told apart from the positions and may not be theirs.
    """

    name: str
    origin: Origin | None = None
    key: str | None = field(default=None, compare=False)

    @cached_property
    def crs(self) -> "CRS":
        """The map's reference system."""
        from pyproj import CRS

        return CRS.from_user_input(self.name)

    def places(self, north_east_down: ArrayLike) -> Floats:
        """Easting, northing, height (m) of places north, east, down (m); (K, 3) to (K, 3).

        Raises InputError where they are too far from the origin.
        """
        self.check(north_east_down)
        east_north_up = np.asarray(north_east_down, dtype=float) @ _TO_EAST_NORTH_UP.T
        if self.origin is None:
            return east_north_up
        latitude, longitude, height = geodetic_from_local(tangent_frame(self.origin), north_east_down).T
        return np.stack(self._to_geodetic.transform(longitude, latitude, height, direction="INVERSE"), axis=-1)

    def check(self, north_east_down: ArrayLike) -> None:
        """Raise InputError where places north, east, down (K, 3) are too far from an origin that was told apart."""
        if self.key is not None:
            check_local(north_east_down, self.key, "map_frame.crs")

    def covariances(self, north_east_down: ArrayLike, covariance: ArrayLike) -> Floats:
        """Covariance in easting, northing, height of one (K, 3, 3) in north, east, down, at places (K, 3)."""
        at = np.asarray(north_east_down, dtype=float)
        jacobian = np.broadcast_to(_TO_EAST_NORTH_UP, (len(at), 3, 3))
        if self.origin is not None:
            steps = [
                (self.places(at + _STEP_M * axis) - self.places(at - _STEP_M * axis)) / (2 * _STEP_M)
                for axis in np.eye(3)
            ]
            jacobian = np.stack(steps, axis=-1)
        return np.asarray(jacobian @ np.asarray(covariance, dtype=float) @ np.swapaxes(jacobian, -1, -2))

    def wgs84(self, places: ArrayLike) -> Floats:
        """Longitude, latitude (deg) and ellipsoidal height (m) of easting, northing, height (K, 3); (K, 3)."""
        return np.stack(self._to_geodetic.transform(*np.asarray(places, dtype=float).T), axis=-1)

    @cached_property
    def _to_geodetic(self) -> "Transformer":
        from pyproj import Transformer

        return Transformer.from_crs(self.crs.to_3d(), GEODETIC, always_xy=True)


def projected_map(name: str, place: str) -> MapFrame:
    """The map of a projected system in metres, in which north and east are; `place` is what names it, for messages.

    Raises InputError for a system that is not known, or is none such.
    """
    from pyproj import CRS
    from pyproj.exceptions import CRSError

    try:
        crs = CRS.from_user_input(name)
    except CRSError as error:
        found = f"{name!r} ({' '.join(str(error).split())[:80]})"
        raise InputError(place, found, "a code such as EPSG:32756", "correct it") from None
    if not (crs.is_projected and _in_metres(crs)):
        found = f"{name} ({crs.name})"
        raise InputError(place, found, "a projected system in metres", "give the one that north and east are in")
    return MapFrame(name)


def tangent_map(origin: Origin, place: str) -> MapFrame:
    """The map of a survey in the plane that touches the Earth at `origin`: the UTM zone there.

    Raises InputError for an origin that is not on the Earth, or where UTM has no zone.
    """
    latitude, longitude, _ = origin
    if not (-80 <= latitude <= 84 and -180 <= longitude <= 360):
        found = f"latitude {latitude:g}, longitude {longitude:g} deg"
        raise InputError(place, found, "a place between 80 deg south and 84 deg north", "check the order and the unit")
    return MapFrame(utm_crs(latitude, longitude), origin)


def _in_metres(crs: Any) -> bool:
    return all(axis.unit_conversion_factor == 1.0 for axis in crs.axis_info)

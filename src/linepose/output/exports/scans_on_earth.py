"""The scans of a platform that formats of whole scans are written from, and where each stands on the Earth."""

from typing import TYPE_CHECKING, Final, cast

from linepose.errors import InputError

if TYPE_CHECKING:
    from numpy import int64
    from numpy.typing import NDArray

    from linepose.arrays import Floats
    from linepose.output.exports.map_frame import MapFrame
    from linepose.output.map.places import ScanOnMap
    from linepose.output.map.platform_map import PlatformMap
    from linepose.pipeline.calibration import Calibration

EARTH_FIXED: Final = "EPSG:4978"  # WGS84


def maps_of(calibration: "Calibration", format: str) -> "PlatformMap":
    """The map of the platform's scans; raises InputError where there is no folder of them, or none in it."""
    from linepose.config.map import MapSection
    from linepose.output.map.platform_map import platform_map

    _ = calibration.estimate  # a platform that has not been run is told first
    if calibration.data_folder is None:
        found, expected = "no folder of what it recorded", "its scans and its navigation log"
        remedy = f"write linepose export {calibration.name} --format {format}, or give data_folder to from_results"
        raise InputError(f"calibration of {calibration.name}", found, expected, remedy)
    return platform_map(calibration, calibration.platform_file.map or MapSection(), calibration.data_folder)


def number_of(maps: "PlatformMap", name: str | None) -> int:
    """The observation whose scan has this name; of a platform with one scan that one needs no name."""
    names = {path.stem: number for number, path in maps.paths.items()}
    if name is None and len(names) == 1:
        return next(iter(names.values()))
    if name not in names:
        found = "no scan" if name is None else repr(name)
        raise InputError("--scan", found, f"one of {', '.join(names)}", f"write --scan {next(iter(names))}")
    return names[name]


def camera_on_earth(scan: "ScanOnMap", time_us: "NDArray[int64]") -> tuple["Floats", "Floats"]:
    """Earth-fixed positions (K, 3) of the camera (m), and matrices (K, 3, 3) from the body's axes to Earth-fixed ones.

    Raises InputError where the survey does not lie in a plane that touches the Earth, or far from its origin.
    """
    from linepose.geometry.rotations import matrix_from_euler

    position, euler = scan.navigation.pose_at(scan.navigation.log, time_us)
    body = matrix_from_euler(euler + scan.correction[3:])
    frame = frame_on_earth(scan)
    to_earth, offset = _earth_fixed(frame)
    centre = position + scan.correction[:3] + body @ scan.mounted.pose[:3]
    frame.check(centre)
    return centre @ to_earth.T + offset, to_earth @ body


def earth_fixed_places(scan: "ScanOnMap", places: "Floats") -> "Floats":
    """Earth-fixed coordinates (K, 3) of easting, northing, height (K, 3) on the scan's map.

    Raises InputError where the survey does not lie in a plane that touches the Earth.
    """
    import numpy as np
    from pyproj import Transformer

    from linepose.inputs.local_frame import GEODETIC

    longitude, latitude, height = frame_on_earth(scan).wgs84(places).T
    return np.stack(Transformer.from_crs(GEODETIC, EARTH_FIXED).transform(latitude, longitude, height), axis=-1)


def frame_on_earth(scan: "ScanOnMap") -> "MapFrame":
    """The frame of a survey in a plane that touches the Earth; raises InputError for one in any other coordinates."""
    frame, remedy = scan.frame.frame, "give the log in latitude and longitude, with source.navigation.frame: tangent"
    if frame is not None and frame.origin is not None:
        return frame
    if frame is None:
        remedy = f"write map_frame: {{origin: [latitude, longitude, height]}}, or {remedy}"
    else:
        remedy += ", and leave out map_frame; geojson, geopackage and linepose map take a projected system"
    raise InputError(
        "map_frame",
        "coordinates of their own" if frame is None else f"north and east of {frame.name}",
        "a plane that touches the Earth: lengths on a projected map are not those on the ground",
        remedy,
    )


def _earth_fixed(frame: "MapFrame") -> tuple["Floats", "Floats"]:
    """Matrix (3, 3) and offset (3,) that take north, east, down to Earth-fixed coordinates (m)."""
    import numpy as np
    from pyproj import Transformer

    from linepose.inputs.local_frame import GEODETIC, ecef_from_ned

    latitude, longitude, height = cast("tuple[float, float, float]", frame.origin)
    offset = Transformer.from_crs(GEODETIC, EARTH_FIXED).transform(latitude, longitude, height)
    return ecef_from_ned(latitude, longitude), np.array(offset)

"""What APL's aplcorr takes of a camera and of each scan: view vectors and the camera's path; ENVI files in one archive.

APL turns about z, x, y, `R = Rz(heading) Rx(roll) Ry(pitch)` in degrees, from axes forward, right, down to north, east,
down at the line's own latitude and longitude. A pixel looks along `Rz(c) Rx(a) Ry(b) (0, 0, 1)` on the body, with its
a, b, c from the file of view vectors. Its own boresight is added to these angles, which is no rotation: the whole of
the camera's turn stands in the view vectors instead. The path is the camera's, with attitudes in APL's order.
"""

import zipfile
from pathlib import Path
from typing import TYPE_CHECKING, Final

from linepose.errors import InputError
from linepose.output.exports.brown import all_rays
from linepose.output.exports.scans_on_earth import EARTH_FIXED, camera_on_earth, maps_of, number_of
from linepose.output.exports.words import explained
from linepose.pipeline.exports.format import ExportFormat
from linepose.pipeline.exports.options import ExportOptions

if TYPE_CHECKING:
    from linepose.arrays import Floats
    from linepose.geometry.camera import Camera
    from linepose.output.map.places import ScanOnMap
    from linepose.pipeline.calibration import Calibration

_EPOCH: Final = (1980, 1, 1, 0, 0, 0)  # the earliest that an archive can say: the same bytes for the same result
_MODE: Final = 0o644 << 16
_TOLD: Final = """\
DEM has heights above the WGS84 ellipsoid; without -dem, -heightoffset gives that of the ground (m).
The header of a level-1 file has to say binning = {{1, 1}}; none of its lines and samples may be left out.
No -boresight: the camera's turn is in the view vectors (deg). No aplnav: lever arm and clocks are in the
paths, which are the camera's, with attitudes in the order in which APL turns.

For scans that are not here, aplnav makes a path of a navigation file:

    aplnav -leverarm {arm} -boresight 0 0 0 ...

It turns by heading, roll, pitch, navigation systems by heading, pitch, roll: its places are turned about
the vertical by roll times pitch, 0.035 deg where these are 1 and 2 deg.
"""
_ANGLES: Final = ("rotation about X", "rotation about Y", "rotation about Z")
_PATH: Final = ("Time", "Latitude", "Longitude", "Altitude", "Roll", "Pitch", "Heading")


def write_apl(calibration: "Calibration", options: ExportOptions, path: Path) -> None:
    """Write view vectors, the path of each scan or of the one that is chosen, and how aplcorr is called.

    Raises InputError for body axes that APL has not, a platform without scans, or in axes that are not Earth's.
    """
    if options.body_axes == "flu":
        raise InputError("body axes", "flu", "frd, which APL reads", "leave --body-axes out")
    maps = maps_of(calibration, "apl")
    numbers = list(maps.paths) if options.scan is None else [number_of(maps, options.scan)]
    scans = [maps.scan_on_map(number) for number in numbers]
    vectors = view_vectors_deg(calibration.own_camera, calibration.name, scans[0].mounted.turn)
    with zipfile.ZipFile(path, "w") as archive:
        _add(archive, "README.txt", _told(calibration, [scan.name for scan in scans]).encode())
        _add_envi(archive, f"{calibration.name}-fov", vectors[None], _ANGLES)
        for scan in scans:
            _add_envi(archive, f"{scan.name}-nav", path_of(scan)[:, :, None], _PATH)


def view_vectors_deg(camera: "Camera", place: str, turn: "Floats") -> "Floats":
    """Angles about x, y, z (3, P) that lead from straight down to where each pixel looks on the body.

    `turn` is the rotation (3, 3) from camera to body; raises InputError, naming `place`, where a pixel has no ray.
    """
    import numpy as np

    ray = all_rays(camera, place) @ turn.T
    forward, right, down = ray.T / np.linalg.norm(ray, axis=1)
    return np.rad2deg([np.arctan2(-right, down), np.arcsin(np.clip(forward, -1.0, 1.0)), np.zeros_like(down)])


def path_of(scan: "ScanOnMap") -> "Floats":
    """A row a line (L, 7): time (s, Unix), the camera's latitude, longitude (deg), height (m), roll, pitch, heading.

    Attitudes are the body's (deg), in APL's order. Raises InputError where the survey lies in no plane that touches the
    Earth.
    """
    import numpy as np
    from pyproj import Transformer
    from scipy.spatial.transform import Rotation

    from linepose.inputs.local_frame import GEODETIC, ecef_from_ned

    centre, body = camera_on_earth(scan, scan.time_us)
    to_geodetic = Transformer.from_crs(EARTH_FIXED, GEODETIC)
    latitude, longitude, height = to_geodetic.transform(centre[:, 0], centre[:, 1], centre[:, 2])
    level = np.swapaxes(ecef_from_ned(latitude, longitude), -1, -2) @ body
    turns = np.reshape(Rotation.from_matrix(level).as_euler("ZXY", degrees=True), (-1, 3))
    places = np.stack([scan.time_us / 1e6, latitude, longitude, height], axis=-1)
    return np.concatenate([places, turns[:, [1, 2]], turns[:, [0]] % 360.0], axis=1)


def _add(archive: zipfile.ZipFile, name: str, content: bytes) -> None:
    member = zipfile.ZipInfo(name, _EPOCH)
    member.create_system, member.external_attr = 3, _MODE
    archive.writestr(member, content)


def _add_envi(archive: zipfile.ZipFile, name: str, values: "Floats", bands: tuple[str, ...]) -> None:
    """Two members, NAME.bil and its header: values (lines, bands, samples) as doubles."""
    lines, _, samples = values.shape
    header = {
        "samples": samples,
        "lines": lines,
        "bands": len(bands),
        "header offset": 0,
        "file type": "ENVI Standard",
        "data type": 5,
        "interleave": "bil",
        "byte order": 0,
        "band names": f"{{{', '.join(bands)}}}",
    }
    text = "ENVI\n" + "".join(f"{key} = {value}\n" for key, value in header.items())
    _add(archive, f"{name}.bil", values.astype("<f8").tobytes())
    _add(archive, f"{name}.bil.hdr", text.encode())


def _told(calibration: "Calibration", scans: list[str]) -> str:
    """How aplcorr is called with these files, and what they have and have not."""
    estimate = calibration.estimate.in_axes("frd")
    arm = " ".join(f"{value:.4f}" for value in estimate.pose[:3])
    vectors = f"aplcorr -vvSPLIT -vvfile {calibration.name}-fov.bil"
    calls = "".join(
        f"    {vectors} -navfile {scan}-nav.bil -lev1file {scan}.bil -igmfile {scan}-igm.bil -dem DEM\n"
        for scan in scans
    )
    return "\n".join([*explained(calibration, estimate), "", calls, _TOLD.format(arm=arm)])


FORMAT: Final = ExportFormat("apl", "view vectors and paths of the scans for APL's aplcorr", "-apl.zip", write_apl)

"""A scan for ASP and others that read the Community Sensor Model: the state of USGSCSM's line scanner, one scan a file.

What USGSCSM does with a state (`losToEcf` of its line scanner, `Utilities.cpp`, `Distortion.cpp`): an image point has
its first pixel's and first line's centre at 0.5; its time is `m_intTimeStartTimes + m_intTimes (line - m_intTimeLines +
0.5)`. The sample's place on the focal plane is `(sample - m_detectorSampleOrigin) / m_iTransS[2]` (mm); lens distortion
takes `1 - c0 - c1 r^2 - c2 r^4` of it. The look vector is `(-x, -y, -f)` in camera axes. Positions and quaternions (x,
y, z, w, camera to Earth-fixed axes) lie at equal steps of time and are interpolated by Lagrange, of order eight.
"""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from linepose.errors import InputError
from linepose.output.exports.brown import FARTHEST_PX, require_straight
from linepose.output.exports.scans_on_earth import camera_on_earth, earth_fixed_places, maps_of, number_of
from linepose.pipeline.exports.format import ExportFormat
from linepose.pipeline.exports.options import ExportOptions

if TYPE_CHECKING:
    from linepose.arrays import Floats
    from linepose.geometry.camera import Camera
    from linepose.output.map.places import ScanOnMap
    from linepose.pipeline.calibration import Calibration

MODEL: Final = "USGS_ASTRO_LINE_SCANNER_SENSOR_MODEL"
_SEMI_AXES_M: Final = (6378137.0, 6356752.314245179)  # WGS84
_N_PARAMETERS: Final = 16
_FARTHEST_M: Final = 2e-4  # of a ray from that of the map, at the ground
_STEPS_A_LINE: Final = (1, 2, 4, 8)
_ORDER: Final = 8


def write_csm(calibration: "Calibration", options: ExportOptions, path: Path) -> None:
    """Write the state of one scan; raises InputError for a platform without scans, or in axes that are not Earth's."""
    maps = maps_of(calibration, "csm")
    scan = maps.scan_on_map(number_of(maps, options.scan))
    state = csm_state(scan, calibration.name)
    path.write_text(f"{MODEL}\n{json.dumps(state)}\n", encoding="utf-8")


def csm_state(scan: "ScanOnMap", platform: str) -> dict[str, Any]:
    """The state of a scan on the map; times are seconds from its first line."""
    import numpy as np

    camera, lines = scan.mounted.camera, scan.shape[0]
    if lines < 2:
        raise InputError(f"scan {scan.name}", f"{lines} line", "two or more", "export a longer scan")
    middle = scan.places_of([(lines - 1) / 2], [(camera.n_pixels - 1) / 2])
    ends = scan.places_of([(lines - 1) / 2] * 2, [0, camera.n_pixels - 1])
    if not np.all(np.isfinite(np.concatenate([middle, ends]))):
        raise InputError(f"scan {scan.name}", "a middle line that sees no ground", "ground", "correct `map`")
    time_s = (scan.time_us - scan.time_us[0]) / 1e6
    ground = earth_fixed_places(scan, middle)[0]
    times_s, positions, quaternions = _track(scan, time_s, ground)
    swath_m = float(np.linalg.norm(ends[1] - ends[0]))
    step_s = float(times_s[1] - times_s[0])
    intervals = np.append(np.diff(time_s), time_s[-1] - time_s[-2])
    gsd_m = swath_m / (camera.n_pixels - 1)
    return {
        "m_modelName": MODEL,
        "m_imageIdentifier": scan.name,
        "m_sensorName": platform,
        "m_platformIdentifier": platform,
        "m_sensorIdentifier": platform,
        "m_nLines": lines,
        "m_nSamples": camera.n_pixels,
        "m_platformFlag": 1,
        "m_intTimeLines": (np.arange(lines) + 0.5).tolist(),
        "m_intTimeStartTimes": (time_s - 0.5 * intervals).tolist(),
        "m_intTimes": intervals.tolist(),
        "m_startingEphemerisTime": 0.0,
        "m_centerEphemerisTime": float(time_s[-1] / 2),
        "m_ikCode": 0,
        **_optics(camera, platform),
        "m_majorAxis": _SEMI_AXES_M[0],
        "m_minorAxis": _SEMI_AXES_M[1],
        "m_minElevation": -1000.0,
        "m_maxElevation": 10000.0,
        "m_dtEphem": step_s,
        "m_t0Ephem": 0.0,
        "m_dtQuat": step_s,
        "m_t0Quat": 0.0,
        "m_numPositions": positions.size,
        "m_numQuaternions": quaternions.size,
        "m_positions": positions.ravel().tolist(),
        "m_velocities": np.gradient(positions, step_s, axis=0).ravel().tolist(),
        "m_quaternions": quaternions.ravel().tolist(),
        "m_currentParameterValue": [0.0] * _N_PARAMETERS,
        "m_parameterType": [2] * _N_PARAMETERS,
        "m_referencePointXyz": ground.tolist(),
        "m_sunPosition": [0.0, 0.0, 0.0],
        "m_sunVelocity": [],
        "m_gsd": gsd_m,
        "m_flyingHeight": float(np.linalg.norm(positions[len(positions) // 2] - ground)),
        "m_halfSwath": gsd_m * camera.n_pixels / 2,
        "m_halfTime": float(time_s[-1] / 2),
        "m_covariance": [0.0] * _N_PARAMETERS**2,
    }


def _optics(camera: "Camera", place: str) -> dict[str, Any]:
    """Focal length and focal plane in mm, with the radial distortion nearest to our rays."""
    import numpy as np

    from linepose.geometry.camera import normalised_from_pixel

    focal_mm, pitch_mm = 1e3 * camera.focal_length_m, 1e3 * camera.pixel_pitch_m
    require_straight(camera, place, "a CSM line-scan state")
    pixels = np.arange(camera.n_pixels)
    distorted = (pixels - camera.principal_point_px) / camera.focal_length_px
    removed = distorted - normalised_from_pixel(camera, pixels)
    coefficients: Floats = np.zeros(3)
    if np.abs(removed).max() > 1e-12:
        columns = np.stack([distorted**power for power in (1, 3, 5)], axis=1)
        coefficients = np.asarray(np.linalg.lstsq(columns, removed, rcond=None)[0], dtype=float)
        off_px = float(np.abs(columns @ coefficients - removed).max() * camera.focal_length_px)
        if off_px > FARTHEST_PX:
            found = f"a distortion that three radial coefficients miss by {off_px:.2f} px"
            raise InputError(f"camera of {place}", found, f"{FARTHEST_PX} px or less", "export another format")
    return {
        "m_focalLength": focal_mm,
        "m_zDirection": 1.0,
        "m_distortionType": 0,
        "m_opticalDistCoeffs": (coefficients / focal_mm ** np.array([0, 2, 4])).tolist(),
        "m_detectorSampleSumming": 1,
        "m_detectorLineSumming": 1,
        "m_startingDetectorSample": 0.0,
        "m_startingDetectorLine": 0.0,
        "m_iTransS": [0.0, 0.0, 1.0 / pitch_mm],
        "m_iTransL": [0.0, 1.0 / pitch_mm, 0.0],
        "m_detectorSampleOrigin": camera.principal_point_px + 0.5,
        "m_detectorLineOrigin": 0.0,
    }


def _track(scan: "ScanOnMap", time_s: "Floats", ground: "Floats") -> tuple["Floats", "Floats", "Floats"]:
    """Times (K,) at equal steps (s), Earth-fixed positions (K, 3) and quaternions (K, 4), as few as follow the scan.

    Raises InputError where the poses jump, so that no smooth track leads through those of the lines.
    """
    import numpy as np

    at_lines = _poses(scan, time_s)
    range_m = float(np.linalg.norm(at_lines[0][len(time_s) // 2] - ground))
    off_m = np.inf
    for steps in _STEPS_A_LINE:
        times_s = np.linspace(0.0, time_s[-1], steps * (len(time_s) - 1) + 1)
        position, quaternion = _poses(scan, times_s)
        where = time_s / (times_s[1] - times_s[0])
        found = interpolated(position, where), interpolated(quaternion, where)
        of_turn = found[1] / np.linalg.norm(found[1], axis=1)[:, None]
        sign = np.sign(np.sum(of_turn * at_lines[1], axis=1))[:, None]
        turned = 2 * np.linalg.norm(of_turn - sign * at_lines[1], axis=1)
        off_m = float(np.max(np.linalg.norm(found[0] - at_lines[0], axis=1) + range_m * turned))
        if off_m <= _FARTHEST_M:
            return times_s, position, quaternion
    raise InputError(
        f"scan {scan.name}",
        f"poses that a smooth track misses by {1e3 * off_m:.1f} mm on the ground",
        f"{1e3 * _FARTHEST_M:g} mm or less",
        "set navigation.association: interpolate, or use the files of `linepose map`",
    )


def _poses(scan: "ScanOnMap", time_s: "Floats") -> tuple["Floats", "Floats"]:
    """Earth-fixed positions (K, 3) of the camera, and quaternions (K, 4) of CSM's camera axes in Earth-fixed ones."""
    import numpy as np
    from scipy.spatial.transform import Rotation

    centre, body = camera_on_earth(scan, scan.time_us[0] + np.rint(1e6 * time_s).astype(np.int64))
    ours_from_csm = np.array(
        [[0.0, -1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, -1.0]]
    )  # it looks along -z, samples along -y
    quaternion = Rotation.from_matrix(body @ scan.mounted.turn @ ours_from_csm).as_quat()
    flips = np.sign(np.sum(quaternion[1:] * quaternion[:-1], axis=1))
    quaternion[1:] *= np.cumprod(np.where(flips < 0, -1.0, 1.0))[:, None]
    return centre, quaternion


def interpolated(values: "Floats", where: "Floats") -> "Floats":
    """Values (K, ...) at fractional rows (N,), by Lagrange through the eight rows around, fewer at both ends."""
    import numpy as np

    last = len(values) - 1
    index = np.clip(where.astype(int), 0, last - 1)
    share = where - index
    whole = np.zeros((len(where), *values.shape[1:]))
    half = np.minimum(np.minimum(index + 1, last - index), _ORDER // 2)
    for one in np.unique(half):
        rows = np.flatnonzero(half == one)
        nodes = np.arange(1 - one, one + 1)
        for node in nodes:
            others = nodes[nodes != node]
            weight = np.prod((share[rows, None] - others) / (node - others), axis=1)
            whole[rows] += weight[:, None] * values[index[rows] + node]
    return whole


FORMAT: Final = ExportFormat("csm", "line-scan state of USGSCSM, for ASP; of one scan", "-csm.json", write_csm)

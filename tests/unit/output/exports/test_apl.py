"""APL's equations, as its source has them (2017), lead from the files of an archive to the map's ground points."""

import zipfile
from dataclasses import replace

import numpy as np
import pytest

from linepose.errors import InputError
from linepose.output.exports.apl import path_of, view_vectors_deg
from linepose.output.exports.map_frame import MapFrame
from linepose.output.exports.scans_on_earth import maps_of
from linepose.output.map.frame import SurveyMap
from linepose.pipeline.calibration import Calibration
from unit.output.exports.on_earth import PLACE, earth_fixed, on_earth
from unit.output.map.adjusted_platform import adjusted_calibration, adjusted_scans
from unit.output.map.made_up_scan import CAMERA, ORIGIN

MILLIMETRE = 1e-3
FLYING_M = 40.0
WGS84_M = 6378137.0, 6356752.314245179
GROUND_M = PLACE.origin[2] - 1.0
ATTITUDES_DEG = [(0.0, 0.0, 0.0), (8.0, 0.0, 250.0), (0.0, -6.0, 110.0), (-9.0, 7.0, 30.0), (11.0, 9.0, -60.0)]
LENSES = [CAMERA, CAMERA.model_copy(update={"tilt": 0.02, "smile": 0.05, "p2": 0.01})]


def turned(rx, ry, rz, order):
    """`Create3DRotMatrix` (deg)."""
    (sx, sy, sz), (cx, cy, cz) = np.sin(np.deg2rad([rx, ry, rz])), np.cos(np.deg2rad([rx, ry, rz]))
    x = np.array([[1, 0, 0], [0, cx, -sx], [0, sx, cx]])
    y = np.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]])
    z = np.array([[cz, -sz, 0], [sz, cz, 0], [0, 0, 1]])
    return {"RZXY": z @ x @ y, "RXZY": x @ z @ y}[order]


def from_llh(latitude, longitude, height):
    """`ConvertLLH2XYZ` of a geodetic latitude."""
    a, b = WGS84_M
    lat, lon = np.deg2rad([latitude, longitude])
    normal = a * a / np.hypot(a * np.cos(lat), b * np.sin(lat))
    level = (normal + height) * np.cos(lat)
    return np.array([level * np.cos(lon), level * np.sin(lon), (b * b / (a * a) * normal + height) * np.sin(lat)])


def to_ecef(vector, latitude, longitude, roll, pitch, heading):
    """The latter half of `GetVVinECEFXYZ`: by attitude to the local level, by place to Earth-fixed axes."""
    level = turned(roll, pitch, heading, "RZXY") @ vector
    return turned(0.0, -(90 + latitude), longitude, "RXZY") @ level


def on_the_ellipsoid(origin, look, offset):
    """`GetDistanceToEllipsoid`, and the point at that distance."""
    a2, b2 = (np.array(WGS84_M) + offset) ** 2
    weight = np.array([1 / a2, 1 / a2, 1 / b2])
    a, b, c = look**2 @ weight, 2 * origin * look @ weight, origin**2 @ weight - 1
    distance = min((-b + np.sqrt(b * b - 4 * a * c)) / (2 * a), (-b - np.sqrt(b * b - 4 * a * c)) / (2 * a), key=abs)
    assert distance > 0
    return origin + distance * look


def its_ray(path, vector):
    """Origin and direction (3,) of a pixel with these angles (3,) on this line (7,); aplcorr with `-vvSPLIT`."""
    _, latitude, longitude, height, roll, pitch, heading = path
    sensor = turned(*vector, "RZXY") @ [0.0, 0.0, 1.0]
    return from_llh(latitude, longitude, height), to_ecef(sensor, latitude, longitude, roll, pitch, heading)


def farthest_m(strip, path, vectors):
    lines, pixels = [0, strip.shape[0] // 2, strip.shape[0] - 1], np.array([0, 7, 30, strip.shape[1] - 1])
    ours = {line: earth_fixed(strip.places(line, line + 1).place_m[0, :, pixels]) for line in lines}
    return max(
        np.linalg.norm(on_the_ellipsoid(*its_ray(path[line], vectors[:, pixel]), GROUND_M) - place)
        for line in lines
        for pixel, place in zip(pixels, ours[line], strict=True)
    )


@pytest.mark.parametrize("attitude_deg", ATTITUDES_DEG)
@pytest.mark.parametrize("lens", LENSES)
def test_places_are_those_of_the_map_at_any_attitude(lens, attitude_deg):
    strip = on_earth(camera=lens, height_m=FLYING_M, correction=np.array([0.1, -0.05, 0.02, 1e-3, -2e-3, 3e-3]))
    log = replace(strip.navigation.log, euler_rad=strip.navigation.log.euler_rad + np.deg2rad(attitude_deg))
    strip = replace(strip, navigation=replace(strip.navigation, log=log))
    vectors = view_vectors_deg(lens, "robot", strip.mounted.turn)
    assert farthest_m(strip, path_of(strip), vectors) < MILLIMETRE


def test_aplnav_s_path_is_ours_but_for_roll_times_pitch():
    """What the archive tells of scans that it has no path of: lever arm as it is, no boresight."""
    arm = np.array([0.2, -0.1, -0.8])
    level = from_llh(*PLACE.origin)
    for roll, pitch in ((0.0, 2.0), (1.0, 0.0), (1.0, 2.0)):
        heading, pitched, rolled = turned(0, 0, 70.0, "RZXY"), turned(0, pitch, 0, "RZXY"), turned(roll, 0, 0, "RZXY")
        ours = heading @ pitched @ rolled
        theirs = turned(roll, pitch, 70.0, "RZXY")
        about_down_deg = np.rad2deg((theirs.T @ ours - (theirs.T @ ours).T)[1, 0] / 2)
        assert abs(about_down_deg) == pytest.approx(np.deg2rad(roll) * pitch, abs=1e-4)
        placed = level + to_ecef(arm, *PLACE.origin[:2], roll, pitch, 70.0)
        down = turned(0.0, -(90 + PLACE.origin[0]), PLACE.origin[1], "RXZY")
        allowed = MILLIMETRE if roll * pitch == 0 else np.deg2rad(1.1 * roll * np.deg2rad(pitch)) * np.linalg.norm(arm)
        np.testing.assert_allclose(placed, level + down @ ours @ arm, rtol=0, atol=allowed)


class Archive:
    """Members of an archive, read as `BILReader` does: by header, as doubles in (lines, bands, samples)."""

    def __init__(self, path):
        with zipfile.ZipFile(path) as archive:
            assert archive.testzip() is None
            self.members = {name: archive.read(name) for name in archive.namelist()}

    def bil(self, name):
        lines = [line.split("=", 1) for line in self.members[f"{name}.hdr"].decode().splitlines() if "=" in line]
        header = {key.strip().lower(): value.strip() for key, value in lines}
        assert (header["interleave"], header["data type"], header["byte order"]) == ("bil", "5", "0")
        size = [int(header[key]) for key in ("lines", "bands", "samples")]
        assert len(self.members[name]) == 8 * np.prod(size)
        return np.frombuffer(self.members[name], "<f8").reshape(size)


def test_an_archive_has_the_paths_of_all_scans_or_of_one(tmp_path):
    platform, data = adjusted_scans(tmp_path, 2, map_frame={"origin": list(PLACE.origin)})
    calibration = adjusted_calibration(platform, tmp_path / "robot", data)
    whole = Archive(calibration.export("apl", tmp_path / "whole.zip"))
    assert [name for name in whole.members if name.endswith("-nav.bil")] == [
        "observation-01-nav.bil",
        "observation-02-nav.bil",
    ]
    vectors, path = whole.bil("robot-fov.bil"), whole.bil("observation-02-nav.bil")
    assert vectors.shape == (1, 3, calibration.own_camera.n_pixels)
    assert path.shape[1:] == (7, 1)
    said = whole.members["README.txt"].decode()
    assert "-vvfile robot-fov.bil -navfile observation-02-nav.bil -lev1file observation-02.bil" in said
    arm = " ".join(f"{value:.4f}" for value in calibration.position_m)
    assert f"aplnav -leverarm {arm} -boresight 0 0 0" in said
    one = calibration.export("apl", tmp_path / "one.zip", scan="observation-02")
    again = calibration.export("apl", tmp_path / "again.zip", scan="observation-02")
    assert one.read_bytes() == again.read_bytes()
    assert Archive(one).bil("observation-02-nav.bil").tolist() == path.tolist()
    assert "observation-01-nav.bil" not in Archive(one).members
    strip = maps_of(calibration, "apl").scan_on_map(2)
    for line, pixel in ((0, 0), (strip.shape[0] - 1, strip.shape[1] - 1)):
        place = earth_fixed(strip.places(line, line + 1).place_m[0, :, [pixel]])[0]
        origin, look = its_ray(path[line, :, 0], vectors[0, :, pixel])
        assert np.linalg.norm(np.cross(place - origin, look)) < MILLIMETRE < (place - origin) @ look


def test_it_refuses_what_apl_cannot_have(tmp_path):
    platform, data = adjusted_scans(tmp_path, 1, map_frame={"origin": list(PLACE.origin)})
    calibration = adjusted_calibration(platform, tmp_path / "robot", data)
    with pytest.raises(InputError, match="frd, which APL reads"):
        calibration.export("apl", tmp_path / "x.zip", body_axes="flu")
    with pytest.raises(InputError, match=r"--scan: found 'none', expected one of observation-01"):
        calibration.export("apl", tmp_path / "x.zip", scan="none")
    without = Calibration.from_results(tmp_path / "robot", platform)
    with pytest.raises(InputError, match="write linepose export robot --format apl"):
        without.export("apl", tmp_path / "x.zip")
    with pytest.raises(InputError, match="lengths on a projected map are not those on the ground"):
        path_of(replace(on_earth(), frame=SurveyMap(MapFrame("EPSG:32756"))))
    with pytest.raises(InputError, match=r"found coordinates of their own.*write map_frame: \{origin"):
        path_of(replace(on_earth(), frame=SurveyMap(None)))


def test_a_log_in_northings_is_not_taken_as_local_to_an_origin():
    strip = replace(on_earth(), frame=SurveyMap(replace(PLACE, key="robot.yaml: map_frame.origin")))
    assert path_of(strip).tolist() == path_of(on_earth()).tolist()
    log = replace(strip.navigation.log, position_m=strip.navigation.log.position_m + ORIGIN)
    with pytest.raises(InputError, match=r"robot.yaml: map_frame.origin: found positions 6248 km north, 333 km east"):
        path_of(replace(strip, navigation=replace(strip.navigation, log=log)))

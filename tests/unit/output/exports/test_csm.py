"""A scan as USGSCSM's line scanner has it: its equations, as its source has them, lead to the map's ground points."""

import json
from dataclasses import replace

import numpy as np
import pytest

from linepose.errors import InputError
from linepose.output.exports.csm import MODEL, csm_state
from linepose.output.exports.map_frame import MapFrame
from linepose.output.map.frame import SurveyMap
from linepose.pipeline.calibration import Calibration
from linepose.survey.navigation_log import nearest_pose
from unit import made_up
from unit.output.exports.on_earth import PLACE, TO_GEODETIC, earth_fixed, on_earth
from unit.output.map.adjusted_platform import adjusted_calibration, adjusted_scans
from unit.output.map.made_up_scan import CAMERA

MILLIMETRE = 1e-3


def lagrange(values, start, step, time):
    """`lagrangeInterp` of USGSCSM."""
    place = (time - start) / step
    index = min(max(int(place), 0), len(values) - 2)
    if index >= 3 and index < len(values) - 4:
        order = 8
    elif index >= 2 and index < len(values) - 3:
        order = 6
    elif index >= 1 and index < len(values) - 2:
        order = 4
    else:
        order = 2
    nodes = [index - order // 2 + 1 + k for k in range(order)]
    return sum(
        np.prod([(place - other) / (node - other) for other in nodes if other != node]) * values[node] for node in nodes
    )


def ray(state, line, sample):
    """Centre and direction (3,) by `losToEcf` of USGSCSM; line and sample count the first centre as 0.5."""
    k = max(int(np.searchsorted(state["m_intTimeLines"], line, side="right")) - 1, 0)
    time = state["m_intTimeStartTimes"][k] + state["m_intTimes"][k] * (line - state["m_intTimeLines"][k] + 0.5)
    positions = np.reshape(state["m_positions"], (-1, 3))
    quaternions = np.reshape(state["m_quaternions"], (-1, 4))
    assert (positions.size, quaternions.size) == (state["m_numPositions"], state["m_numQuaternions"])
    centre = lagrange(positions, state["m_t0Ephem"], state["m_dtEphem"], time)
    (_, m11, m12), (_, m21, m22) = state["m_iTransL"], state["m_iTransS"]
    t1 = state["m_startingDetectorLine"] - state["m_detectorLineOrigin"]
    t2 = sample * state["m_detectorSampleSumming"] + state["m_startingDetectorSample"] - state["m_detectorSampleOrigin"]
    determinant = m11 * m22 - m12 * m21
    x, y = (m22 * t1 - m12 * t2) / determinant, (m11 * t2 - m21 * t1) / determinant
    c0, c1, c2 = state["m_opticalDistCoeffs"]
    kept = 1 - (c0 + (x * x + y * y) * (c1 + (x * x + y * y) * c2))
    look = np.array([-x * kept * state["m_zDirection"], -y * kept * state["m_zDirection"], -state["m_focalLength"]])
    a, b, c, d = lagrange(quaternions, state["m_t0Quat"], state["m_dtQuat"], time)
    n = np.sqrt(a * a + b * b + c * c + d * d)
    a, b, c, d = a / n, b / n, c / n, d / n
    matrix = [
        [a * a - b * b - c * c + d * d, 2 * (a * b - c * d), 2 * (a * c + b * d)],
        [2 * (a * b + c * d), -a * a + b * b - c * c + d * d, 2 * (b * c - a * d)],
        [2 * (a * c - b * d), 2 * (b * c + a * d), -a * a - b * b + c * c + d * d],
    ]
    return centre, np.array(matrix) @ look / np.linalg.norm(look)


def farthest_m(strip, state):
    """How far the map's places lie off the state's rays, over lines and pixels of the whole scan."""
    lines = np.linspace(0, strip.shape[0] - 1, 9).astype(int)
    pixels = np.linspace(0, strip.shape[1] - 1, 5).astype(int)
    far = []
    for line in lines:
        places = earth_fixed(strip.places(line, line + 1).place_m[0, :, pixels])
        for pixel, place in zip(pixels, places, strict=True):
            centre, direction = ray(state, line + 0.5, pixel + 0.5)
            assert (place - centre) @ direction > 0
            far.append(np.linalg.norm(np.cross(place - centre, direction)))
    return max(far)


@pytest.mark.parametrize("jitter_us", [0, 4000])
def test_rays_of_the_state_meet_the_map_s_ground_points(jitter_us):
    strip = on_earth(correction=np.array([0.1, -0.05, 0.02, 1e-3, -2e-3, 3e-3]))
    late = np.random.default_rng(1).integers(-jitter_us, jitter_us + 1, len(strip.time_us))
    strip = replace(strip, time_us=strip.time_us + late)
    state = json.loads(json.dumps(csm_state(strip, "robot")))
    assert farthest_m(strip, state) < MILLIMETRE
    assert state["m_nLines"] == strip.shape[0]
    reference = np.array(state["m_referencePointXyz"])
    height = TO_GEODETIC.transform(*reference)[2]
    assert height == pytest.approx(PLACE.origin[2] - 1.0, abs=0.01)
    assert 3.0 < state["m_flyingHeight"] < 6.0
    assert state["m_gsd"] == pytest.approx(state["m_flyingHeight"] / CAMERA.focal_length_px, rel=0.3)


def test_what_usgscsm_asks_for_is_there_in_its_types():
    """It reads each of these keys by name, whole numbers as such."""
    state = csm_state(on_earth(), "robot")
    whole = {"m_nLines", "m_nSamples", "m_platformFlag", "m_detectorSampleSumming", "m_detectorLineSumming"}
    whole |= {"m_ikCode", "m_distortionType", "m_numPositions", "m_numQuaternions"}
    assert all(type(state[key]) is int for key in whole)
    assert state["m_modelName"] == MODEL
    assert len(state["m_covariance"]) == len(state["m_currentParameterValue"]) ** 2 == 256
    assert len(state["m_velocities"]) == len(state["m_positions"])


def test_a_projected_map_and_poses_that_jump_are_refused():
    with pytest.raises(InputError, match="lengths on a projected map are not those on the ground"):
        csm_state(replace(on_earth(), frame=SurveyMap(MapFrame("EPSG:32756"))), "robot")
    with pytest.raises(InputError, match=r"found coordinates of their own.*write map_frame: \{origin"):
        csm_state(replace(on_earth(), frame=SurveyMap(None)), "robot")
    strip = on_earth()
    jumping = replace(strip, navigation=replace(strip.navigation, pose_at=nearest_pose))
    late = np.random.default_rng(1).integers(-30_000, 30_001, len(strip.time_us))
    with pytest.raises(InputError, match=r"set navigation\.association: interpolate"):
        csm_state(replace(jumping, time_us=strip.time_us + late), "robot")


def test_a_platform_s_scan_is_exported_by_its_name(tmp_path):
    platform, data = adjusted_scans(tmp_path, 2, map_frame={"origin": list(PLACE.origin)})
    calibration = adjusted_calibration(platform, tmp_path / "robot", data)
    with pytest.raises(InputError, match=r"--scan: found no scan, expected one of observation-01, observation-02"):
        calibration.export("csm", tmp_path / "out.json")
    name, text = calibration.export("csm", tmp_path / "out.json", scan="observation-02").read_text().split("\n", 1)
    state = json.loads(text)
    assert (name, state["m_imageIdentifier"], state["m_sensorName"]) == (MODEL, "observation-02", "robot")
    pair = made_up.TABLES["adjusted_intrinsics"][0]().set_index("parameter")["value"]
    assert state["m_detectorSampleOrigin"] == pair["principal_point_px"] + 0.5
    assert state["m_focalLength"] == pytest.approx(1e3 * pair["focal_length_m"])
    without = Calibration.from_results(tmp_path / "robot", platform)
    with pytest.raises(InputError, match="no folder of what it recorded"):
        without.export("csm", tmp_path / "out.json", scan="observation-02")

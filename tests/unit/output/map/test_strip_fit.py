"""Overlapping strips of a small flight over flat textured ground, at the truth and with a boresight that is off."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from linepose.config.map import MapSection
from linepose.config.platform import Platform
from linepose.errors import InputError
from linepose.geometry import rotations
from linepose.geometry.camera import Camera
from linepose.inputs.navigation import log_covariances, read_navigation
from linepose.inputs.observed_points import select_scans
from linepose.output.exports.map_frame import MapFrame
from linepose.output.map.frame import SurveyMap
from linepose.output.map.ground import flat_ground
from linepose.output.map.places import Navigation, ScanOnMap
from linepose.output.map.platform_map import PlatformMap
from linepose.output.map.sources import MountedCamera
from linepose.output.map.strip_fit import FIT_TABLES, strip_fit
from linepose.simulation.flight_section import (
    FlightErrorSection,
    FlightSection,
    StripSection,
    TexturedGroundSection,
)
from linepose.simulation.flown_record import write_flight
from linepose.survey.navigation_log import POSE_AT
from linepose.tables import read_table, write_table

CAMERA = Camera(focal_length_m=8e-3, pixel_pitch_m=24e-6, n_pixels=200, principal_point_px=99.5)
HEIGHT_M, APART_M, PIXEL_M = 40.0, 6.0, 40.0 * 3e-3
OFF_RAD = np.deg2rad(0.6)
FLIGHT = FlightSection(
    seed=8,
    true_position_m=(0.0, 0.0, 0.0),
    true_euler_deg=(0.0, 0.0, 90.0),
    strips=[
        StripSection(north_m=0, east_m=east, heading_deg=heading, height_m=HEIGHT_M, duration_s=4.0)
        for east, heading in ((-APART_M / 2, 0), (APART_M / 2, 180))
    ],
    line_rate_hz=50.0,
    ground=TexturedGroundSection(grain_m=0.3, relief_m=0.0),
    navigation_error=FlightErrorSection(position_m=0.0, roll_pitch_deg=0.0, yaw_deg=0.0),
)


def rolled(by_rad):
    """The true pose (6,) of a camera that is turned about the body's forward axis."""
    pose = FLIGHT.true_pose
    turn = rotations.matrix_from_euler([by_rad, 0.0, 0.0]) @ rotations.matrix_from_rotation_vector(pose[3:])
    return np.concatenate([pose[:3], rotations.rotation_vector_from_matrix(turn)])


@pytest.fixture(scope="module")
def maps(tmp_path_factory):
    """The maps of the flight at a pose that a test names."""
    folder = tmp_path_factory.mktemp("flown")
    write_flight(folder, CAMERA, FLIGHT)
    platform = Platform.model_validate(
        {
            "camera": CAMERA.model_dump(),
            "hand_measured": {"position_m": [0, 0, 0], "euler_deg": [0, 0, 90]},
            "navigation": {"association": "interpolate"},
            "source": {"kind": "scans", "points": "matching", "matching": {"ground_height_m": 42.0}},
            "flight": FLIGHT.model_dump(),
        }
    )
    source = platform.source
    record = read_navigation(source, folder, ())
    reported = log_covariances(record, source, (3, 4, 5), folder, ())
    navigation = Navigation(record.log, POSE_AT["interpolate"], reported, 0.1, 2.0)

    def at(pose):
        mounted = MountedCamera(CAMERA, pose, np.zeros((6, 6)))
        scan = ScanOnMap(
            "", np.empty(0, dtype=np.int64), mounted, navigation, flat_ground(42.0), SurveyMap(None), np.zeros(6)
        )
        return _Maps(scan, select_scans(folder, source.scans, ()), None, source, MapSection())

    return at


class _Maps(PlatformMap):
    """Without a calibration: no view has a correction."""

    def _correction(self, number):
        return np.zeros(6)


@pytest.fixture(scope="module")
def fitted(maps):
    return strip_fit(maps(rolled(OFF_RAD)), maps(rolled(0.0)))


def test_the_level_ground_counts_from_where_the_survey_counts_whatever_height_the_map_gives(maps):
    """A survey in a plane that touches the Earth half a kilometre above the ellipsoid."""
    in_plane = SurveyMap(MapFrame("EPSG:32632", (50.0, 9.0, 500.0)))
    scan = replace(maps(rolled(0.0)).scan_on_map(1), frame=in_plane)
    np.testing.assert_allclose(scan.down_m(scan.shape[0] // 2), -42.0, atol=1e-9)


def test_a_scan_that_cannot_be_rectified_is_counted(maps, monkeypatch):
    def refused(*_):
        raise InputError("rectified scan", "a map of 9 x 9 cells", "at most 8 cells", "take larger cells")

    monkeypatch.setattr("linepose.output.map.strip_fit.rectify", refused)
    fit = strip_fit(maps(rolled(OFF_RAD)), maps(rolled(0.0)))["strip_fit"].iloc[0]
    assert (fit["n_scans"], fit["n_scans_left_out"], fit["n_compared"]) == (2, 2, 0)


def test_at_the_truth_strips_lie_within_a_pixel(fitted):
    fit = fitted["strip_fit"].iloc[0]
    assert (fit["n_scans"], fit["n_pairs"]) == (2, 1)
    assert fit["n_compared"] >= 20
    assert fit["n_compared"] == fit["n_tried"] - fit["n_uncorrelated"] - fit["n_contradicted"]
    assert fit["pixel_m"] == pytest.approx(PIXEL_M, rel=0.1)
    assert fit["rms_after_m"] < 0.5 * PIXEL_M


def test_a_boresight_that_is_off_sets_strips_apart_as_geometry_says(fitted):
    """Each way a roll r moves the ground by H tan(angle + r), in opposite directions on opposite headings."""
    patches = fitted["strip_patches"]
    east = patches["easting_m"].to_numpy() - FLIGHT.origin_m[1]
    angles = [np.arctan((sign * east + APART_M / 2) / HEIGHT_M) for sign in (1, -1)]  # to the right of each flight
    moved = sum(HEIGHT_M * (np.tan(angle + OFF_RAD) - np.tan(angle)) for angle in angles)
    predicted = np.sqrt(np.mean(moved**2))
    assert fitted["strip_fit"]["rms_before_m"].iloc[0] == pytest.approx(predicted, abs=0.25 * PIXEL_M)
    np.testing.assert_allclose(np.abs(patches["before_east_m"]), moved, atol=2 * PIXEL_M)
    assert predicted > 5 * PIXEL_M


def test_patches_are_found_again_at_a_pose_that_is_off(maps):
    fit = strip_fit(maps(rolled(0.0)), maps(rolled(OFF_RAD)))["strip_fit"].iloc[0]
    assert fit["n_compared"] >= 10
    assert fit["rms_before_m"] < 0.5 * PIXEL_M < 4 * PIXEL_M < fit["rms_after_m"]


def test_tables_fit_their_schemas_and_strips_apart_are_no_pair(maps, fitted, tmp_path):
    one = maps(rolled(0.0))
    alone = replace(one, paths=dict(list(one.paths.items())[:1]))
    for tables in (fitted, strip_fit(alone, alone)):
        for name, schema in FIT_TABLES.items():
            write_table(tables[name], tmp_path / f"{name}.parquet", schema)
            pd.testing.assert_frame_equal(read_table(tmp_path / f"{name}.parquet", schema), tables[name])
    assert tables["strip_fit"]["n_pairs"].iloc[0] == 0
    assert tables["strip_patches"].empty
    assert np.isnan(tables["strip_fit"]["rms_after_m"].iloc[0])


def test_places_of_whole_lines_and_pixels_are_those_of_the_map(maps):
    scan = maps(rolled(OFF_RAD)).scan_on_map(1)
    whole = scan.places(20, 23).place_m
    found = scan.places_of([20, 22, 20.5], [3, 150, 3])
    np.testing.assert_allclose(found[:2], [whole[0, :, 3], whole[2, :, 150]], atol=1e-7)
    assert scan.places_of([], []).shape == (0, 3)
    np.testing.assert_allclose(found[2], (whole[0, :, 3] + whole[1, :, 3]) / 2, atol=1e-3)

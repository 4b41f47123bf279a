"""From raw scans of a small flight through matched tie points to the pose; what cannot be matched is told."""

import numpy as np
import pytest
import rasterio
from rasterio.transform import from_origin

from linepose.adjustment.at_levels import pose_at_levels
from linepose.config.platform import Platform
from linepose.errors import InputError
from linepose.geometry import rotations
from linepose.geometry.camera import Camera
from linepose.geometry.camera_sigmas import CameraSigmas
from linepose.pipeline.ground_height import ground_down_m
from linepose.pipeline.load import read_points, with_navigation
from linepose.simulation.flight_section import FlightSection, StripSection, TexturedGroundSection
from linepose.simulation.flown_record import write_flight
from linepose.survey.observations import survey_from_table

CAMERA = Camera(
    focal_length_m=8e-3,
    pixel_pitch_m=24e-6,
    n_pixels=200,
    principal_point_px=99.5,
    sigmas=CameraSigmas(u_px=0.4, v_px=0.5, principal_point_px=1.0, focal_length_m=2e-5),
)
LAYOUT = ((0, -4, 0, 40), (0, 4, 180, 40), (1, 0, 90, 60), (0, 0, 0, 60))


def strips(layout=LAYOUT, duration_s=4.0):
    return [
        StripSection(north_m=n, east_m=e, heading_deg=heading, height_m=height, duration_s=duration_s)
        for n, e, heading, height in layout
    ]


def flown(folder, ground=None, layout=LAYOUT, dem=None, **source):
    """The platform of a flight, whose scans stand in the folder; a height model stands for the height of the ground."""
    flight = FlightSection(
        seed=8,
        true_position_m=(0.17, 0.03, 0.12),
        true_euler_deg=(0.9, -0.7, 90.8),
        strips=strips(layout),
        line_rate_hz=50.0,
        ground=TexturedGroundSection(grain_m=0.3) if ground is None else ground,
    )
    write_flight(folder, CAMERA, flight)
    matching = {"ground_height_m": None if dem else 44.0, "n_points": 60, "n_features": 400} | source
    known = {"points": {"ground": {"dem": dem, "sigma_m": 1.0}}, "map_frame": {"crs": "EPSG:32756"}} if dem else {}
    hand = {
        "position_m": [0.15, 0.05, 0.1],
        "euler_deg": [0, 0, 90],
        "sigma_position_m": 0.03,
        "sigma_rotation_deg": 1.0,
    }
    return Platform.model_validate(
        {
            "camera": CAMERA.model_dump(),
            "hand_measured": hand,
            "navigation": {"association": "interpolate"},
            "source": {"kind": "scans", "points": "matching", "matching": matching},
            "flight": flight.model_dump(),
            **known,
        }
    )


def write_dem(path, origin_m, height_m, half_m=100.0):
    """A height model of one height about an origin north, east of the flight's map."""
    corner = from_origin(origin_m[1] - half_m, origin_m[0] + half_m, 10.0, 10.0)
    size = int(half_m / 5.0)
    kind = {"driver": "GTiff", "height": size, "width": size, "count": 1, "dtype": "float32", "crs": "EPSG:32756"}
    with rasterio.open(path, "w", transform=corner, **kind) as raster:
        raster.write(np.full((size, size), height_m, dtype="float32"), 1)


def test_the_height_to_begin_with_is_the_models_below_the_strips(tmp_path):
    ground = {"dem": "ground.tif", "sigma_m": 0.2, "height_offset_m": 30.0}
    platform = Platform.model_validate(
        {
            "camera": CAMERA.model_dump(),
            "hand_measured": {"position_m": [0, 0, 0], "euler_deg": [0, 0, 90]},
            "source": {"kind": "scans", "dataset": "flight", "points": "matching"},
            "points": {"ground": ground},
            "map_frame": {"crs": "EPSG:32756"},
        }
    )
    origin = np.array([6_248_550.0, 332_965.0, -90.0])
    strips_m = [np.column_stack([np.linspace(-30, 30, 200), np.full(200, east), np.zeros(200)]) for east in (-4.0, 4.0)]
    write_dem(tmp_path / "ground.tif", origin, 12.0)
    assert ground_down_m(platform, tmp_path, strips_m, origin) == pytest.approx(90.0 - 42.0, abs=1e-3)
    write_dem(tmp_path / "ground.tif", origin + 400.0, 12.0)
    with pytest.raises(InputError, match="no height below 16 of 16 places of the strips"):
        ground_down_m(platform, tmp_path, strips_m, origin)


def test_the_pose_is_found_from_raw_scans_and_a_height_model_within_three_stated_sigmas(tmp_path):
    write_dem(tmp_path / "ground.tif", (6_248_550.0, 332_965.0), 44.0)
    platform = flown(tmp_path, dem="ground.tif")
    points = read_points(platform, tmp_path)
    assert 30 < points["point"].nunique() <= 60
    assert points["observation"].nunique() == 4
    survey = survey_from_table(with_navigation(points, platform, tmp_path))
    hand = platform.hand_measured
    found = pose_at_levels(survey, CAMERA, hand.pose, hand.body_covariance)
    sigma = np.sqrt(np.diag(found.covariance))
    first, second = (rotations.matrix_from_rotation_vector(one[3:]) for one in (found.pose, platform.true_pose))
    turn = rotations.rotation_vector_from_matrix(first @ second.T)
    error = np.concatenate([found.pose[:3] - platform.true_pose[:3], turn])
    assert np.all(np.abs(error) < 3 * sigma)
    assert np.all(sigma[3:] < np.deg2rad(1.0) / 5)  # the scans tell, not the hand measurement


def told(platform, folder):
    with pytest.raises(InputError) as error:
        read_points(platform, folder)
    assert "\n" not in str(error.value)
    return str(error.value)


def test_rows_of_a_crop_are_told(tmp_path):
    message = told(flown(tmp_path, TexturedGroundSection(rows_m=0.8, relief_m=0.0)), tmp_path)
    assert "a texture that does not repeat" in message
    assert "source.points: labels" in message


def test_strips_apart_are_told(tmp_path):
    apart = ((0, -60, 0, 40), (0, 60, 180, 40))
    assert "strips that do not overlap" in told(flown(tmp_path, layout=apart), tmp_path)


def test_ground_above_the_flight_is_told(tmp_path):
    message = told(flown(tmp_path, layout=LAYOUT[:2], ground_height_m=-500.0), tmp_path)
    assert "no ray" not in message
    assert "strips" in message or "cells" in message
    message = told(flown(tmp_path, layout=LAYOUT[:2], ground_height_m=100.0), tmp_path)
    assert "below the ground" in message

"""Scans from the air: they show the ground where the truth says, and the log errs as it is told to."""

import hashlib

import numpy as np
import pandas as pd
import pytest

from linepose.config.platform import load_platform
from linepose.experiments.registry import check_experiments
from linepose.geometry import rotations
from linepose.geometry.camera import Camera, rays
from linepose.inputs.scans.scan_files import read_scan
from linepose.simulation.flight_section import FlightErrorSection, FlightSection, StripSection, TexturedGroundSection
from linepose.simulation.flown_record import write_flight
from linepose.simulation.flown_scan import light_of_strip, true_flight
from linepose.simulation.textured_ground import reflectance_at

CAMERA = Camera(focal_length_m=8e-3, pixel_pitch_m=80e-6, n_pixels=60, principal_point_px=29.5)
POSITION, EULER = ["north_m", "east_m", "down_m"], ["roll_rad", "pitch_rad", "yaw_rad"]
STRIPS = (
    StripSection(north_m=0, east_m=-3, heading_deg=0, height_m=40, duration_s=2),
    StripSection(north_m=2, east_m=4, heading_deg=200, height_m=60, duration_s=1.5),
)
FREE_OF_ERROR = FlightErrorSection(position_m=0, roll_pitch_deg=0, yaw_deg=0)


def section(**changes):
    ground = TexturedGroundSection(grain_m=4.0, relief_m=2.0)  # coarse: what a pixel sees is alike
    values = {"seed": 5, "true_position_m": (0.2, 0.1, -0.1), "true_euler_deg": (2, -3, 91), "strips": STRIPS}
    return FlightSection(**values | {"ground": ground, "line_rate_hz": 50.0} | changes)


@pytest.mark.parametrize("strip", [0, 1])
def test_each_pixel_shows_the_ground_that_its_ray_meets(strip):
    flight = true_flight(section())
    light = light_of_strip(CAMERA, flight, strip)
    lines, pixels = np.arange(3, len(light), 17), np.arange(1, 60, 7)
    body = flight.motion.body_poses(np.full(len(lines), strip), flight.line_times_s(strip)[lines])
    centre, direction = rays(
        CAMERA,
        rotations.matrix_from_rotation_vector(flight.pose[3:]),
        flight.pose[:3],
        rotations.matrix_from_euler(body[:, 3:])[:, None],
        body[:, None, :3],
        pixels,
    )
    near, far = np.zeros(centre.shape[:2]), np.full(centre.shape[:2], 200.0)
    for _ in range(50):  # bisection, in place of the renderer's iteration
        depth = (near + far) / 2
        at = centre + depth[..., None] * direction
        above = at[..., 2] < flight.ground.down_m(at[..., :2])
        near, far = np.where(above, depth, near), np.where(above, far, depth)
    ground = flight.ground
    seen = [reflectance_at(n, e, ground.grain_m, ground.contrast, 0.0, ground.seed) for n, e, _ in at.reshape(-1, 3)]
    seen = np.array(seen).reshape(light[np.ix_(lines, pixels)].shape)
    assert np.ptp(seen) > 0.1
    assert np.ptp(at[..., 2]) > 0.5
    # half a pixel or line is 0.2 m of the finest grain's 4 m, of whose share 0.35 x 0.8 a slope is at most 1.5
    assert np.abs(light[np.ix_(lines, pixels)] - seen).max() < 0.35 * 0.8 * 1.5 * 0.2 / 4 * 2


def test_the_log_without_errors_is_the_truth_and_errs_as_is_told(tmp_path):
    write_flight(tmp_path / "exact", CAMERA, section(navigation_error=FREE_OF_ERROR))
    write_flight(tmp_path / "wrong", CAMERA, section())
    exact, wrong = (pd.read_parquet(tmp_path / name / "navigation.parquet") for name in ("exact", "wrong"))
    truth = pd.read_parquet(tmp_path / "exact" / "truth.parquet")
    assert set(truth["observation"]) == {1, 2}
    stamps = truth["time_s"].to_numpy() * 1e6 + 1_466_000_000_000_000
    for name in POSITION + EULER:
        np.testing.assert_allclose(np.interp(stamps, exact["time_us"], exact[name]), truth[name], atol=1e-6)
    off = (wrong - exact)[POSITION + EULER].to_numpy()
    sigma = np.array([0.02] * 3 + [*np.deg2rad([0.02, 0.02, 0.06])])
    white = np.diff(off, axis=0).std(axis=0) / np.sqrt(2)  # drift hardly moves in a hundredth of a second
    np.testing.assert_allclose(white, 0.3 * sigma, rtol=4 / np.sqrt(len(off)) + 0.05)
    assert np.all(np.abs(off).max(axis=0) < 6 * np.hypot(1, 0.3) * sigma)


def test_scans_are_read_like_any_others_and_the_same_bytes_again(tmp_path):
    digests = []
    for name in ("once", "again"):
        write_flight(tmp_path / name, CAMERA, section(lateness_lines=0.1))
        files = sorted(path for path in (tmp_path / name).rglob("*") if path.is_file())
        digests.append([hashlib.sha256(path.read_bytes()).hexdigest() for path in files])
    assert digests[0] == digests[1]
    scan = read_scan(tmp_path / "once" / "scans" / "strip-02.hdr")
    assert scan.intensity.shape == (76, 60)
    assert np.all(np.abs(np.diff(scan.time_us) - 20_000) < 20_000)
    assert np.ptp(np.diff(scan.time_us)) > 0
    log = pd.read_parquet(tmp_path / "once" / "navigation.parquet")
    assert log["time_us"].iloc[0] < scan.time_us[0] < scan.time_us[-1] < log["time_us"].iloc[-1]


def test_the_simulated_drone_overlaps_and_asks_for_experiments_that_there_are(platforms_folder):
    platform = load_platform(platforms_folder, "drone-sim")
    check_experiments(platform, "drone-sim.yaml")
    assert 8 <= len(platform.flight.strips) <= 12
    assert np.linalg.norm(platform.true_pose[:3] - platform.start_pose()[:3]) < 2 * 0.03 * np.sqrt(3)
    assert platform.start_pose()[3:] == pytest.approx(platform.true_pose[3:], abs=2 * np.deg2rad(1.0))

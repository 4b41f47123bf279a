import hashlib
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from linepose.geometry import rotations
from linepose.inputs.scans.scan_files import read_scan
from linepose.simulation import record
from linepose.simulation.projection import exact_projections
from linepose.simulation.render import render
from linepose.simulation.sensor import band_responses
from linepose.simulation.settings import FaultSettings, GroundSettings
from linepose.simulation.trajectory import body_poses, schedule
from unit.navigation_errors import gauss_markov

POSITION = ["north_m", "east_m", "down_m"]
EULER = ["roll_rad", "pitch_rad", "yaw_rad"]


@pytest.fixture
def quick(settings):
    return replace(settings, image=replace(settings.image, supersampling=1), navigation_rate_hz=50.0)


def log_times(log, settings):
    return (log["time_us"].to_numpy() - settings.start_time_us) / 1e6


def test_log_without_errors_is_the_truth(quick):
    log = record.navigation_log(quick)
    assert np.all(np.diff(log["time_us"]) == 20_000)
    position, euler = body_poses(quick, log_times(log, quick))
    np.testing.assert_allclose(log[POSITION], position + np.array(quick.origin_m), atol=1e-8)
    np.testing.assert_allclose(log[EULER], euler, atol=1e-12)


def test_jump_is_in_the_log_from_mid_pass_to_its_end(quick):
    fault = FaultSettings(observation=2, jump_position_m=(0.1, 0.0, 0.0), jump_euler_rad=(0.0, 0.0, 0.02))
    clean, faulty = record.navigation_log(quick), record.navigation_log(replace(quick, faults=(fault,)))
    times = schedule(quick)
    time = log_times(clean, quick)
    during = (time >= times.middle_s[1]) & (time <= times.end_s[1])
    np.testing.assert_allclose((faulty - clean)["north_m"], 0.1 * during, atol=1e-8)
    np.testing.assert_allclose((faulty - clean)["yaw_rad"], 0.02 * during, atol=1e-12)


def test_covariances_are_twelve_by_twelve_at_one_hertz(tmp_path, quick):
    record.write_covariances(tmp_path / "covariances.csv", quick)
    table = pd.read_csv(tmp_path / "covariances.csv", header=None)
    assert table.shape[1] == 1 + 144
    assert np.all(np.diff(table[0]) == 1_000_000)
    matrix = table.iloc[0, 1:].to_numpy().reshape(12, 12)
    expected = np.square([0.01, 0.013, 0.011, *np.deg2rad([0.24, 0.26, 0.11])])
    np.testing.assert_allclose(np.diag(matrix)[:6], expected, rtol=1e-6)
    assert np.count_nonzero(matrix) == 6


def test_labels_are_rough_and_carry_the_planted_ids(camera, quick):
    faults = (FaultSettings(observation=2, swapped_points=((3, 4),), missing_points=(7,)),)
    table = record.labels(camera, replace(quick, faults=faults))
    assert list(table["point"][table["observation"] == 2]) == [p for p in range(15) if p != 7]
    truth, lines = exact_projections(camera, quick), record.true_lines(camera, quick)
    ids = table["point"].to_numpy().copy()
    swapped = (table["observation"] == 2).to_numpy() & np.isin(ids, [3, 4])
    ids[swapped] = 7 - ids[swapped]
    row = table["observation"].to_numpy() - 1
    reach = record._LABEL_REACH * quick.extraction.label_sigma_px
    assert np.abs(table["u_px"] - truth.u_px[row, ids]).max() <= reach
    assert np.abs(table["line"] - lines[row, ids]).max() <= reach
    assert np.abs(table["line"] - lines[row, ids]).max() > 0.5


def test_truth_says_what_is_visible_and_faulty(camera, quick):
    faults = (
        FaultSettings(observation=1, missing_points=(0, 5)),
        FaultSettings(observation=3, clock_offset_s=0.2),
    )
    table = record.truth_table(camera, replace(quick, faults=faults))
    assert len(table) == 3 * 15
    assert list(table["point"][~table["visible"]]) == [0, 5]
    assert set(table["observation"][table["faulty"]]) == {3}
    np.testing.assert_allclose(table[["r_x_m", "theta_z_rad"]].to_numpy()[0], [0.189, -1.429])


def test_truth_says_how_far_a_point_is_and_how_fast_it_crosses_the_line(camera, quick):
    forward = replace(quick.passes[0], speed_m_s=0.2)
    level = replace(quick, passes=(quick.passes[0], forward), ground=GroundSettings(body_height_m=1.0))
    table = record.truth_table(camera, level)
    by_pass = table.groupby("observation")[["range_m", "v_px_per_line"]].mean()
    np.testing.assert_allclose(by_pass["v_px_per_line"][1], -by_pass["v_px_per_line"][2], rtol=0.02)
    # a point in the scan line's plane moves by f_px/z times the drive's part across that plane
    truth = exact_projections(camera, level)
    rotation = rotations.matrix_from_euler(truth.euler_rad[1]) @ rotations.matrix_from_rotation_vector(truth.pose[3:])
    centre = truth.position_m[1] + rotations.matrix_from_euler(truth.euler_rad[1]) @ truth.pose[:3]
    in_camera = np.einsum("mji,mj->mi", rotation, truth.point_m - centre)
    heading = truth.euler_rad[1, 0, 2]
    drive = np.einsum("mji,j->mi", rotation, 0.2 / 133.0 * np.array([np.cos(heading), np.sin(heading), 0.0]))
    expected = -camera.focal_length_px * drive[:, 1] / in_camera[:, 2]
    second = table[table["observation"] == 2]
    np.testing.assert_allclose(second["v_px_per_line"], expected, rtol=1e-6)
    np.testing.assert_allclose(second["range_m"], np.linalg.norm(in_camera, axis=1), rtol=1e-12)


def test_survey_repeats_byte_for_byte_and_changes_with_the_seed(tmp_path, camera, quick):
    noisy = replace(quick, passes=quick.passes[:1], navigation_error=gauss_markov([0.01] * 6, 30.0))
    for name, seed in (("first", 1), ("again", 1), ("other", 2)):
        record.write_survey(tmp_path / name, camera, replace(noisy, seed=seed))
    digests = {
        name: {
            str(path.relative_to(tmp_path / name)): hashlib.sha256(path.read_bytes()).hexdigest()
            for path in sorted((tmp_path / name).rglob("*"))
            if path.is_file()
        }
        for name in ("first", "again", "other")
    }
    assert digests["first"] == digests["again"]
    assert {
        "scans/observation-01.bil",
        "scans/observation-01.hdr",
        "scans/observation-01-times.csv",
        "navigation.parquet",
        "covariances.csv",
        "labels.csv",
        "truth.parquet",
    } == set(digests["first"])
    for changed in ("scans/observation-01.bil", "navigation.parquet", "labels.csv"):
        assert digests["first"][changed] != digests["other"][changed]


def test_scan_of_many_bands_reads_back_as_the_light(tmp_path, camera, quick):
    quickest = replace(quick.passes[0], speed_m_s=-1.0, duration_s=1.2)
    many = replace(quick, passes=(quickest,), image=replace(quick.image, n_bands=244))
    record.write_survey(tmp_path, camera, many)
    intensity = read_scan(tmp_path / "scans" / "observation-01.hdr").intensity
    white = many.image.full_scale_electrons
    expected = 4095 * band_responses(244).mean() * render(camera, many, 1).light
    # six sigmas of the mean of 244 bands' shot and read noise at full scale
    assert intensity.shape == expected.shape
    noise = 4095 / white * np.sqrt((white + many.image.read_noise_electrons**2) / 244)
    np.testing.assert_allclose(intensity, expected, atol=6 * noise)
    assert np.ptp(intensity) > 50 * noise


def test_clock_offset_is_in_the_scan_times_alone(tmp_path, camera, quick):
    one = replace(quick, passes=quick.passes[:1])
    late = replace(one, faults=(FaultSettings(observation=1, clock_offset_s=0.25),))
    times = []
    for name, settings in (("clean", one), ("late", late)):
        record.write_survey(tmp_path / name, camera, settings)
        times.append(pd.read_csv(tmp_path / name / "scans" / "observation-01-times.csv")["time_us"].to_numpy())
    np.testing.assert_array_equal(times[1] - times[0], 250_000)
    images = [(tmp_path / name / "scans" / "observation-01.bil").read_bytes() for name in ("clean", "late")]
    assert images[0] == images[1]

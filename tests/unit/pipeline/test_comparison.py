"""Two calibrations: what differs, how unlikely that is, and what both rest on."""

import json
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

import linepose
from linepose.cli.compare import lines_of
from linepose.estimation.pose_change import covariance_of_difference
from linepose.geometry.camera import normalised_from_pixel
from linepose.geometry.distance import difference_covariance
from linepose.geometry.pose import POSE_COLUMNS
from linepose.pipeline.calibration import Calibration
from linepose.pipeline.comparison import compare
from linepose.pipeline.results import Results
from unit import made_up

MOVE_M = 0.03


@pytest.fixture(scope="module")
def pair(tmp_path_factory):
    """The made-up calibration, and one whose camera lies further forward."""
    folder = tmp_path_factory.mktemp("results") / "first"
    made_up.write_adjusted_results(folder)
    first = Calibration.from_results(folder, made_up.adjusted_platform())
    samples, pose = first.samples.copy(), first.poses.copy()
    samples[POSE_COLUMNS[0]] += MOVE_M
    pose.loc[pose["stage"] == "inliers", POSE_COLUMNS[0]] += MOVE_M
    tables = first.tables() | {"mcmc/inliers": samples, "pose": pose}
    return first, replace(first, results=Results("second", in_memory=tables))


def own_covariance(calibration):
    return difference_covariance(calibration.pose, calibration.covariance)


def test_difference_is_the_move_and_points_from_first_to_second(pair):
    found = compare(*pair, range_m=10.0)
    assert_allclose(found.difference, [MOVE_M, 0, 0, 0, 0, 0], atol=1e-9)
    assert found.names == ("first", "second")
    whole = found.change.test("all six")
    assert_allclose(whole.distance**2, found.difference @ np.linalg.solve(found.covariance, found.difference))


def test_a_hand_measurement_of_both_counts_once(pair):
    """As of two estimates that each weigh their own data with the same measurement: its error cancels in part."""
    found = compare(*pair, range_m=10.0)
    assert found.shares_hand_measurement
    prior = pair[0].hand_measured.body_covariance
    first, second = (own_covariance(one) for one in pair)
    weights = [np.eye(6) - one @ np.linalg.inv(prior) for one in (first, second)]
    data = [np.linalg.inv(np.linalg.inv(one) - np.linalg.inv(prior)) for one in (first, second)]
    by_hand = weights[0] - weights[1]
    expected = sum(w @ d @ w.T for w, d in zip(weights, data, strict=True)) + by_hand @ prior @ by_hand.T
    assert_allclose(found.covariance, expected, rtol=1e-6, atol=1e-12)


def test_a_posterior_no_narrower_than_the_prior_leaves_a_covariance():
    """Of few draws it may be a little wider by chance; what it says of the difference is then none, not less."""
    prior = np.diag([0.1**2] * 3 + [0.03**2] * 3)
    wider, narrow = prior * 1.02, prior * 0.25
    wider[:3, :3] *= 0.5
    for first, second in ((wider, prior), (prior, wider), (wider, narrow)):
        assert np.linalg.eigvalsh(covariance_of_difference([first, second], prior))[0] >= -1e-18
    assert_allclose(covariance_of_difference([prior, prior], prior), np.zeros((6, 6)), atol=1e-18)


def test_measurements_of_both_are_counted_and_leave_no_p_value(pair):
    found = compare(*pair, range_m=10.0)
    timed = int((pair[0].observations["time_us"] != 0).sum())
    assert found.n_shared_measurements == timed
    p_values = {one["p_value"] is None for one in found.as_dict()["tests"].values()}
    assert p_values == {timed > 0}


def test_without_a_prior_the_two_are_independent(pair):
    alone = [replace(one, platform=one.platform.model_copy(update={"prior": "none"})) for one in pair]
    found = compare(*alone, range_m=10.0)
    assert not found.shares_hand_measurement
    assert_allclose(found.covariance, own_covariance(pair[0]) + own_covariance(pair[1]))


def test_pixels_move_by_the_camera_s_shift_on_the_ground(pair):
    found = compare(*pair, range_m=10.0)
    turn, camera = pair[0].matrix[:3, :3], pair[0].own_camera
    forward = turn.T @ [MOVE_M, 0, 0]
    assert_allclose(found.pixels["across_m"], forward[1], atol=1e-9)
    assert camera.principal_point_px != pair[0].camera.principal_point_px
    x = normalised_from_pixel(camera, 0.0)
    assert_allclose(found.pixels.loc["first", "along_m"], forward[0] - forward[2] * x, atol=1e-9)
    assert list(found.pixels.index) == ["first", "centre", "last"]


def test_lines_and_json_tell_all(pair):
    found = compare(*pair, range_m=10.0)
    lines = lines_of(found)
    assert "second - first" in lines[0]
    assert "0.0300 m" in lines[1]
    assert sum("pixel at 10 m" in line for line in lines) == 3
    told = json.loads(json.dumps(found.as_dict(), allow_nan=False))
    assert_allclose(told["differences"]["forward_m"]["difference"], MOVE_M)
    assert list(told["differences"])[3:] == ["turn_forward_deg", "turn_right_deg", "turn_down_deg"]
    assert "turn about down" in lines[6]
    assert set(told["pixels"]) == {"first", "centre", "last"}


def test_what_cannot_be_compared_is_told(pair):
    first, second = pair
    with pytest.raises(linepose.InputError, match="range"):
        compare(first, second, range_m=0.0)
    other = replace(second, camera=second.camera.replaced(n_pixels=second.camera.n_pixels + 1))
    with pytest.raises(linepose.InputError, match="compare calibrations of one camera"):
        compare(first, other, range_m=10.0)

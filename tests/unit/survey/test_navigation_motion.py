"""Paths through logs: followed where they are smooth, averaged where they are noisy; poses carried along them."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.interpolate import make_smoothing_spline
from scipy.spatial.transform import Rotation

from linepose.errors import EstimationError, InputError
from linepose.geometry.rotations import euler_from_matrix, matrix_from_euler
from linepose.survey.navigation_log import NavigationLog, interpolated_pose
from linepose.survey.navigation_motion import motion, smooth_path, smoothing, survey_at, survey_motions

START_US = 1_466_000_000_000_000


def true_pose(seconds):
    """A drive at 0.5 m/s with a swing of 3 Hz, turning at 0.3 rad/s through south; positions and Euler angles."""
    swing = 0.02 * np.sin(6 * np.pi * seconds)
    position = np.stack([0.5 * seconds, 0.1 * seconds**2, -1.0 + 0.01 * swing], axis=-1)
    yaw = 2.9 + 0.3 * seconds
    return position, np.stack([swing, 0.5 * swing, (yaw + np.pi) % (2 * np.pi) - np.pi], axis=-1)


def log_at(rate_hz, noise_m=0.0, noise_rad=0.0, seconds=4.0):
    time = np.arange(0.0, seconds, 1 / rate_hz)
    position, euler = true_pose(time)
    random = np.random.default_rng(3)
    return NavigationLog(
        START_US + np.rint(1e6 * time).astype(np.int64),
        position + noise_m * random.standard_normal(position.shape),
        euler + noise_rad * random.standard_normal(euler.shape),
    )


def carried(log, seconds, offset_s):
    """Errors of position (m) and rotation (rad) of true poses at times, carried along the log's path."""
    time_us = START_US + np.rint(1e6 * seconds).astype(np.int64)
    path = motion(log, time_us, 0.2)
    position, euler = true_pose(seconds)
    moved, turned = path.carried(time_us, position, matrix_from_euler(euler), offset_s)
    expected_m, expected_rad = true_pose(seconds + offset_s)
    turn = Rotation.from_matrix(np.swapaxes(matrix_from_euler(expected_rad), -1, -2) @ turned).magnitude()
    return np.linalg.norm(moved - expected_m, axis=1), turn


@pytest.mark.parametrize("offset_s", [-0.1, 0.003, 0.1])
def test_a_smooth_log_is_followed(offset_s):
    """A cubic spline's error of a sine: w^4 h^4 / 384 = 4e-5 of 0.02 rad at 18.8 rad/s and 0.01 s, at both ends."""
    position, turn = carried(log_at(100.0), np.linspace(1.0, 3.0, 50), offset_s)
    assert position.max() < 1e-6
    assert turn.max() < 1e-5


def test_a_noisy_log_is_averaged():
    """Carried 30 ms, interpolation would err by the noise of two solutions, sqrt(2) times; the path by a part of it."""
    position, turn = carried(log_at(100.0, 0.01, 0.001), np.linspace(1.0, 3.0, 50), 0.03)
    assert np.sqrt(np.mean(position**2)) < 0.2 * np.sqrt(2 * 3) * 0.01
    assert np.sqrt(np.mean(turn**2)) < 0.4 * np.sqrt(2 * 3) * 0.001


def test_without_an_offset_a_pose_stays_as_it_was():
    position, turn = carried(log_at(100.0, 0.01, 0.001), np.linspace(1.0, 3.0, 50), 0.0)
    assert position.max() == 0.0
    assert turn.max() < 1e-7


@pytest.mark.parametrize("noise", [1e-4, 1e-2, 1.0])
def test_smoothing_is_scipy_s_cross_validation(noise):
    """Another search for the same minimum: the curves differ by a small part of what the noise leaves in them."""
    times = np.arange(300) * 0.01
    truth = 0.5 * np.sin(3 * times)
    values = truth + noise * np.random.default_rng(0).standard_normal(300)
    expected, found = make_smoothing_spline(times, values)(times), smooth_path(times, values[:, None])(times)[:, 0]
    assert np.std(found - expected) < 0.2 * np.std(expected - truth)


def test_each_column_has_its_own_smoothing():
    times = np.arange(300) * 0.01
    noise = np.random.default_rng(0).standard_normal((300, 2)) * [1e-6, 0.1]
    weights = smoothing(times, np.sin(3 * times)[:, None] + noise)
    assert weights[1] > 100 * weights[0]
    np.testing.assert_array_equal(smoothing(times, np.zeros((300, 1))) > 0, [True])


def test_a_long_fast_log_is_thinned_by_averages_first():
    times = np.arange(4000) * 0.005
    values = np.sin(times)[:, None] + 0.01 * np.random.default_rng(0).standard_normal((4000, 1))
    error = smooth_path(times, values)(times)[:, 0] - np.sin(times)
    assert np.std(error) < 0.002  # of 0.01: at most 160 of 4000 degrees of freedom are left


def test_a_log_that_ends_too_early_is_told(survey):
    with pytest.raises(InputError, match=r"observation 1: navigation log: found times from .*lower experiments.clock"):
        survey_motions(log_at(100.0), survey, 0.1)


def test_a_log_of_few_solutions_is_told():
    log = log_at(1.0)
    with pytest.raises(EstimationError, match="4 solutions"):
        motion(log, log.time_us[1:3], 0.1)


def test_survey_moves_by_what_the_log_moves(survey):
    time_us = START_US + 1_000_000 + np.arange(32).reshape(8, 4) * 50_000
    log = log_at(200.0)
    position, euler = interpolated_pose(log, time_us.ravel())
    u_px = survey.u_px.copy()
    u_px[2, 1] = np.nan
    before = replace(
        survey,
        time_us=time_us,
        u_px=u_px,
        position_m=position.reshape(8, 4, 3) + 5.0,
        euler_rad=euler.reshape(8, 4, 3),
    )
    after = survey_at(before, survey_motions(log, before, 0.1), 0.05)
    expected_m, expected_rad = true_pose((time_us - START_US) / 1e6 + 0.05)
    seen = np.isfinite(u_px)
    np.testing.assert_allclose((after.position_m - 5.0)[seen], expected_m[seen], atol=1e-4)
    found, expected = matrix_from_euler(after.euler_rad[seen]), matrix_from_euler(expected_rad[seen])
    np.testing.assert_allclose(euler_from_matrix(np.swapaxes(found, -1, -2) @ expected), 0.0, atol=1e-4)
    np.testing.assert_array_equal(after.position_m[~seen], before.position_m[~seen])
    np.testing.assert_array_equal(after.covariance, before.covariance)
    np.testing.assert_array_equal(after.origin_m, before.origin_m)

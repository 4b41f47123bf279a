"""Replayed surveys see what they must, and predicted sigmas are those of the calibrations that they stand for."""

from dataclasses import replace

import numpy as np
import pytest

from linepose.adjustment.known_points import KnownPoints
from linepose.adjustment.levels import Levels
from linepose.adjustment.prediction import predicted_covariance
from linepose.adjustment.process import ACROSS_FLOOR_PX
from linepose.adjustment.settings import AdjustmentSettings
from linepose.check.hand_measured import expected_error_px, hand_findings
from linepose.check.motions import Promise, best_motions, motions
from linepose.check.prediction import predict
from linepose.check.replay import crossing, in_camera, replayed
from linepose.config.platform import load_platform
from linepose.estimation.adjustment_estimator import AdjustmentEstimator
from linepose.estimation.identifiability import in_body_axes
from linepose.geometry.camera import rays
from linepose.geometry.pose import POSE_COLUMNS, euler_pose
from linepose.geometry.rotations import matrix_from_euler, matrix_from_rotation_vector
from linepose.likelihood.published import PublishedLikelihood
from linepose.simulation.survey import simulate_survey, without_faults
from linepose.survey.body_angles import body_angles_rad
from linepose.survey.hand_measured import HandMeasured
from linepose.survey.pattern import board_points
from unit.recorded_files import simulated_survey


@pytest.fixture(scope="module")
def platform(request):
    from ..conftest import CONFIG

    return load_platform(CONFIG / "platforms", "ladybird-sim")


@pytest.fixture(scope="module")
def measured(platform):
    """A survey of 25 passes without faults, its camera, the true pose, and points at that pose."""
    survey, camera = simulated_survey(platform), platform.intrinsics()
    pose = np.array(platform.simulation.true_pose)
    return survey, camera, pose, PublishedLikelihood(survey, camera).residuals(pose).point_m


def test_rays_of_a_replayed_survey_meet_its_points(measured):
    survey, camera, pose, points = measured
    again = replayed(survey, camera, pose, points)
    body = matrix_from_euler(again.euler_rad)
    centre, direction = rays(
        camera, matrix_from_rotation_vector(pose[3:]), pose[:3], body, again.position_m, again.u_px
    )
    to_point = points - centre
    off = np.cross(direction, to_point) / np.linalg.norm(direction, axis=-1, keepdims=True)
    assert np.isfinite(again.u_px).mean() > 0.98
    assert np.nanmax(np.abs(off)) < 1e-8


def test_replayed_survey_moves_along_the_heading_only(measured):
    survey, camera, pose, points = measured
    again = replayed(survey, camera, pose, points)
    step = again.position_m - survey.position_m
    forward = matrix_from_euler(survey.euler_rad)[..., 0]
    aside = step - np.sum(step * forward, axis=-1, keepdims=True) * forward
    assert np.nanmax(np.linalg.norm(aside, axis=-1)) < 1e-12
    assert np.nanmax(np.linalg.norm(step, axis=-1)) < 0.2  # it was this survey already, but for the navigation's errors


def test_a_line_along_the_heading_is_never_crossed(measured):
    survey, camera, pose, points = measured
    along = np.concatenate([pose[:3], [np.radians(-56.0), 0.0, 0.0]])
    at = crossing(camera, along, survey.position_m, survey.euler_rad, np.broadcast_to(points, survey.position_m.shape))
    assert np.all(np.isnan(at.u_px))


LEVELS = Levels(0.0, 0.1, 1.0, 1.0, 0.0, 60.0, 1.0)


def by_hand(pose, **changed):
    position, euler = tuple(pose[:3].tolist()), tuple(np.degrees(euler_pose(pose)[3:]).tolist())
    return HandMeasured(position_m=position, euler_deg=euler, **changed)


def test_predicted_sigmas_are_those_of_least_squares(measured):
    """Against generalised least squares over pose, intrinsics, points and one navigation error a view, by hand.

    Derivatives are central differences of a pinhole projection. Between the two stands what keeps matrices regular
    across the line, 0.05 px, for which lateness is put at its size here.
    """
    survey, camera, pose, points = measured
    ideal = replayed(survey, camera, pose, points)
    row, point = np.nonzero(np.isfinite(ideal.u_px))
    position, euler = ideal.position_m[row, point], ideal.euler_rad[row, point]
    start = np.concatenate([pose, [camera.principal_point_px, camera.focal_length_m]])

    def pixels(values, moved, body):
        seen = in_camera(values[:6], position + body[:, :3], euler + body[:, 3:], moved[point])
        u, v = seen[:, 0] / seen[:, 2], seen[:, 1] / seen[:, 2]
        return (np.stack([u, v], axis=1) * values[7] / camera.pixel_pitch_m + [[values[6], 0.0]]).ravel()

    def derivative(function, size, step):
        steps = np.broadcast_to(step, (size,)) * np.eye(size)
        return np.stack([(function(d) - function(-d)) / (2 * d.sum()) for d in steps], axis=1)

    none, n_rows = np.zeros((len(row), 6)), 2 * len(row)
    by_values = derivative(lambda d: pixels(start + d, points, none), 8, np.array([1e-6] * 6 + [1e-3, 1e-8]))
    by_points = derivative(lambda d: pixels(start, points + d.reshape(-1, 3), none), points.size, 1e-6)
    by_body = derivative(lambda d: pixels(start, points, none + d), 6, 1e-6).reshape(-1, 2, 6)
    reported = survey.covariance[0, 0]
    sensor = np.diag([camera.sigmas.u_px, ACROSS_FLOOR_PX]) ** 2
    noise = np.zeros((n_rows, n_rows))
    for k, jacobian in enumerate(by_body):
        noise[2 * k : 2 * k + 2, 2 * k : 2 * k + 2] = sensor + 0.01 * jacobian @ reported @ jacobian.T
    stacked = by_body.reshape(n_rows, 6)
    alike = np.repeat(row, 2)[:, None] == np.repeat(row, 2)
    noise += np.where(alike, stacked @ reported @ stacked.T, 0.0)
    design = np.hstack([by_values, by_points])
    information = design.T @ np.linalg.solve(noise, design)
    information[6, 6] += camera.sigmas.principal_point_px**-2
    information[7, 7] += camera.sigmas.focal_length_m**-2
    _, expected = in_body_axes(POSE_COLUMNS, pose, np.linalg.inv(information)[:6, :6])
    predicted = predicted_covariance(ideal, camera, pose, points, LEVELS)
    np.testing.assert_allclose(np.sqrt(np.diag(predicted)), np.sqrt(np.diag(expected)), rtol=1e-3)


@pytest.mark.statistical
def test_what_check_promises_is_what_a_run_delivers(platform):
    """Ten surveys: sigmas of the normal equations at the hand-measured pose against those of the adjusted survey."""
    camera, hand, random = platform.intrinsics(), platform.hand_measured, np.random.default_rng(4)
    ratios = []
    for _ in range(10):
        survey, _ = simulate_survey(camera, without_faults(platform.simulation), int(random.integers(2**31)))
        adjusted = AdjustmentEstimator(survey, camera, hand).adjusted()
        points = PublishedLikelihood(survey, camera).residuals(hand.pose).point_m
        told = predict(survey, camera, hand, True, points)
        _, expected = in_body_axes(POSE_COLUMNS, adjusted.pose, adjusted.covariance)
        ratios.append(np.array([one.predicted for one in told.sigmas]) / np.sqrt(np.diag(expected)))
    assert np.all(np.abs(np.array(ratios) - 1) < 0.2)


def test_nothing_is_predicted_where_driving_sweeps_over_nothing(measured):
    survey, camera, pose, points = measured
    along = np.concatenate([pose[:3], [np.radians(-56.0), 0.0, 0.0]])
    prediction = predict(survey, camera, by_hand(along), True, points)
    assert prediction.sigmas == ()
    assert "0 % of the points" in prediction.findings[0].found


def test_more_of_the_same_narrows_as_the_root_of_the_number(measured):
    survey, camera, pose, points = measured
    ideal = replayed(survey, camera, pose, points)
    half = ideal.select(list(ideal.number[::2]))
    fewer, more = (np.linalg.det(predicted_covariance(one, camera, pose, points, LEVELS)) for one in (half, ideal))
    assert 1.2 < np.sqrt(fewer / more) ** (1 / 6) < 1.8  # 1.39 for 25 of 13 with equal geometry


def test_motion_that_lacks_is_found(measured):
    """Of level passes, tilt brings r_z far more than repetition does."""
    survey, camera, pose, points = measured
    roll = np.abs(np.degrees(body_angles_rad(survey)[:, 0]))
    level = survey.select([int(number) for number in survey.number[roll < 1.0]])
    ideal = replayed(level, camera, pose, points)
    hand = by_hand(pose)
    adjusted = AdjustmentEstimator(level, camera, hand, AdjustmentSettings(n_draws=10)).adjusted()
    promise = Promise(camera, adjusted, None)
    found = motions(ideal, promise, points)
    best = best_motions(found, 2)
    plain = np.sqrt(found[0].covariance[2, 2])
    assert "4 deg" in best[0][0]
    assert best[0][1] < 0.7 * plain
    assert plain < np.sqrt(promise.covariance(ideal, points)[2, 2])


def test_a_known_target_narrows_what_is_promised_and_a_wrong_one_is_told(measured):
    survey, camera, pose, points = measured
    few = survey.select([int(number) for number in survey.number[:6]])
    hand, board_m = by_hand(pose), board_points()
    nothing = np.zeros((len(board_m), 3)), np.zeros((len(board_m), 3, 3))
    right = KnownPoints(*nothing, board_m=board_m, board_sigma_m=0.001)
    wrong = KnownPoints(*nothing, board_m=1.2 * board_m, board_sigma_m=0.001)
    told, plain = (predict(few, camera, hand, True, points, known) for known in (right, wrong))
    assert all(a.predicted < 1.05 * b.predicted for a, b in zip(told.sigmas, plain.sigmas, strict=True))
    assert not [one for one in told.findings if one.subject == "known points"]
    against = next(one for one in plain.findings if one.subject == "known points")
    assert "is not used; the scans show it 0.8" in against.found
    ideal = replayed(few, camera, pose, points)
    used, unused = (Promise(camera, one.adjusted, None, known) for one, known in ((told, right), (plain, wrong)))
    free = replace(used, known_points=None).covariance(ideal, points)
    assert np.all(np.diag(used.covariance(ideal, points)) < np.diag(free))
    np.testing.assert_array_equal(
        unused.covariance(ideal, points), replace(unused, known_points=None).covariance(ideal, points)
    )


def test_error_that_a_hand_measurement_explains(measured, platform):
    """Against poses drawn from its covariance: their mean error, within 40 % for another norm and one distance."""
    survey, camera, pose, points = measured
    covariance = platform.start_covariance()
    rng = np.random.default_rng(3)
    at = crossing(camera, pose, survey.position_m, survey.euler_rad, np.broadcast_to(points, survey.position_m.shape))
    errors = []
    for moved in rng.multivariate_normal(pose, covariance, size=20):
        other = crossing(
            camera, moved, survey.position_m, survey.euler_rad, np.broadcast_to(points, at.position_m.shape)
        )
        across = (other.position_m - at.position_m) * camera.focal_length_px / 3.3
        errors.append(np.nanmean(np.hypot(other.u_px - at.u_px, np.linalg.norm(across, axis=-1))))
    expected = expected_error_px(camera, covariance, 3.3)
    assert 0.6 < np.mean(errors) / expected < 1.4


def test_good_hand_measurement_has_nothing_to_complain_of(measured, platform):
    survey, camera, _, points = measured
    findings, estimated = hand_findings(survey, camera, platform.start_pose(), platform.start_covariance())
    assert all(finding.advice == "" for finding in findings)
    assert np.max(np.linalg.norm(estimated - points, axis=1)) < 0.5

"""The adjustment as a user calls it: a truth that comes back, input that cannot be used, results that are complete."""

from dataclasses import replace

import numpy as np
import pytest

from linepose.adjustment import AdjustmentSettings, KnownPoints, adjust
from linepose.adjustment.hand_measured import hand_measured, ran_off
from linepose.adjustment.motion import line_period_s
from linepose.adjustment.settings import covariance_of_sigmas
from linepose.errors import EstimationError, InputError
from linepose.geometry.pose import POSE_COLUMNS
from linepose.geometry.rotations import matrix_from_rotation_vector, rotation_vector_from_matrix
from linepose.pipeline.stages import SAMPLES
from linepose.tables import write_table
from unit.adjustment import strips, timed_survey

CAMERA = timed_survey.CAMERA
QUICK = AdjustmentSettings(line_period_s=timed_survey.LINE_S, n_draws=60, n_samples=500)


def hand(shift_m=0.0, turn_rad=0.0):
    turn = matrix_from_rotation_vector(turn_rad * np.array([1, -1, 1]) / np.sqrt(3))
    rotation = rotation_vector_from_matrix(turn @ matrix_from_rotation_vector(timed_survey.POSE[3:]))
    return np.concatenate([timed_survey.POSE[:3] + shift_m * np.array([1, 1, -1]) / np.sqrt(3), rotation])


@pytest.fixture(scope="module")
def survey():
    return timed_survey.make_survey(12, 8, seed=21)


@pytest.fixture(scope="module")
def found(survey):
    return adjust(survey, CAMERA, hand(0.05, 0.02), settings=QUICK)


def test_the_truth_lies_within_what_is_stated(found):
    error = found.pose - timed_survey.POSE
    assert error @ np.linalg.solve(found.covariance, error) < 22.5  # chi squared of six, 99.9 %
    assert found.diagnostics.converged
    assert not found.diagnostics.heavy_tails
    assert np.all(found.level_intervals[:, 0] < found.level_intervals[:, 1])


def test_every_result_is_there_and_in_its_place(found, survey, tmp_path):
    assert found.corrections.shape == (12, 8, 6)
    assert found.normalised.shape == (12, 8, 2)
    assert found.view_weight.shape == (12,)
    assert found.points_m.shape == (8, 3)
    write_table(found.samples, tmp_path / "samples.parquet", SAMPLES)
    drawn = found.samples[list(POSE_COLUMNS)].to_numpy()
    # the mean of 500 draws, off by a sigma over their root, and by as much as the mixture is skewed
    assert np.all(np.abs(drawn.mean(axis=0) - found.pose) < 0.5 * found.sigma)
    assert np.allclose(drawn.std(axis=0), found.sigma, rtol=0.2)


def test_normalised_residuals_are_standard_normal(found):
    values = found.normalised[np.isfinite(found.normalised)]
    assert abs(values.std() - 1) < 4 / np.sqrt(2 * len(values))
    assert abs(values.mean()) < 4 / np.sqrt(len(values))


def test_the_same_numbers_twice(found, survey):
    again = adjust(survey, CAMERA, hand(0.05, 0.02), settings=QUICK)
    assert np.array_equal(again.pose, found.pose)
    assert np.array_equal(again.covariance, found.covariance)
    assert again.samples.equals(found.samples)


def test_any_start_within_half_a_metre_and_twenty_degrees(survey):
    data_alone = QUICK.replaced(hand_measured_prior=False, n_draws=20)
    near = adjust(survey, CAMERA, hand(), settings=data_alone)
    far = adjust(survey, CAMERA, hand(0.5, np.deg2rad(20)), settings=data_alone)
    assert np.allclose(near.pose, far.pose, atol=0.02 * near.sigma.max())


def test_one_pass_over_one_place_leaves_open_what_it_cannot_tell():
    survey = timed_survey.make_survey(12, 8, seed=21).select([1, 2])
    found = adjust(survey, CAMERA, hand(0.02, 0.01), settings=QUICK)
    prior = np.array([0.1] * 3)
    assert np.all(found.sigma[:3] < 1.2 * prior)
    assert len(found.diagnostics.open_directions) > 0
    assert any("to the hand measurement" in line for line in found.diagnostics.warnings)


def test_a_hand_measurement_far_off_is_told(survey):
    far = hand(0.3)
    found = adjust(survey, CAMERA, far, covariance_of_sigmas(0.01, 0.1), QUICK)
    assert np.nanmax(np.abs(found.diagnostics.disagreement_sigmas)) > 3
    assert any("disagree" in line for line in found.diagnostics.warnings)


@pytest.mark.parametrize(("off_m", "sigma_m", "far"), [(1.9, 0.01, False), (2.1, 0.01, True), (2.1, 0.2, False)])
def test_where_no_tape_measure_can_have_been(off_m, sigma_m, far):
    known = hand_measured(timed_survey.POSE, covariance_of_sigmas(sigma_m, 0.1))
    assert ran_off(known, timed_survey.POSE[:3] - [0.0, off_m, 0.0]) is far
    assert not ran_off(None, timed_survey.POSE[:3] + 100.0)


def test_without_times_drift_is_not_known_and_that_is_said(survey):
    found = adjust(replace(survey, time_us=np.zeros_like(survey.time_us)), CAMERA, hand(0.02), settings=QUICK)
    assert not found.diagnostics.drift_known
    assert found.levels.drift == 0
    assert np.all(np.isnan(found.level_intervals[0]))
    assert any("without times" in line for line in found.diagnostics.warnings)


def test_one_point_a_view_and_missing_points(survey):
    sparse = survey.u_px.copy()
    sparse[np.arange(12)[:, None], (np.arange(12)[:, None] + [1, 2, 3, 4, 5]) % 8] = np.nan
    sparse[0, :] = np.nan
    sparse[0, 3] = survey.u_px[0, 3]
    found = adjust(replace(survey, u_px=sparse), CAMERA, hand(0.02), settings=QUICK)
    assert np.all(np.isfinite(found.covariance))
    assert np.isnan(found.corrections[0, 2]).all()
    assert np.isfinite(found.corrections[0, 3]).all()


def test_control_points_are_used(survey):
    points = np.nan_to_num(adjust(survey, CAMERA, timed_survey.POSE, settings=QUICK).points_m)
    known = KnownPoints(points, np.tile(np.eye(3) / 0.002**2, (8, 1, 1)))
    without = adjust(survey, CAMERA, hand(0.05, 0.02), settings=QUICK)
    found = adjust(survey, CAMERA, hand(0.05, 0.02), settings=QUICK, known_points=known)
    assert np.all(found.sigma < 1.05 * without.sigma)


def test_views_from_one_and_the_same_place_say_nothing_of_points(survey):
    one = survey.select([4])
    fields = ("u_px", "position_m", "euler_rad", "covariance", "nav_gap_s")
    twice = {name: np.concatenate([getattr(one, name)] * 2) for name in fields}
    time = np.concatenate([one.time_us, one.time_us + 60_000_000])
    both = replace(one, number=np.array([1, 2]), time_us=time, **twice)
    with pytest.raises(EstimationError, match="singular"):
        adjust(both, CAMERA, hand(), settings=QUICK)


def test_a_zero_covariance_is_a_perfect_navigation(survey):
    found = adjust(replace(survey, covariance=0 * survey.covariance), CAMERA, hand(0.02), settings=QUICK)
    assert np.all(np.isfinite(found.covariance))
    assert np.nanmax(np.abs(found.corrections[..., 3:])) < 0.02


def test_a_singular_covariance_is_a_navigation_that_knows_some_axes(survey):
    covariance = survey.covariance.copy()
    covariance[..., 2, :] = covariance[..., :, 2] = 0.0
    found = adjust(replace(survey, covariance=covariance), CAMERA, hand(0.02), settings=QUICK)
    assert np.all(np.isfinite(found.covariance))
    assert np.nanmax(np.abs(found.corrections[..., 2])) < 0.02  # but for lateness


def test_points_of_a_view_at_one_time(survey):
    time = survey.time_us.copy()
    time[3, 2:5] = time[3, 2]
    found = adjust(replace(survey, time_us=time), CAMERA, hand(0.02), settings=QUICK)
    assert np.all(np.isfinite(found.covariance))
    assert found.diagnostics.converged


def test_passes_along_one_straight_line_leave_the_height_of_the_camera_to_the_hand_measurement():
    flight = strips.make_flight(4, 30).select([1, 2])
    start = strips.POSE + np.array([0.03, 0.02, -0.05, 0.0, 0.0, 0.0])
    found = adjust(flight, CAMERA, start, settings=QUICK.replaced(line_period_s=strips.LINE_S))
    assert found.diagnostics.converged
    assert "r_z_m" in found.diagnostics.open_directions
    assert not any("disagree" in line for line in found.diagnostics.warnings)
    assert any("leave r_" in line and "r_z_m" in line for line in found.diagnostics.warnings)
    assert found.pose[2] == pytest.approx(start[2], abs=0.05)
    assert found.sigma[2] == pytest.approx(0.1, rel=0.1)


def test_a_survey_of_which_all_views_are_bad_claims_little(survey, found):
    position = survey.position_m + np.random.default_rng(3).normal(0, 0.5, (12, 1, 3))
    bad = adjust(replace(survey, position_m=position), CAMERA, hand(), settings=QUICK)
    assert np.all(np.isfinite(bad.covariance))
    error = bad.pose - timed_survey.POSE
    assert error @ np.linalg.solve(bad.covariance, error) < 22.5  # chi squared of six, 99.9 %
    assert np.linalg.det(bad.covariance) > 1e6 * np.linalg.det(found.covariance)


def negative(survey):
    covariance = survey.covariance.copy()
    covariance[3, 2, 0, 0] *= -1
    return replace(survey, covariance=covariance)


def overlapping(survey):
    time = survey.time_us.copy()
    time[5] = time[4]
    return replace(survey, time_us=time)


def not_finite(survey):
    position = survey.position_m.copy()
    position[2, 1, 0] = np.nan
    return replace(survey, position_m=position)


@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        (negative, "observation 4: .* correlations have the eigenvalue -1"),
        (overlapping, "observations 5 and 6: .* repeat or run back"),
        (not_finite, "observation 3, point 1: .* not finite"),
        (lambda survey: survey.select([4]), "no point that two of them have"),
        (lambda survey: replace(survey, u_px=np.full_like(survey.u_px, np.nan)), "no point that two of them have"),
    ],
)
def test_observations_that_are_of_no_use(survey, spoil, said):
    with pytest.raises(InputError, match=said):
        adjust(spoil(survey), CAMERA, hand(), settings=QUICK)


@pytest.mark.parametrize("covariance", [np.zeros((6, 6)), -np.eye(6), np.ones((6, 6)), np.eye(5)])
def test_hand_covariances_that_are_of_no_use(survey, covariance):
    with pytest.raises(InputError, match="hand measurement"):
        adjust(survey, CAMERA, hand(), covariance, QUICK)


def test_a_camera_that_claims_to_be_known_exactly(survey):
    exact = CAMERA.replaced(sigmas=CAMERA.sigmas.replaced(principal_point_px=0.0, focal_length_m=0.0))
    with pytest.raises(
        InputError, match=r"^camera.sigmas.principal_point_px and camera.sigmas.focal_length_m: found 0"
    ):
        adjust(survey, exact, hand(), settings=QUICK)


def test_a_camera_that_looks_the_other_way(survey):
    away = rotation_vector_from_matrix(
        matrix_from_rotation_vector(timed_survey.POSE[3:]) @ matrix_from_rotation_vector([np.pi, 0, 0])
    )
    with pytest.raises(EstimationError, match="behind the camera") as raised:
        adjust(survey, CAMERA, np.concatenate([timed_survey.POSE[:3], away]), settings=QUICK)
    assert "\n" not in str(raised.value)
    assert "in 12 of 12 observations (1, 2, 3, 4, 5, ...); correct the hand-measured pose" in str(raised.value)


def test_an_observation_that_is_far_off_is_named(survey):
    position = survey.position_m.copy()
    position[3] += 10.0
    with pytest.raises(EstimationError, match=r"in 1 of 12 observations \(4\); leave these out"):
        adjust(replace(survey, position_m=position), CAMERA, hand(), settings=QUICK)


def test_two_observations_are_judged_with_the_hand_measurement_as_equations(survey):
    found = adjust(survey.select([1, 2]), CAMERA, hand(0.02), settings=QUICK)
    n_points = survey.u_px.shape[1]
    assert found.diagnostics.degrees_of_freedom == 2 * 2 * n_points - 3 * n_points
    assert np.isfinite(found.diagnostics.reduced_chi_squared)


def test_line_period_from_time_stamps():
    random = np.random.default_rng(2)
    lines = np.sort(random.integers(0, 400, (10, 12)), axis=1)
    time = np.rint(7503.4 * lines).astype(np.int64) + random.integers(-60, 60, lines.shape)
    time += 30_000_000 * np.arange(10)[:, None]
    view = np.repeat(np.arange(10), 12)
    assert line_period_s(time.ravel(), view) == pytest.approx(7503.4e-6, rel=1e-3)
    uneven = time + random.integers(-4000, 4000, lines.shape)
    assert line_period_s(uneven.ravel(), view) is None

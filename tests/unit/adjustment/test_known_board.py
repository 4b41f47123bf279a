"""A board whose geometry is known: against six explicit parameters of its pose, and over surveys with a known truth."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from scipy.stats import chi2, norm

from linepose.adjustment import AdjustmentSettings, KnownPoints, adjust
from linepose.adjustment.board_fit import scale_of_board
from linepose.adjustment.known_board import moved_with_board
from linepose.adjustment.normal import point_covariances, trailing_inverse
from linepose.adjustment.prediction import predicted_covariance
from linepose.adjustment.settings import default_hand_covariance
from linepose.errors import InputError
from linepose.geometry.distance import difference_covariance, pose_difference
from unit.adjustment import dense, timed_survey
from unit.adjustment.test_against_dense import LEVELS, Case

N_POINTS, SIGMA_M = 8, 0.002
N_SURVEYS = 24
QUICK = AdjustmentSettings(line_period_s=timed_survey.LINE_S, n_draws=20, n_samples=10)


def true_points(seed, n_points=N_POINTS):
    """The points that `timed_survey.make_survey` draws."""
    return np.random.default_rng(seed).uniform([-0.6, -0.6, 0.2], [0.6, 0.6, 0.6], (n_points, 3))


def board(points_m, seed=1, stretch=(1.0, 1.0, 1.0)):
    """Points as they were measured in a frame that lies anywhere."""
    random = np.random.default_rng([seed, 9])
    turned = Rotation.random(random_state=seed).apply(points_m) + random.normal(size=3)
    measured = (turned + SIGMA_M * random.normal(size=turned.shape)) * stretch
    nothing = np.zeros((len(points_m), 3)), np.zeros((len(points_m), 3, 3))
    return KnownPoints(*nothing, board_m=measured, board_sigma_m=SIGMA_M)


def adjusted(known, seed=5, n_views=6, hand=timed_survey.POSE, settings=QUICK):
    survey = timed_survey.make_survey(n_views, N_POINTS, seed=seed)
    return adjust(survey, timed_survey.CAMERA, hand, settings=settings, known_points=known)


def test_the_normal_equations_are_those_with_six_parameters_of_the_board_s_pose():
    known = board(true_points(3, 6))
    survey = timed_survey.make_survey(5, 6, seed=3)
    case = Case(LEVELS, survey, known, with_dense=False)
    case._dense(survey)
    points, measured = case.state.points_m, known.board_m
    off, here = measured - measured.mean(axis=0), points.mean(axis=0)
    rotation = Rotation.align_vectors(points - here, off)[0].as_matrix()

    def on_board(pose):
        return ((dense.vector_matrix(pose[3:]) @ rotation @ off.T).T + here + pose[:3]).ravel() / SIGMA_M

    by_pose = dense.complex_step(on_board, np.zeros(6))
    left = points.ravel() / SIGMA_M - on_board(np.zeros(6))
    n = case.a.shape[1]
    rows = np.zeros((len(left), n + 6))
    rows[:, : len(left)], rows[:, n:] = np.eye(len(left)) / SIGMA_M, -by_pose
    inverse = np.linalg.inv(case.covariance)
    normal, right = rows.T @ rows, -rows.T @ left
    plain = replace(case.measurements, known=known.without_board)
    camera = case.knowledge.prior(case.state, plain)
    normal[n - 10 : n, n - 10 : n] += camera.camera
    right[n - 10 : n] += camera.camera_vector
    normal[:n, :n] += case.a.T @ inverse @ case.a
    right[:n] += case.a.T @ inverse @ case.e
    step, covariance = np.linalg.solve(normal, right), np.linalg.inv(normal)
    before = case.e @ inverse @ case.e + camera.chi_squared + left @ left
    assert case.done.chi_squared == pytest.approx(before - right @ step, rel=1e-8)
    assert np.allclose(trailing_inverse(case.done.upper, 9), covariance[n - 9 : n, n - 9 : n], rtol=1e-6)
    of_points = point_covariances(case.done.upper, np.zeros(6))
    for k in range(6):
        block = slice(3 * k, 3 * k + 3)
        assert np.allclose(of_points[k], covariance[block, block], rtol=1e-6, atol=1e-12)
    # the board's own determinant is one number, wherever the points are
    expected = np.linalg.slogdet(case.covariance)[1] + np.linalg.slogdet(normal)[1]
    own = np.linalg.slogdet(by_pose.T @ by_pose)[1]
    assert case.done.log_determinant == pytest.approx(expected - own, rel=1e-8)


def test_a_step_turns_the_board_as_one_body():
    random = np.random.default_rng(2)
    points = random.normal(size=(5, 3))
    turn, middle = np.array([0.4, -0.3, 0.5]), points.mean(axis=0)
    shift = np.array([1.0, 2.0, 3.0])
    moved = moved_with_board(points, points, np.cross(turn, points - middle) + shift)
    assert np.allclose(moved, Rotation.from_rotvec(turn).apply(points - middle) + middle + shift)
    # what is not of one body is added as it is, and small steps are linear
    step = 1e-6 * random.normal(size=(5, 3))
    noisy = points + 1e-3 * random.normal(size=(5, 3))
    assert np.allclose(moved_with_board(points, noisy, step), noisy + step, rtol=0, atol=1e-11)


@pytest.mark.statistical
def test_squared_errors_add_up_to_chi_squared_and_a_right_board_fits():
    prior = default_hand_covariance()
    total, misfits, gains = 0.0, [], []
    settings = QUICK.replaced(n_draws=40)
    for seed in range(700, 700 + N_SURVEYS):
        random = np.random.default_rng([seed, 3])
        hand = timed_survey.POSE + 0.0
        hand[:3] += np.sqrt(np.diag(prior)[:3]) * random.normal(size=3)
        turned = Rotation.from_rotvec(np.sqrt(np.diag(prior)[3:]) * random.normal(size=3))
        hand[3:] = (turned * Rotation.from_rotvec(timed_survey.POSE[3:])).as_rotvec()
        found = adjusted(board(true_points(seed), seed), seed, hand=hand, settings=settings)
        error = pose_difference(timed_survey.POSE, found.pose)
        total += error @ np.linalg.solve(difference_covariance(found.pose, found.covariance), error)
        told = found.diagnostics.board
        misfits.append(told.misfit_sigmas)
        gains.append(np.sum(np.log(found.sigma / told.sigma_without)))
    # 99.8 % of a chi squared of six for each survey, wider by 10 % of a sigma that few draws leave open
    low, high = chi2.ppf([0.001, 0.999], 6 * N_SURVEYS)
    assert 0.8 * low < total < 1.2 * high
    # misfits are standard normal: 99.8 % of their mean, and of the sum of their squares
    assert abs(np.mean(misfits)) < norm.ppf(0.999) / np.sqrt(N_SURVEYS)
    low, high = chi2.ppf([0.001, 0.999], N_SURVEYS)
    assert low < np.sum(np.square(misfits)) < high
    assert np.mean(gains) < 0


@pytest.mark.parametrize(
    ("wrong", "told"),
    [
        (lambda one: replace(one, board_m=one.board_m * [1.1, 1.0, 1.0]), "0.9"),
        (lambda one: replace(one, board_m=one.board_m[::-1]), "times as long along its rows"),
    ],
)
def test_a_wrong_geometry_is_told_in_sigmas_and_not_used(wrong, told):
    found = adjusted(wrong(board(true_points(5))))
    fit = found.diagnostics.board
    assert fit.misfit_sigmas > 4
    assert not fit.counts
    warning = next(one for one in found.diagnostics.warnings if "known geometry" in one)
    assert f"{fit.misfit_sigmas:.0f} sigmas off" in warning
    assert told in warning
    plain = adjusted(None)
    np.testing.assert_array_equal(found.pose, plain.pose)
    np.testing.assert_array_equal(found.covariance, plain.covariance)


def test_the_scale_at_which_a_board_is_seen_is_told():
    points = true_points(5) * [1.0, 1.0, 0.0] + [0.0, 0.0, 0.4]
    known = board(points)
    stretched = replace(known, board_m=(points - 0.1) * [1.25, 0.8, 1.0])
    assert scale_of_board(stretched.board_m, points) == pytest.approx([0.8, 1.25])


def test_a_board_that_fits_is_told_with_what_it_gained():
    known = board(true_points(5))
    found = adjusted(known)
    told = found.diagnostics.board
    assert told.counts
    assert told.n_points == N_POINTS
    np.testing.assert_array_equal(told.sigma_without, adjusted(None).sigma)
    # points keep the shape that was measured: 3 n - 6 of their differences are known to the sigma, others not
    off = found.points_m - found.points_m.mean(axis=0)
    measured = known.board_m - known.board_m.mean(axis=0)
    left = off - Rotation.align_vectors(off, measured)[0].apply(measured)
    assert np.sqrt(np.sum(left**2) / (3 * N_POINTS - 6)) < 2 * SIGMA_M


def test_one_ray_to_a_point_counts_where_the_board_holds_it():
    survey = timed_survey.make_survey(6, N_POINTS, seed=5)
    single = timed_survey.without(survey, *[(row, 0) for row in range(1, 6)])
    known = board(true_points(5))
    hand = timed_survey.POSE
    assert np.isnan(adjust(single, timed_survey.CAMERA, hand, settings=QUICK).points_m[0, 0])
    found = adjust(single, timed_survey.CAMERA, hand, settings=QUICK, known_points=known)
    others = np.isin(np.arange(N_POINTS), [1, 2, 3])
    along = found.points_m[others] - found.points_m[0]
    measured = known.board_m[others] - known.board_m[0]
    assert np.allclose(np.linalg.norm(along, axis=1), np.linalg.norm(measured, axis=1), atol=5 * SIGMA_M)
    two = replace(known, board_m=np.where(np.arange(N_POINTS)[:, None] < 2, known.board_m, np.nan))
    assert np.isnan(adjust(single, timed_survey.CAMERA, hand, settings=QUICK, known_points=two).points_m[0, 0])


def test_more_points_than_are_adjusted_at_once_are_refused():
    points = true_points(0, 151)
    survey = timed_survey.make_survey(2, 151, seed=0)
    with pytest.raises(InputError, match="151 points, expected at most 150"):
        adjust(survey, timed_survey.CAMERA, timed_survey.POSE, settings=QUICK, known_points=board(points))


def test_predicted_sigmas_count_the_board():
    survey = timed_survey.make_survey(3, 61, seed=1)
    points = true_points(1, 61)
    known = board(points)
    plain, with_it = (
        predicted_covariance(survey, timed_survey.CAMERA, timed_survey.POSE, points, LEVELS, None, one)
        for one in (None, known)
    )
    assert np.all(np.diag(with_it) < np.diag(plain))

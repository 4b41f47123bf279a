"""One pass against dense matrices: chi squared, determinants, covariance and corrections."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import least_squares

from linepose.adjustment.estimate import unit_weights
from linepose.adjustment.hand_measured import hand_measured
from linepose.adjustment.known_points import KnownPoints
from linepose.adjustment.levels import Levels
from linepose.adjustment.linearise import empty_linearised, linearise
from linepose.adjustment.measurements import measurements_from_survey
from linepose.adjustment.normal import solve_step, trailing_inverse, whitened_residual
from linepose.adjustment.process import Weights, corrections
from linepose.adjustment.residuals import normalised_residuals
from linepose.adjustment.settings import covariance_of_sigmas
from linepose.adjustment.solve import model_at, pass_at, solve
from linepose.adjustment.start import start_points
from linepose.adjustment.state import Knowledge, state_at
from linepose.adjustment.whitening import unwhiten
from linepose.geometry.rotations import matrix_from_rotation_vector, rotation_vector_from_matrix
from unit.adjustment import dense, timed_survey

CAMERA = timed_survey.CAMERA
HAND = timed_survey.POSE + np.array([0.03, -0.02, 0.04, 0.01, -0.02, 0.015])
LEVELS = Levels(0.5, 0.2, 0.4, 0.6, 0.7, 25.0, 0.6)
LIMITS = {
    "all": LEVELS,
    "white only": LEVELS._replace(drift=0.0, constant=0.0),
    "constant only": LEVELS._replace(drift=0.0, white=0.0),
    "drift that never ends": LEVELS._replace(constant=0.0, correlation_time_s=1e12),
    "drift that ends at once": LEVELS._replace(constant=0.0, correlation_time_s=1e-9),
    "no navigation error": LEVELS._replace(drift=0.0, constant=0.0, white=0.0),
}


class Case:
    """A survey, a state with corrections that are not zero, weights that are not one, and the same in dense form."""

    def __init__(self, levels, survey=None, known=None, with_dense=True):
        random = np.random.default_rng(5)
        survey = survey or timed_survey.without(timed_survey.make_survey(5, 6, seed=3), (0, 1), (3, 2), (4, 5))
        self.measurements = m = measurements_from_survey(survey, CAMERA, known, line_period_s=timed_survey.LINE_S)
        self.knowledge = Knowledge(CAMERA, hand_measured(HAND, covariance_of_sigmas(0.1, np.deg2rad(2))), 0.02)
        n = len(m.u_px)
        start = state_at(timed_survey.POSE, CAMERA, start_points(m, CAMERA, timed_survey.POSE), m)
        self.state = replace(start, correction=1e-3 * random.normal(size=(n, 6)), clock_offset_s=0.03)
        self.levels = levels
        self.weights = Weights(random.uniform(0.3, 1.2, m.n_views), random.uniform(0.3, 1.2, n))
        self.model = model_at(m, self.knowledge, self.state)
        self.process, self.done = pass_at(m, self.model, levels, self.weights)
        if with_dense:
            self._dense(survey)

    def _dense(self, survey):
        m, state = self.measurements, self.state
        residual, by_theta, by_point, by_body = dense.linearised(
            CAMERA, state.position_m, state.rotation, m, state.points_m, state.body_poses(m)
        )
        time_s = survey.time_us[m.row, m.column] * 1e-6
        weights = self.weights
        self.of_bodies = dense.body_covariance(
            m,
            survey.covariance[m.row, m.column],
            time_s,
            m.structure.motion,
            self.levels,
            weights.of_view,
            weights.of_measurement,
        )
        self.covariance, self.image = dense.measurement_covariance(
            by_body, self.of_bodies, self.levels, CAMERA, weights.of_measurement
        )
        self.e = residual + self.image @ state.correction.ravel()
        self.a = dense.design(m, by_theta, by_point)
        prior = self.knowledge.prior(state, m)
        self.information = np.zeros((self.a.shape[1],) * 2)
        self.vector = np.zeros(self.a.shape[1])
        self.information[-10:, -10:], self.vector[-10:] = prior.camera, prior.camera_vector
        for k in range(m.n_points):
            block = slice(3 * k, 3 * k + 3)
            self.information[block, block] = prior.points[k]
            self.vector[block] = prior.points_vector[k]
        inverse = np.linalg.inv(self.covariance)
        self.normal = self.a.T @ inverse @ self.a + self.information
        self.right = self.a.T @ inverse @ self.e + self.vector
        self.step = np.linalg.solve(self.normal, self.right)
        self.chi_squared = self.e @ inverse @ self.e + prior.chi_squared - self.right @ self.step


@pytest.fixture(params=LIMITS, scope="module")
def case(request):
    return Case(LIMITS[request.param])


def test_derivatives_by_complex_step():
    case = Case(LEVELS)
    m, state = case.measurements, case.state
    bodies = state.body_poses(m)
    out = empty_linearised(len(m.u_px))
    assert linearise(m.u_px, bodies, m.rate, m.point, state.points_m, m.known.shifts, state.optics(CAMERA), out) == 0
    expected = dense.linearised(CAMERA, state.position_m, state.rotation, m, state.points_m, bodies)
    for found, value in zip(out, expected, strict=True):
        # a product of some ten factors, each rounded once
        assert np.allclose(found.reshape(value.shape), value, rtol=1e-12, atol=1e-12 * np.abs(value).max())


def test_chi_squared_and_determinants(case):
    assert case.done.chi_squared == pytest.approx(case.chi_squared, rel=1e-9)
    expected = np.linalg.slogdet(case.covariance)[1] + np.linalg.slogdet(case.normal)[1]
    assert case.done.log_determinant == pytest.approx(expected, rel=1e-9, abs=1e-9)
    assert case.done.factor.log_determinant == pytest.approx(np.linalg.slogdet(case.covariance)[1], rel=1e-9)


def test_covariance_of_pose_and_intrinsics(case):
    scale = np.sqrt(np.diag(np.linalg.inv(case.normal))[-9:])
    for size in (6, 9):
        expected = np.linalg.inv(case.normal)[-size:, -size:]
        found = trailing_inverse(case.done.upper, size)
        assert np.allclose((found - expected) / np.outer(scale[-size:], scale[-size:]), 0, atol=1e-7)


def test_step(case):
    sigma = np.sqrt(np.diag(np.linalg.inv(case.normal)))
    found = solve_step(case.done.upper, 3 * case.measurements.n_points, 0.0)
    assert np.allclose((found - case.step) / sigma, 0, atol=1e-8)


def test_corrections_are_the_expected_errors_of_the_bodies(case):
    left = case.e - case.a @ case.step
    expected = (case.of_bodies @ case.image.T @ np.linalg.solve(case.covariance, left)).reshape(-1, 6)
    dual = unwhiten(case.done.factor, whitened_residual(case.done, case.step))
    found, z, q = corrections(
        case.measurements.structure, case.process, case.model.linearised, case.levels, case.weights, dual
    )
    assert np.allclose(found / timed_survey.SIGMA, expected / timed_survey.SIGMA, rtol=0, atol=1e-9)
    assert z.shape == (len(case.e) // 2, 6)
    assert q.shape == (case.measurements.n_views, 6)


def test_normalised_residuals_have_the_variance_of_the_model(case):
    root = np.linalg.cholesky(case.covariance)
    whitened = np.linalg.solve(root, case.e - case.a @ case.step)
    columns = np.linalg.solve(root, case.a)
    redundancy = 1 - np.einsum("ij,jk,ik->i", columns, np.linalg.inv(case.normal), columns)
    found = normalised_residuals(case.done).ravel()
    good = redundancy > 1e-4
    assert np.allclose(found[good], (whitened / np.sqrt(np.maximum(redundancy, 1e-300)))[good], atol=1e-6)


def test_drift_that_ends_at_once_is_white_and_one_that_never_ends_in_one_view_is_constant():
    case = Case(LEVELS)
    weights = unit_weights(case.measurements)
    both = float(np.hypot(LEVELS.drift, LEVELS.white))
    ends = LEVELS._replace(correlation_time_s=1e-9)
    white = LEVELS._replace(drift=0.0, white=both)
    one, other = (pass_at(case.measurements, case.model, levels, weights)[1] for levels in (ends, white))
    assert one.chi_squared == pytest.approx(other.chi_squared, rel=1e-9)
    assert one.log_determinant == pytest.approx(other.log_determinant, rel=1e-9)
    view = case.measurements.structure._replace(
        begins=np.arange(len(weights.of_measurement)) == 0, view_of=np.zeros_like(case.measurements.view)
    )
    single = replace(case.measurements, structure=view)
    weights = weights._replace(of_view=np.ones(1))
    both = float(np.hypot(LEVELS.drift, LEVELS.constant))
    stays = LEVELS._replace(correlation_time_s=1e14)
    constant = LEVELS._replace(drift=0.0, constant=both)
    one, other = (pass_at(single, case.model, levels, weights)[1] for levels in (stays, constant))
    assert one.chi_squared == pytest.approx(other.chi_squared, rel=1e-7)
    assert one.log_determinant == pytest.approx(other.log_determinant, rel=1e-7)


def test_without_times_views_follow_one_another_and_nothing_drifts():
    survey = timed_survey.make_survey(4, 5, seed=8)
    untimed = replace(survey, time_us=np.zeros_like(survey.time_us))
    m = measurements_from_survey(untimed, CAMERA)
    assert not m.timed
    assert np.all(m.structure.motion == 0)
    assert np.all(m.structure.late_px > 0)
    case = Case(LEVELS._replace(drift=0.0), survey=untimed)
    late = case.levels.lateness * case.measurements.structure.late_px
    case.covariance += np.diag(np.column_stack([0 * late, late**2 / case.weights.of_measurement]).ravel())
    assert case.done.factor.log_determinant == pytest.approx(np.linalg.slogdet(case.covariance)[1], rel=1e-9)


def test_points_of_which_something_is_known():
    survey = timed_survey.make_survey(3, 5, seed=4)
    information = np.zeros((5, 3, 3))
    information[1], information[3] = np.eye(3) / 0.02**2, np.diag([0.0, 0.0, 1 / 0.05**2])
    case = Case(LEVELS, survey=survey, known=KnownPoints(np.zeros((5, 3)), information))
    assert case.done.chi_squared == pytest.approx(case.chi_squared, rel=1e-9)
    expected = np.linalg.slogdet(case.covariance)[1] + np.linalg.slogdet(case.normal)[1]
    assert case.done.log_determinant == pytest.approx(expected, rel=1e-9)


def test_heights_that_err_in_common():
    survey = timed_survey.make_survey(3, 5, seed=4)
    information = np.zeros((5, 3, 3))
    information[:4, 2, 2] = 1 / 0.02**2
    shifts = np.array([1.0, 1.0, 0.0, 1.0, 0.0])
    case = Case(LEVELS, survey=survey, known=KnownPoints(np.zeros((5, 3)), information, shifts, 0.3))
    assert case.done.chi_squared == pytest.approx(case.chi_squared, rel=1e-9)
    # the same as heights whose errors have a common part, with no parameter for it
    plain = Case(LEVELS, survey=survey)
    together = np.zeros_like(plain.information)
    rows = 3 * np.flatnonzero(shifts) + 2
    together[np.ix_(rows, rows)] = np.linalg.inv(0.02**2 * np.eye(3) + 0.3**2)
    together[8, 8] = 1 / 0.02**2
    expected = np.linalg.inv(plain.normal + together)
    # points as they are follow the shift, which the columns count apart
    found, follow = np.linalg.inv(case.normal), np.eye(len(case.normal))
    follow[rows, -8] = 1.0
    found = follow @ found @ follow.T
    others = [i for i in range(len(found)) if i != len(found) - 8]
    assert np.allclose(found[np.ix_(others, others)], expected[np.ix_(others, others)], rtol=1e-7, atol=1e-14)


def test_least_squares_over_all_unknowns_finds_the_same_optimum():
    survey = timed_survey.make_survey(3, 3, seed=12)
    case = Case(LEVELS, survey=survey)
    m, n = case.measurements, len(case.measurements.u_px)
    weights = unit_weights(m)
    found = solve(m, case.knowledge, replace(case.state, correction=np.zeros((n, 6))), LEVELS, weights, tolerance=1e-14)
    plain = dense.body_covariance(
        m,
        survey.covariance[m.row, m.column],
        survey.time_us[m.row, m.column] * 1e-6,
        m.structure.motion,
        LEVELS,
        weights.of_view,
        weights.of_measurement,
    )
    values, vectors = np.linalg.eigh(plain / np.outer(np.tile(timed_survey.SIGMA, n), np.tile(timed_survey.SIGMA, n)))
    kept = values > 1e-12 * values[-1]
    root = np.tile(timed_survey.SIGMA, n)[:, None] * vectors[:, kept] * np.sqrt(values[kept])
    base = found.state
    pixel = np.array([LEVELS.pixel * CAMERA.sigmas.u_px, 0.05])
    hand = case.knowledge.hand

    whitening = np.linalg.inv(np.linalg.cholesky(hand.covariance))
    sigmas = [CAMERA.sigmas.principal_point_px, CAMERA.sigmas.focal_length_m]

    def residuals(x):
        camera, points, latent = x[:9] * scale, x[9 : 9 + 3 * m.n_points].reshape(-1, 3), x[9 + 3 * m.n_points :]
        offset_s = base.clock_offset_s + camera[8]
        bodies = m.body_pose + offset_s * m.rate + (root @ latent).reshape(-1, 6)
        intrinsics = np.array(
            [
                base.principal_point_px + camera[6] - CAMERA.principal_point_px,
                base.focal_length_m + camera[7] - CAMERA.focal_length_m,
            ]
        )
        step = np.concatenate([[0] * 6, intrinsics])
        lever, rotation = base.position_m + camera[:3], dense.vector_matrix(camera[3:6]) @ base.rotation
        rows = [
            ([m.u_px[i], 0] - dense.project(CAMERA, lever, rotation, step, bodies[i], points[k])) / pixel
            for i, k in enumerate(m.point)
        ]
        turn = rotation_vector_from_matrix(matrix_from_rotation_vector(hand.pose[3:]) @ rotation.T)
        off = whitening @ np.concatenate([hand.pose[:3] - lever, turn])
        return np.concatenate([*rows, latent, off, intrinsics / sigmas, [offset_s / 0.02]])

    scale = np.sqrt(np.diag(trailing_inverse(found.done.upper, 10)))[[4, 5, 6, 7, 8, 9, 0, 1, 3]]
    random = np.random.default_rng(1)
    start = np.concatenate([0.5 * random.normal(size=9), base.points_m.ravel(), np.zeros(root.shape[1])])
    best = least_squares(residuals, start, method="trf", x_scale="jac", xtol=1e-13, ftol=1e-14, gtol=1e-12)
    assert 2 * best.cost == pytest.approx(found.done.chi_squared, rel=1e-6)
    assert np.allclose(best.x[:9], 0, atol=2e-4)  # sigmas: the square root of what chi squared is flat by

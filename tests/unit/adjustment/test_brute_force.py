"""A sampler of everything (pose, intrinsics, points, errors of the bodies) beside the adjustment at its levels."""

from dataclasses import replace

import numpy as np
import pytest

from linepose.adjustment.curvature import curvature
from linepose.adjustment.estimate import unit_weights
from linepose.adjustment.hand_measured import hand_measured
from linepose.adjustment.levels import Levels
from linepose.adjustment.linearise import empty_linearised, linearise
from linepose.adjustment.measurements import measurements_from_survey
from linepose.adjustment.normal import trailing_inverse
from linepose.adjustment.settings import covariance_of_sigmas
from linepose.adjustment.solve import solve
from linepose.adjustment.start import start_points
from linepose.adjustment.state import Knowledge, state_at
from linepose.geometry.rotations import matrix_from_rotation_vector
from unit.adjustment import dense, timed_survey

CAMERA, POSE = timed_survey.CAMERA, timed_survey.POSE
ERRORS = timed_survey.Errors(drift=0.1, white=0.05, constant=0.1, correlation_time_s=20.0)
LEVELS = Levels(0.1, 0.05, 0.1, 0.5, 0.5, 20.0, 1.0)
N_WALKS, N_DRAWS, N_BURNED, N_LEAPS, LEAP = 2, 600, 50, 6, 0.25


class Everything:
    """The density of steps of pose and intrinsics (8), of points, and of standard normal errors, all in one vector."""

    def __init__(self):
        survey = timed_survey.make_survey(4, 5, ERRORS, seed=61)
        self.m = m = measurements_from_survey(survey, CAMERA, line_period_s=timed_survey.LINE_S)
        self.knowledge = Knowledge(CAMERA, hand_measured(POSE, covariance_of_sigmas(0.01, np.deg2rad(0.3))))
        self.weights = unit_weights(m)
        start = state_at(POSE, CAMERA, start_points(m, CAMERA, POSE), m)
        self.found = solve(m, self.knowledge, start, LEVELS, self.weights, tolerance=1e-12)
        time_s = survey.time_us[m.row, m.column] * 1e-6
        covariance = survey.covariance[m.row, m.column]
        ones = self.weights
        full = dense.body_covariance(
            m, covariance, time_s, m.structure.motion, LEVELS, ones.of_view, ones.of_measurement
        )
        scale = np.tile(timed_survey.SIGMA, len(m.u_px))
        values, vectors = np.linalg.eigh(full / np.outer(scale, scale))
        self.root = scale[:, None] * vectors[:, values > 0] * np.sqrt(values[values > 0])
        self.pixel = np.array([LEVELS.pixel * CAMERA.sigmas.u_px, 0.05])
        self.n_points = 3 * m.n_points

    def split(self, x):
        return x[:8], x[8 : 8 + self.n_points].reshape(-1, 3), x[8 + self.n_points :]

    def value_and_slopes(self, x):
        """Half of chi squared, its gradient, and the Jacobian of the residuals of the measurements."""
        theta, points, errors = self.split(x)
        m, base = self.m, self.found.state
        state = replace(
            base,
            position_m=base.position_m + theta[:3],
            rotation=matrix_from_rotation_vector(theta[3:6]) @ base.rotation,
            principal_point_px=base.principal_point_px + theta[6],
            focal_length_m=base.focal_length_m + theta[7],
            points_m=base.points_m + points,
            correction=(self.root @ errors).reshape(-1, 6),
        )
        out = empty_linearised(len(m.u_px))
        rates = self.knowledge.rates(m)
        optics, shifts = state.optics(CAMERA), m.known.shifts
        behind = linearise(m.u_px, state.body_poses(m), rates, m.point, state.points_m, shifts, optics, out)
        if behind:
            return np.inf, np.zeros_like(x), None
        residual = out.residual_px / self.pixel
        row = residual / self.pixel
        prior = self.knowledge.prior(state, m)
        gradient = np.zeros_like(x)
        gradient[:8] = -np.einsum("lri,lr->i", out.by_theta[..., :8], row)
        # the turn's own Jacobian differs from one by half of a turn of milliradians
        gradient[:6] -= prior.camera_vector[-6:]
        gradient[6:8] -= prior.camera_vector[:2]
        by_point = np.zeros((m.n_points, 3))
        np.add.at(by_point, m.point, np.einsum("lri,lr->li", out.by_point, row))
        gradient[8 : 8 + self.n_points] = -by_point.ravel()
        gradient[8 + self.n_points :] = errors - self.root.T @ np.einsum("lri,lr->li", out.by_body, row).ravel()
        value = 0.5 * (np.sum(residual**2) + prior.chi_squared + errors @ errors)
        return value, gradient, (out, prior)

    def whitening(self):
        """Mode (D,) and root (D, D) of the covariance there."""
        x = np.zeros(8 + self.n_points + self.root.shape[1])
        x[8 + self.n_points :] = np.linalg.lstsq(self.root, self.found.state.correction.ravel(), rcond=None)[0]
        _, _, (out, prior) = self.value_and_slopes(x)
        n = len(self.m.u_px)
        rows = np.zeros((2 * n, len(x)))
        rows[:, :8] = out.by_theta[..., :8].reshape(2 * n, 8)
        for line, point in enumerate(self.m.point):
            rows[2 * line : 2 * line + 2, 8 + 3 * point : 11 + 3 * point] = out.by_point[line]
            of_line = self.root[6 * line : 6 * line + 6]
            rows[2 * line : 2 * line + 2, 8 + self.n_points :] = out.by_body[line] @ of_line
        rows /= np.tile(self.pixel, n)[:, None]
        normal = rows.T @ rows
        normal[:6, :6] += prior.camera[-6:, -6:]
        normal[6:8, 6:8] += prior.camera[:2, :2]
        normal[8 + self.n_points :, 8 + self.n_points :] += np.eye(self.root.shape[1])
        return x, np.linalg.inv(np.linalg.cholesky(normal)).T


def walk(everything, mode, root, seed):
    """Hamiltonian Monte Carlo in coordinates in which the density is nearly standard normal; poses (S, 6)."""
    random = np.random.default_rng(seed)
    y = np.zeros(len(mode))
    value, slope, _ = everything.value_and_slopes(mode + root @ y)
    slope = root.T @ slope
    kept, accepted = [], 0
    for draw in range(N_BURNED + N_DRAWS):
        momentum = random.normal(size=len(mode))
        leap = LEAP * random.uniform(0.8, 1.2)
        trial, trial_slope, moved = y, slope, momentum
        for _ in range(N_LEAPS):
            moved = moved - 0.5 * leap * trial_slope
            trial = trial + leap * moved
            trial_value, trial_slope, _ = everything.value_and_slopes(mode + root @ trial)
            trial_slope = root.T @ trial_slope
            moved = moved - 0.5 * leap * trial_slope
        change = trial_value + 0.5 * moved @ moved - value - 0.5 * momentum @ momentum
        if np.log(random.uniform()) < -change:
            y, value, slope, accepted = trial, trial_value, trial_slope, accepted + 1
        if draw >= N_BURNED:
            kept.append((mode + root @ y)[:6])
    assert accepted > 0.5 * draw
    return np.array(kept)


@pytest.mark.statistical
def test_mean_and_sigma_of_the_pose_are_those_of_a_sampler_of_everything():
    everything = Everything()
    mode, root = everything.whitening()
    value, slope, _ = everything.value_and_slopes(mode)
    assert 2 * value == pytest.approx(everything.found.done.chi_squared, rel=1e-6)
    assert np.allclose(root.T @ slope, 0, atol=1e-3)
    walks = np.array([walk(everything, mode, root, seed) for seed in range(N_WALKS)])
    curved = curvature(everything.m, everything.knowledge, everything.found, LEVELS, everything.weights)
    covariance = curved.stretch @ trailing_inverse(everything.found.done.upper, 6) @ curved.stretch.T
    sigma = np.sqrt(np.diag(covariance))
    drawn = walks.reshape(-1, 6)
    batches = drawn.reshape(20, -1, 6).mean(axis=1)
    standard_error = batches.std(axis=0, ddof=1) / np.sqrt(len(batches))
    # the errors of the bodies bend the model, by a tenth of a sigma at these levels
    assert np.all(np.abs(drawn.mean(axis=0)) < 0.1 * sigma + 3 * standard_error)
    # of draws that are nearly independent, four standard errors of a sigma
    assert np.allclose(drawn.std(axis=0), sigma, rtol=4 / np.sqrt(2 * len(drawn)))
    assert np.any(sigma < 0.5 * np.sqrt(np.diag(everything.knowledge.hand.covariance)))

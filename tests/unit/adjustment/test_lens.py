"""The adjustment through a lens: its derivatives, and coefficients that a survey can tell."""

import numpy as np
import pytest

from linepose.adjustment import AdjustmentSettings, adjust
from linepose.adjustment.linearise import empty_linearised, linearise
from linepose.adjustment.measurements import measurements_from_survey
from linepose.adjustment.state import state_at
from linepose.geometry.camera import Camera, off_line, pixel_from_normalised
from linepose.geometry.camera_sigmas import CameraSigmas
from linepose.geometry.distance import difference_covariance, pose_difference
from linepose.geometry.lens import COEFFICIENTS
from linepose.geometry.rotations import matrix_from_euler
from linepose.simulation.flight import FLIGHT_CAMERA, FlightSettings, simulate_flight
from unit.adjustment import timed_survey

ANGLES = np.rad2deg(np.arctan((np.arange(600.0) - 290) / 1000 * (1 + 0.1 * ((np.arange(600.0) - 300) / 600) ** 2)))
TABLE = {
    "pixel": list(range(600)),
    "across_deg": ANGLES.tolist(),
    "along_deg": (0.1 + 0.01 * ANGLES + 2e-3 * ANGLES**2).tolist(),
}
COEFFICIENT_SIGMAS = {"k1": 0.05, "k2": 0.05, "k3": 0.05, "p2": 0.005, "tilt": 0.005, "smile": 0.01}
SIGMAS = timed_survey.CAMERA.sigmas.replaced(**COEFFICIENT_SIGMAS)
BENT = timed_survey.CAMERA.replaced(k3=-0.05, p2=0.01, tilt=0.02, smile=-0.03, sigmas=SIGMAS)
TABULATED = BENT.replaced(view_angles=TABLE)


@pytest.mark.parametrize("camera", [BENT, TABULATED], ids=["polynomial", "table"])
def test_residuals_and_derivatives_are_those_of_the_camera(camera):
    """Residuals from the geometry's own functions; derivatives by central differences of them."""
    survey = timed_survey.make_survey(3, 4, seed=2)
    m = measurements_from_survey(survey, camera, None, timed_survey.LINE_S)
    points = np.random.default_rng(1).uniform([-0.6, -0.6, 0.2], [0.6, 0.6, 0.6], (4, 3))
    state = state_at(timed_survey.POSE, camera, points, m)
    assert state.sought == COEFFICIENTS
    out, still = empty_linearised(len(m.u_px), 6), np.zeros((len(m.u_px), 6))
    arguments = m.u_px, state.body_poses(m), still, m.point
    assert linearise(*arguments, points, m.known.shifts, state.optics(camera), out) == 0

    def residual(step):
        at = state.moved(step, still)
        values = {name: float(getattr(at.lens, name)) for name in COEFFICIENTS}
        moved = camera.replaced(
            principal_point_px=at.principal_point_px, focal_length_m=at.focal_length_m, sigmas=SIGMAS, **values
        )
        body = m.body_pose + at.correction
        off = np.einsum("lji,lj->li", matrix_from_euler(body[:, 3:]), at.points_m[m.point] - body[:, :3])
        seen = (off - at.position_m) @ at.rotation
        u = m.u_px - pixel_from_normalised(moved, seen[:, 0] / seen[:, 2])
        return np.stack([u, -moved.focal_length_px * off_line(moved, seen) / seen[:, 2]], axis=1)

    n = points.size + 16
    np.testing.assert_allclose(out.residual_px, residual(np.zeros(n)), atol=1e-10)
    by_camera = np.concatenate([out.by_theta[..., 6:], out.by_theta[..., :6]], axis=2)
    for k in range(n):
        step = np.zeros(n)
        step[k] = 1e-8 if k == points.size + 1 else 1e-6
        numeric = -(residual(step) - residual(-step)) / (2 * step[k])
        if k < points.size:
            found = np.where((m.point == k // 3)[:, None], out.by_point[:, :, k % 3], 0.0)
        elif k - points.size in (8, 9):  # common shift and clock offset, of which there are none here
            continue
        else:
            found = by_camera[:, :, k - points.size]
        np.testing.assert_allclose(found, numeric, rtol=2e-6, atol=2e-6 * np.abs(numeric).max())


def adjusted(flight, camera):
    settings = AdjustmentSettings(line_period_s=flight.line_period_s, tails=False, n_draws=40, n_samples=60)
    return adjust(flight.survey, camera, flight.hand_pose, flight.hand_covariance, settings)


def sigmas_off(flight, camera):
    """How many sigmas pose (6) and coefficients of the lens are off, in the adjustment with a camera."""
    found = adjusted(flight, camera)
    sigma = np.sqrt(np.diag(difference_covariance(found.pose, found.covariance)))
    of_lens = np.sqrt(np.diag(found.intrinsics_covariance))[2:]
    off = [one - getattr(flight.true_camera, name) for name, one in found.coefficients.items()]
    return pose_difference(found.pose, flight.pose) / sigma, np.array(off) / of_lens, of_lens


def test_a_survey_tells_the_lens_that_was_planted_and_errs_without_it():
    """Of normal errors one of 14 is off by more than 4 sigmas once in 1,100 surveys."""
    planted = {"k1": -0.03, "k2": 0.04, "k3": 0.06, "p2": 0.006, "tilt": 0.004, "smile": 0.012}
    sigmas = FLIGHT_CAMERA.sigmas.replaced(**COEFFICIENT_SIGMAS)
    exact = FLIGHT_CAMERA.replaced(**planted)
    flight = simulate_flight(FlightSettings(n_points=40), 3, exact)
    of_pose, of_lens, sigma = sigmas_off(flight, FLIGHT_CAMERA.replaced(sigmas=sigmas))
    assert np.abs(of_pose).max() < 4
    assert np.abs(of_lens).max() < 4
    told = sigma < 0.5 * np.array(list(COEFFICIENT_SIGMAS.values()))
    assert told.tolist() == [True, False, False, True, False, True]  # k1, p2 and smile; a tilt is a turn of the camera
    assert np.abs(sigmas_off(flight, FLIGHT_CAMERA)[0]).max() > 6


def test_a_survey_is_adjusted_through_a_table_of_angles_and_errs_without_it():
    pixel = np.arange(1024.0)
    angle = np.rad2deg(np.arctan((pixel - 508) / 1107 * (1 + 0.2 * (pixel - 400) / 1107)))
    table = {"pixel": pixel.tolist(), "across_deg": angle.tolist(), "along_deg": (1e-3 * angle**2).tolist()}
    given = Camera(view_angles=table, n_pixels=1024, sigmas=CameraSigmas(u_px=0.4))
    flight = simulate_flight(FlightSettings(n_points=40), 4, given)
    with_table, without = (adjusted(flight, camera) for camera in (given, given.replaced(view_angles=None)))
    sigma = np.sqrt(np.diag(difference_covariance(with_table.pose, with_table.covariance)))
    assert np.abs(pose_difference(with_table.pose, flight.pose) / sigma).max() < 4
    assert np.abs(pose_difference(without.pose, flight.pose) / sigma).max() > 8

"""Known points: heights, surfaces, a shift in common, and control points that contradict the rest."""

from dataclasses import replace

import numpy as np
import pytest

from linepose.adjustment import AdjustmentSettings, adjust
from linepose.adjustment.contradictions import fit_of_known
from linepose.adjustment.known_points import KnownPoints
from linepose.simulation.flight import FlightSettings, simulate_flight
from linepose.simulation.flight_layouts import LAYOUTS

QUICK = AdjustmentSettings(n_draws=20, n_samples=10, max_rounds=3, tails=False, line_period_s=0.01)
HEIGHT = np.diag([0.0, 0.0, 1.0])


@pytest.fixture(scope="module")
def flight():
    return simulate_flight(FlightSettings(strips=LAYOUTS["two-strips"], n_points=24), 11)


def adjusted(flight, known):
    return adjust(flight.survey, flight.camera, flight.hand_pose, flight.hand_covariance, QUICK, known)


def control(flight, sigma_m, which):
    """Control points among the flight's, measured to a sigma."""
    information = np.zeros((24, 3, 3))
    information[which] = np.eye(3) / sigma_m**2
    noise = sigma_m * np.random.default_rng(1).standard_normal((24, 3))
    return KnownPoints(flight.points_m + noise, information)


def test_a_control_point_that_contradicts_the_rest_is_named(flight):
    which = [0, 3, 6, 9, 12, 15]
    known = control(flight, 0.03, which)
    wrong = known.position_m.copy()
    wrong[6] += [1.5, -2.0, 0.5]
    found = adjusted(flight, replace(known, position_m=wrong))
    assert [one.point for one in found.diagnostics.contradictions] == ["6"]
    assert found.known_weight[6] < 0.1
    assert found.known_sigmas[6] > 10
    assert np.all(found.known_weight[[0, 3, 9, 12, 15]] == 1)
    assert np.isnan(found.known_weight[1])
    assert "what is known of point 6 is" in "\n".join(found.diagnostics.warnings)
    without = adjusted(flight, control(flight, 0.03, [0, 3, 9, 12, 15]))
    # as if it were not there, but for what its weight leaves
    assert np.allclose(found.pose, without.pose, atol=0.5 * without.sigma.max())


def test_control_points_that_fit_keep_their_weight(flight):
    found = adjusted(flight, control(flight, 0.03, [0, 3, 6, 9]))
    assert found.diagnostics.contradictions == ()
    assert np.all(found.known_sigmas[[0, 3, 6, 9]] < 4)
    assert found.known_weight[[0, 3, 6, 9]].tolist() == [1.0] * 4


def test_sigmas_of_a_known_point_are_those_of_what_all_else_says():
    rest, stated = np.diag([0.04, 0.01, 0.09]), np.diag([0.01, 0.01, 0.01])
    known = KnownPoints(np.array([[0.6, 0.0, 0.0]]), np.linalg.inv(stated)[None])
    for weight in (1.0, 0.1):
        covariance = np.linalg.inv(np.linalg.inv(rest) + weight * known.information[0])
        point = covariance @ (weight * known.information[0] @ known.position_m[0])
        found = fit_of_known(known, np.array([weight]), point[None], covariance[None])
        assert found.sigmas[0] == pytest.approx(0.6 / np.sqrt(0.05) / np.sqrt(3))


def test_heights_that_err_in_common_do_not_pull_the_pose(flight):
    wrong = flight.points_m + [0.0, 0.0, 0.3] + 0.05 * np.random.default_rng(2).standard_normal((24, 3))
    information = np.tile(HEIGHT / 0.05**2, (24, 1, 1))
    found = adjusted(flight, KnownPoints(wrong, information, np.ones(24), 0.5))
    assert found.common_shift_m == pytest.approx(-0.3, abs=4 * found.common_shift_sigma_m)
    assert 0.02 < found.common_shift_sigma_m < 0.5
    alone = adjusted(flight, KnownPoints(wrong, information))
    assert np.isnan(alone.common_shift_m)
    assert np.max(np.abs(found.pose - flight.pose) / found.sigma) < 3.5


def test_points_on_a_sloping_surface(flight):
    slope = np.array([0.1, -0.05])

    def surface(north_east_m):
        return 2.0 + north_east_m @ slope, np.tile(slope, (len(north_east_m), 1))

    known = KnownPoints(
        np.zeros((24, 3)),
        np.zeros((24, 3, 3)),
        surface=surface,
        on_surface=np.arange(24) < 20,
        surface_sigma_m=0.01,
    )
    position, information = known.at(flight.points_m)
    assert np.all(information[20:] == 0)
    normal = np.array([*-slope, 1.0])
    assert np.allclose(information[0], np.outer(normal, normal) / 0.01**2)
    found = adjusted(flight, known)
    off = found.points_m[:20, 2] - surface(found.points_m[:20, :2])[0]
    # tied to the surface, where the ground truly is not
    assert np.abs(off).max() < 0.1
    assert position.shape == (24, 3)

"""The pose at given levels: within its sigmas, and hardly moved by tie points of which a third is wrong."""

import numpy as np
import pytest

from linepose.adjustment.at_levels import pose_at_levels
from linepose.geometry import rotations
from linepose.simulation.flight import FlightSettings, simulate_flight
from linepose.simulation.flight_layouts import LAYOUTS


@pytest.mark.parametrize("wrong_share", [0.0, 0.3])
def test_the_pose_of_a_flight_and_which_matches_are_wrong(wrong_share):
    flight = simulate_flight(FlightSettings(n_points=60, wrong_share=wrong_share), seed=11)
    found = pose_at_levels(flight.survey, flight.camera, flight.hand_pose, flight.hand_covariance)
    assert found.converged
    first, second = (rotations.matrix_from_rotation_vector(one[3:]) for one in (found.pose, flight.pose))
    turn = rotations.rotation_vector_from_matrix(first @ second.T)
    sigma = np.sqrt(np.diag(found.covariance))
    # a normal error is beyond 4 sigmas once in 16,000; wrong points widen the error by less than 1.5
    assert np.all(np.abs(turn) < 4 * 1.5 * sigma[3:])
    assert np.all(sigma[3:] < np.deg2rad(0.15))
    lowest = np.nanmin(found.measurement_weight, axis=0)
    assert np.mean(lowest[~flight.wrong] > 0.2) > 0.9
    if wrong_share:
        assert np.mean(lowest[flight.wrong] < 0.2) > 0.8


@pytest.mark.parametrize(("layout", "wrong_px", "seed"), [("there-and-back", 30.0, 3), ("crossed", 200.0, 5)])
def test_wrong_points_that_a_step_would_throw_behind_the_camera(layout, wrong_px, seed):
    """Rays of one point that are nearly parallel, one of them wrong, meet above the flight."""
    settings = FlightSettings(strips=LAYOUTS[layout], n_points=60, wrong_share=0.5, wrong_px=wrong_px)
    flight = simulate_flight(settings, seed)
    found = pose_at_levels(flight.survey, flight.camera, flight.hand_pose, flight.hand_covariance)
    first, second = (rotations.matrix_from_rotation_vector(one[3:]) for one in (found.pose, flight.pose))
    turn = rotations.rotation_vector_from_matrix(first @ second.T)
    assert np.all(np.abs(turn) < 4 * 1.5 * np.sqrt(np.diag(found.covariance))[3:])

"""From the air the search begins at the feet of rays on the ground, and comes to the same estimate from far off."""

import numpy as np
import pytest

from linepose.adjustment.estimate import unit_weights
from linepose.adjustment.hand_measured import hand_measured
from linepose.adjustment.known_points import KnownPoints
from linepose.adjustment.levels import START
from linepose.adjustment.measurements import measurements_from_survey
from linepose.adjustment.solve import solve
from linepose.adjustment.start import start_points
from linepose.adjustment.state import Knowledge, state_at
from linepose.geometry.rotations import matrix_from_rotation_vector, rotation_vector_from_matrix
from linepose.simulation.flight import FlightSettings, simulate_flight
from linepose.simulation.flight_layouts import LAYOUTS


def flight_and_measurements(layout="crossed", known=None):
    flight = simulate_flight(FlightSettings(strips=LAYOUTS[layout], n_points=30), 7)
    return flight, measurements_from_survey(flight.survey, flight.camera, known, flight.line_period_s)


def moved(pose, degrees, metres, random):
    """A pose (6,) turned and shifted by so much in a random direction."""
    axis, shift = random.standard_normal((2, 3))
    turn = matrix_from_rotation_vector(np.deg2rad(degrees) * axis / np.linalg.norm(axis))
    rotation = rotation_vector_from_matrix(turn @ matrix_from_rotation_vector(pose[3:]))
    return np.concatenate([pose[:3] + metres * shift / np.linalg.norm(shift), rotation])


@pytest.mark.parametrize("layout", ["crossed", "one-height"])
@pytest.mark.parametrize("prior", [True, False])
def test_the_same_optimum_from_20_degrees_and_3_metres(layout, prior):
    flight, measurements = flight_and_measurements(layout)
    hand = hand_measured(flight.hand_pose, flight.hand_covariance) if prior else None
    knowledge, random = Knowledge(flight.camera, hand), np.random.default_rng(1)
    found = []
    for pose in [flight.pose, *(moved(flight.pose, 20.0, 3.0, random) for _ in range(3))]:
        start = state_at(pose, flight.camera, start_points(measurements, flight.camera, pose), measurements)
        solution = solve(measurements, knowledge, start, START, unit_weights(measurements))
        assert solution.converged
        found.append([solution.done.chi_squared, *solution.state.pose])
    assert np.allclose(found, found[0], atol=1e-4)


def test_feet_lie_on_the_ground():
    flight, measurements = flight_and_measurements()
    start = start_points(measurements, flight.camera, flight.pose)
    # the relief is 1 m, the ground is at 0; swaths are narrow, so that a foot on the mean ground is a metre off at most
    assert np.abs(start[:, 2]).max() < 5.0
    assert np.abs(start[:, :2] - flight.points_m[measurements.points, :2]).max() < 2.5


def test_known_heights_are_taken_from_the_start():
    flight = simulate_flight(FlightSettings(n_points=30), 7)
    information = np.zeros((30, 3, 3))
    information[:, 2, 2] = 1.0
    known = KnownPoints(np.column_stack([np.zeros((30, 2)), flight.points_m[:, 2]]), information)
    _, measurements = flight_and_measurements(known=known)
    far_off = moved(flight.pose, 20.0, 3.0, np.random.default_rng(2))
    start = start_points(measurements, flight.camera, far_off)
    assert np.allclose(start[:, 2], flight.points_m[measurements.points, 2])

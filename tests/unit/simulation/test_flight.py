"""Simulated flights: points are seen where the camera says, errors are as asked for, the seed repeats all."""

from dataclasses import replace

import numpy as np
import pytest

from linepose.geometry import rotations
from linepose.simulation.flight import FlightSettings, simulate_flight
from linepose.simulation.flight_layouts import LAYOUTS
from linepose.simulation.settings import NavigationErrorSettings

FAULTLESS = FlightSettings(n_points=60, pixel_px=0.0, lateness_lines=0.0, navigation_error=NavigationErrorSettings())


def misses(flight):
    """How far off the measurements are (L, 2) at the true pose and points, along and across the line (px)."""
    survey = flight.survey
    row, column = np.nonzero(np.isfinite(survey.u_px))
    body = rotations.matrix_from_euler(survey.euler_rad[row, column])
    away = flight.points_m[column] - survey.position_m[row, column]
    in_body = np.einsum("lji,lj->li", body, away) - flight.pose[:3]
    seen = in_body @ rotations.matrix_from_rotation_vector(flight.pose[3:])
    focal_px = flight.true_camera.focal_length_px
    along = flight.true_camera.principal_point_px + focal_px * seen[:, 0] / seen[:, 2] - survey.u_px[row, column]
    return np.column_stack([along, focal_px * seen[:, 1] / seen[:, 2]])


@pytest.mark.parametrize("layout", [name for name in LAYOUTS if name != "one-strip"])
def test_without_errors_every_point_is_seen_where_it_is(layout):
    flight = simulate_flight(replace(FAULTLESS, strips=LAYOUTS[layout]), 1)
    assert np.allclose(misses(flight), 0, atol=1e-3)
    count = np.isfinite(flight.survey.u_px).sum(axis=0)
    assert flight.survey.n_points == 60
    assert count.min() >= 2
    assert count.max() <= 6


def test_errors_are_as_large_as_asked_for():
    noisy = simulate_flight(replace(FAULTLESS, n_points=400, pixel_px=0.4, lateness_lines=0.5), 2)
    off = misses(noisy)
    assert off[:, 0].std() == pytest.approx(0.4, rel=0.1)
    # a line of 5 cm at 40 to 60 m, half of which is the sigma
    assert 0.3 < off[:, 1].std() < 0.8
    drifting = simulate_flight(FlightSettings(n_points=400, pixel_px=0.0, lateness_lines=0.0), 3)
    assert 0.3 < misses(drifting)[:, 1].std() < 1.5


def test_bad_matches_lie_where_they_are_said_to():
    flight = simulate_flight(replace(FAULTLESS, n_points=200, wrong_share=0.5), 4)
    assert 0.4 < flight.wrong.mean() < 0.6
    far = np.hypot(*misses(flight).T) > 0.1
    column = np.nonzero(np.isfinite(flight.survey.u_px))[1]
    hit = np.bincount(column[far], minlength=200) > 0
    assert np.array_equal(hit, flight.wrong)


def test_the_seed_repeats_all():
    one, other, another = (simulate_flight(FlightSettings(n_points=20), seed).survey for seed in (5, 5, 6))
    assert np.array_equal(one.u_px, other.u_px, equal_nan=True)
    assert not np.array_equal(one.u_px, another.u_px, equal_nan=True)

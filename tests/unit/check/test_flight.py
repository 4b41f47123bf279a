"""Planned strips promise what an adjustment of the flown ones states, and are told what would cure them."""

import numpy as np

from linepose.adjustment import AdjustmentSettings, adjust
from linepose.adjustment.levels import LevelPriors, Levels
from linepose.check.finding import Level
from linepose.check.flight import flight_findings, planned
from linepose.check.replay import in_camera
from linepose.config.platform import Platform
from linepose.estimation.identifiability import in_body_axes
from linepose.geometry.camera import pixel_from_normalised
from linepose.geometry.pose import POSE_COLUMNS
from linepose.simulation.flight import FLIGHT_CAMERA, FlightSettings, simulate_flight
from linepose.simulation.flight_layouts import LAYOUTS
from linepose.simulation.planned_flight import planned_flight

N_POINTS = 20


def platform(layout, n_points=N_POINTS, **changed):
    """A platform with the strips of a layout, whose camera and errors are those of simulated flights."""
    strips = [
        {
            "north_m": one.north_m,
            "east_m": one.east_m,
            "heading_deg": float(np.rad2deg(one.heading_rad)),
            "height_m": one.height_m,
            "duration_s": one.duration_s,
        }
        for one in layout
    ]
    hand = {"position_m": [0.15, 0.05, 0.1], "euler_deg": [0, 0, 90], "sigma_position_m": 0.05, "sigma_rotation_deg": 1}
    return Platform.model_validate(
        {
            "camera": FLIGHT_CAMERA.model_dump(),
            "hand_measured": hand | changed,
            "source": {"kind": "scans", "points": "matching", "matching": {"ground_height_m": 0, "n_points": n_points}},
            "flight": {
                "seed": 3,
                "true_position_m": [0.15, 0.05, 0.1],
                "true_euler_deg": [0, 0, 90],
                "strips": strips,
                "navigation_error": {"yaw_deg": 0.08},
            },
        }
    )


def test_rays_of_a_planned_flight_meet_its_points():
    pose = np.concatenate([[0.15, 0.05, 0.1], [0.0, 0.0, np.pi / 2]])
    reported = platform(LAYOUTS["crossed"]).flight.navigation_error.reported
    flown = planned_flight(FlightSettings(n_points=60), FLIGHT_CAMERA, pose, reported, 3)
    row, column = np.nonzero(np.isfinite(flown.survey.u_px))
    body = flown.survey.position_m[row, column], flown.survey.euler_rad[row, column]
    seen = in_camera(pose, *body, flown.points_m[column])
    assert np.abs(seen[:, 1] / seen[:, 2]).max() < 1e-4
    u_px = pixel_from_normalised(FLIGHT_CAMERA, seen[:, 0] / seen[:, 2])
    assert np.abs(u_px - flown.survey.u_px[row, column]).max() < 0.1
    count = np.bincount(column)
    assert count.min() >= 2
    assert count.max() <= 6


def test_predicted_sigmas_are_those_of_an_adjustment():
    """At the levels of the errors that are flown; ones that are estimated make sigmas wider, by up to 1.8 times."""
    _, sigmas = flight_findings(platform(LAYOUTS["crossed"]))
    flight = simulate_flight(FlightSettings(n_points=N_POINTS), 12)
    known = LevelPriors(median=Levels(1.0, 0.3, 0.01, 1.0, 0.5, 60.0, 1.0), log_sigma=Levels(*[0.05] * 7))
    quick = AdjustmentSettings(
        priors=known, n_draws=10, n_samples=10, max_rounds=2, tails=False, line_period_s=flight.line_period_s
    )
    found = adjust(flight.survey, flight.camera, flight.hand_pose, flight.hand_covariance, quick)
    _, covariance = in_body_axes(POSE_COLUMNS, found.pose, found.covariance)
    ratio = np.sqrt(np.diag(covariance)) / [one.predicted for one in sigmas]
    assert np.all((ratio > 0.8) & (ratio < 1.4)), ratio


def test_one_height_leaves_pitch_to_the_forward_lever_and_its_cures_are_told():
    findings, sigmas = flight_findings(platform(LAYOUTS["one-height"], 100))
    (finding,) = findings
    assert finding.level == Level.WARNING
    assert "the turn about right" in finding.found
    assert "not told apart from the forward lever (correlation -0.9" in finding.found
    assert "fly a second height, every other pair of strips at 60 m" in finding.advice
    assert "measure the lever to 1 cm" in finding.advice
    measured = planned(platform(LAYOUTS["one-height"], 100, sigma_position_m=0.01)).covariance()
    assert np.sqrt(measured[4, 4]) < 0.7 * sigmas[4].predicted


def test_two_heights_and_strips_across_need_no_cure():
    findings, sigmas = flight_findings(platform(LAYOUTS["crossed"], 100, sigma_position_m=0.02))
    assert [one.level for one in findings] == [Level.OK]
    assert all(one.predicted < 1e-3 for one in sigmas[3:])


def test_strips_apart_are_told():
    findings, sigmas = flight_findings(platform(LAYOUTS["one-strip"]))
    assert findings[0].level == Level.ERROR
    assert "0 of the points on the ground in two strips" in findings[0].found
    assert sigmas == ()

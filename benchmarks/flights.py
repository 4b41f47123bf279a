"""Simulated flights without a board, adjusted: how far the boresight is off, and how honest its sigmas are.

    python benchmarks/flights.py crossed --flights 40 --seed 1
    python benchmarks/flights.py --list

Each row of docs/without-a-board.md is one case. Seeds that were used while building must not be reported.
"""

import argparse
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.special import chdtri

from linepose.adjustment import Adjustment, AdjustmentSettings, adjust
from linepose.adjustment.known_points import KnownPoints
from linepose.arrays import Floats
from linepose.errors import EstimationError, InputError
from linepose.geometry import rotations
from linepose.simulation.flight import Flight, FlightSettings, drifting, simulate_flight
from linepose.simulation.flight_layouts import LAYOUTS, parallel

SHARES = (0.68, 0.95)
SHOWN = 5  # flights between two rows on the error stream
TERRAIN_SIGMA_M, TERRAIN_SHIFT_SIGMA_M = 0.2, 0.5


@dataclass(frozen=True)
class Case:
    """A row: the flight, and what is known of its points; far: how far off the search starts (deg, m)."""

    settings: FlightSettings
    known: Callable[[Flight, np.random.Generator], KnownPoints] | None = None
    far: tuple[float, float] | None = None


@dataclass(frozen=True)
class Outcome:
    """Of one flight: turn_rad (3,), how far the boresight is off about the body's axes, and its covariance (3, 3)."""

    turn_rad: Floats
    turn_covariance: Floats
    lever_m: Floats
    lever_sigma_m: Floats
    seconds: float
    found: Adjustment


def terrain_off(flight: Flight, random: np.random.Generator) -> KnownPoints:
    """A terrain model that lies 0.3 m too low as a whole, and errs by 0.2 m from point to point."""
    n = len(flight.points_m)
    wrong = flight.points_m + np.array([0.0, 0.0, 0.3])
    wrong[:, 2] += TERRAIN_SIGMA_M * random.standard_normal(n)
    information = np.tile(np.diag([0.0, 0.0, TERRAIN_SIGMA_M**-2]), (n, 1, 1))
    return KnownPoints(wrong, information, np.ones(n), TERRAIN_SHIFT_SIGMA_M)


def terrain_taken_for_right(flight: Flight, random: np.random.Generator) -> KnownPoints:
    """The same, taken for free of any error in common."""
    off = terrain_off(flight, random)
    return KnownPoints(off.position_m, off.information)


CASES = {
    "crossed": Case(FlightSettings(n_points=200)),
    "crossed-100": Case(FlightSettings(n_points=100)),
    "one-height": Case(FlightSettings(strips=LAYOUTS["one-height"], n_points=200)),
    "drift-10-s": Case(FlightSettings(n_points=200, navigation_error=drifting(10.0))),
    "drift-300-s": Case(FlightSettings(n_points=200, navigation_error=drifting(300.0))),
    "far": Case(FlightSettings(n_points=200), far=(20.0, 3.0)),
    "half-wrong": Case(FlightSettings(n_points=200, wrong_share=0.5)),
    "two-strips": Case(FlightSettings(strips=LAYOUTS["two-strips"], n_points=60), terrain_off),
    "two-strips-taken-for-right": Case(
        FlightSettings(strips=LAYOUTS["two-strips"], n_points=60), terrain_taken_for_right
    ),
    "one-strip": Case(FlightSettings(strips=LAYOUTS["one-strip"], n_points=60, fewest_strips=1), terrain_off),
    "many": Case(FlightSettings(strips=parallel(16, (40.0, 60.0), 5.0, 60.0), n_points=10_000)),
}


def main() -> None:
    """Measure what is asked for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("cases", nargs="*", default=["crossed"], help="which cases")
    parser.add_argument("--flights", type=int, default=40)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--list", action="store_true", help="name the cases")
    asked = parser.parse_args()
    if asked.list:
        print("\n".join(CASES))
        return
    for name in asked.cases:
        outcomes, failed = [], 0
        for flight in range(asked.flights):
            try:
                outcomes.append(outcome(CASES[name], np.random.default_rng([asked.seed, flight])))
            except (EstimationError, InputError) as error:
                failed += 1
                print(f"{name}, flight {flight}: {error}", flush=True)
            if outcomes and not (flight + 1) % SHOWN:
                print(in_words(name, outcomes, failed), file=sys.stderr, flush=True)
        if outcomes:
            print(in_words(name, outcomes, failed), flush=True)


def outcome(case: Case, random: np.random.Generator) -> Outcome:
    """One flight, drawn and adjusted."""
    flight = simulate_flight(case.settings, random)
    settings = AdjustmentSettings(line_period_s=flight.line_period_s, n_samples=10)
    start = None if case.far is None else moved(flight.hand_pose, *case.far, random)
    known = None if case.known is None else case.known(flight, random)
    began = time.perf_counter()
    found = adjust(
        flight.survey, flight.camera, flight.hand_pose, flight.hand_covariance, settings, known, start_pose=start
    )
    seconds = time.perf_counter() - began
    by_turn = np.eye(6)
    by_turn[3:, 3:] = rotations.left_jacobian_so3(found.pose[3:])
    covariance = by_turn @ found.covariance @ by_turn.T
    turn = rotations.matrix_from_rotation_vector(found.pose[3:])
    turn = turn @ rotations.matrix_from_rotation_vector(flight.pose[3:]).T
    return Outcome(
        rotations.rotation_vector_from_matrix(turn),
        covariance[3:, 3:],
        found.pose[:3] - flight.pose[:3],
        found.sigma[:3],
        seconds,
        found,
    )


def moved(pose: Floats, degrees: float, metres: float, random: np.random.Generator) -> Floats:
    """A pose (6,) turned and shifted by so much in a random direction."""
    axis, shift = random.standard_normal((2, 3))
    turn = rotations.matrix_from_rotation_vector(np.deg2rad(degrees) * axis / np.linalg.norm(axis))
    rotation = turn @ rotations.matrix_from_rotation_vector(pose[3:])
    shifted = pose[:3] + metres * shift / np.linalg.norm(shift)
    return np.concatenate([shifted, rotations.rotation_vector_from_matrix(rotation)])


def in_words(name: str, outcomes: list[Outcome], failed: int) -> str:
    """One row: errors, what was stated, how often the regions hold the truth, seconds."""
    error = np.array([one.turn_rad for one in outcomes])
    covariance = np.array([one.turn_covariance for one in outcomes])
    sigma = np.sqrt(np.diagonal(covariance, axis1=1, axis2=2))
    square = np.einsum("fi,fij,fj->f", error, np.linalg.inv(covariance), error)
    held = [float(np.mean(square < chdtri(3, 1 - share))) for share in SHARES]
    lever = np.array([one.lever_m for one in outcomes])
    lever_sigma = np.array([one.lever_sigma_m for one in outcomes])
    seconds = [one.seconds for one in outcomes]
    parts = [
        f"{name}, {len(outcomes)} flights, {failed} failed",
        f"RMS about forward, right, down {numbers(1e3 * rms(error))} mrad",
        f"median {numbers(1e3 * np.median(np.abs(error), axis=0) / 0.6745)}",
        f"stated {numbers(1e3 * rms(sigma))}",
        f"ratio {numbers(rms(error / sigma))}",
        f"68/95 hold {held[0]:.2f}/{held[1]:.2f}",
        f"lever {numbers(1e3 * rms(lever))} mm, ratio {numbers(rms(lever / lever_sigma))}",
        f"{np.median(seconds):.1f} s each",
        f"{sum(bool(one.found.diagnostics.open_directions) for one in outcomes)} with open directions",
    ]
    return "; ".join(parts)


def rms(values: Floats) -> Floats:
    """Root mean square (A,) of rows (F, A)."""
    return np.sqrt(np.mean(values**2, axis=0))


def numbers(values: Floats) -> str:
    """Three numbers for people."""
    return " ".join(f"{value:.2f}" for value in values)


if __name__ == "__main__":
    main()

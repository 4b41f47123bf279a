"""What a planned flight will tell of the pose, before it is flown: predicted sigmas, the worst direction, its cure.

The strips are flown over points as a match would find them, and the normal equations of that geometry say what they
bring, at the navigation's errors as they are reported. Cures are no rules of thumb: each is put into the plan, and
told where it brings more than a quarter.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from linepose.adjustment.known_points import KnownPoints
from linepose.adjustment.levels import LEAST, Levels
from linepose.adjustment.prediction import predicted_covariance
from linepose.arrays import Floats
from linepose.check.finding import Finding, PredictedSigma, error, ok, warning
from linepose.config.platform import Platform
from linepose.errors import EstimationError, InputError
from linepose.estimation.identifiability import TURN_NAMES, WORDS
from linepose.geometry.camera import Camera
from linepose.inputs.source import ScansSection
from linepose.simulation.flight import FlightSettings
from linepose.simulation.flight_layouts import Strip
from linepose.simulation.flight_section import FlightSection
from linepose.simulation.planned_flight import planned_flight

SUBJECT: Final = "planned strips"
_FEWEST: Final = 10  # points that two strips or more see
_MOST_POINTS: Final = 150  # of the plan: more hardly help, since the navigation limits
_LATENESS_LINES: Final = 0.5  # of time stamps; a platform file of a plan rarely says it
_WORTH: Final = 0.75  # of the worst sigma, to which a cure must bring it
_TIED: Final = 0.8  # correlation from which on two numbers are told together
_LEFT: Final = 0.9  # of the hand measurement's sigma: what the flight does not tell
_SECOND_HEIGHT: Final = 1.5
_TAPE_M: Final = 0.01
_FOCAL_SHARE: Final = 0.1
_NAMES: Final = ("r_x_m", "r_y_m", "r_z_m", *TURN_NAMES)
_AXES: Final = {"r_x_m": "forward lever", "r_y_m": "lever to the right", "r_z_m": "lever down"}


@dataclass(frozen=True)
class Plan:
    """Strips, camera, hand-measured pose (6,) with covariance (6, 6), and the rest of a flight as it will be.

    prior: whether the hand measurement counts.
    """

    strips: tuple[Strip, ...]
    camera: Camera
    pose: Floats
    hand_covariance: Floats
    section: FlightSection
    n_points: int
    prior: bool
    ground_sigma_m: tuple[float, float | None] | None  # of each height by itself, and of all in common

    def covariance(self) -> Floats:
        """Covariance (6, 6) of position (m) and turns about the body's axes (rad) that the flight will bring.

        Raises InputError where fewer than ten points are seen twice, or the navigation reports no sigma.
        """
        section = self.section
        settings = FlightSettings(
            strips=self.strips,
            n_points=self.n_points,
            relief_m=section.ground.relief_m,
            speed_m_s=section.speed_m_s,
            turn_s=section.turn_s,
        )
        errors = section.navigation_error
        flown = planned_flight(settings, self.camera, self.pose, errors.reported, section.seed)
        if len(flown.points_m) < _FEWEST:
            found = f"{len(flown.points_m)} of the points on the ground in two strips"
            raise InputError("flight.strips", found, f"{_FEWEST} or more", "fly strips closer, or across each other")
        levels = Levels(
            1.0, max(errors.white_share, LEAST), LEAST, 1.0, _LATENESS_LINES, errors.correlation_time_s, 1.0
        )
        return predicted_covariance(
            flown.survey,
            self.camera,
            self.pose,
            flown.points_m,
            levels,
            self.hand_covariance if self.prior else None,
            self._known(flown.points_m),
            1 / section.line_rate_hz,
        )

    def _known(self, points_m: Floats) -> KnownPoints | None:
        if self.ground_sigma_m is None:
            return None
        alone, shift = self.ground_sigma_m
        information = np.tile(np.diag([0.0, 0.0, alone**-2]), (len(points_m), 1, 1))
        return KnownPoints(points_m, information, np.full(len(points_m), float(shift is not None)), shift)


def planned(settings: Platform) -> Plan:
    """The plan of a platform with a section `flight`."""
    section, source = settings.flight, settings.source
    assert section is not None
    ground = None if settings.points is None else settings.points.ground
    n_points = source.matching.n_points if isinstance(source, ScansSection) else _MOST_POINTS
    return Plan(
        tuple(one.strip for one in section.strips),
        settings.intrinsics(),
        settings.start_pose(),
        settings.hand_measured.body_covariance,
        section,
        min(n_points, _MOST_POINTS),
        settings.pose_prior() is not None,
        None if ground is None else (ground.sigma_m, ground.shift_sigma_m),
    )


def flight_findings(settings: Platform) -> tuple[list[Finding], tuple[PredictedSigma, ...]]:
    """What is predicted of a platform's planned strips."""
    plan = planned(settings)
    try:
        covariance = plan.covariance()
    except InputError as fault:
        return [error(SUBJECT, f"{fault.place}: {fault.found}, expected {fault.expected}", fault.remedy)], ()
    except EstimationError as fault:
        return [error(SUBJECT, str(fault), "correct hand_measured.euler_deg, or fly other strips")], ()
    sigma, by_hand = np.sqrt(np.diag(covariance)), np.sqrt(np.diag(plan.hand_covariance))
    sigmas = tuple(
        PredictedSigma(WORDS[name], "m" if name in _AXES else "rad", float(by_hand[k]), float(sigma[k]))
        for k, name in enumerate(_NAMES)
    )
    worst = _worst(plan, sigma)
    found = f"{len(plan.strips)} strips; {_in_words(covariance, worst, plan)}{_left(sigma, by_hand)}"
    better = sorted(_cures(plan, worst, float(sigma[worst])), key=lambda one: one[1])
    if not better:
        return [ok(SUBJECT, found)], sigmas
    ways = "; or ".join(f"{words}: to {1e3 * value:.2g} mrad" for words, value in better[:2])
    return [warning(SUBJECT, found, ways)], sigmas


def _worst(plan: Plan, sigma: Floats) -> int:
    """Which of the six is the angle that misplaces most on the ground: half a swath turns with yaw, all else tilts."""
    half_swath = 0.5 * plan.camera.n_pixels / plan.camera.focal_length_px
    return 3 + int(np.argmax(sigma[3:] * [1.0, 1.0, half_swath]))


def _in_words(covariance: Floats, worst: int, plan: Plan) -> str:
    """The worst angle, what it does on the ground, and the number that it is tied to."""
    sigma = np.sqrt(np.diag(covariance))
    height_m = max(one.height_m for one in plan.strips)
    tied = covariance[worst] / (sigma[worst] * sigma)
    tied[worst] = 0.0
    most = int(np.argmax(np.abs(tied)))
    words = f"worst is {WORDS[_NAMES[worst]]}, {1e3 * sigma[worst]:.2g} mrad"
    if worst < 5:
        words += f" ({1e3 * sigma[worst] * height_m:.0f} mm on the ground from {height_m:g} m)"
    if abs(tied[most]) < _TIED:
        return words
    name = _AXES.get(_NAMES[most], WORDS[_NAMES[most]])
    return f"{words}, which is not told apart from the {name.removeprefix('the ')} (correlation {tied[most]:.2f})"


def _left(sigma: Floats, by_hand: Floats) -> str:
    left = [WORDS[_NAMES[k]] for k in np.flatnonzero(sigma > _LEFT * by_hand)]
    return f"; left to the hand measurement: {', '.join(left)}" if left else ""


def _cures(plan: Plan, worst: int, sigma: float) -> Iterator[tuple[str, float]]:
    """Changes of the plan in words, with the worst sigma that they bring, of those that are worth it."""
    for words, changed in _changes(plan):
        try:
            value = float(np.sqrt(changed.covariance()[worst, worst]))
        except (EstimationError, InputError):
            continue
        if value < _WORTH * sigma:
            yield words, value


def _changes(plan: Plan) -> Iterator[tuple[str, Plan]]:
    heights = [one.height_m for one in plan.strips]
    if max(heights) < _SECOND_HEIGHT * min(heights):
        second = _SECOND_HEIGHT * min(heights)
        if len(plan.strips) > 2:
            every = tuple(replace(one, height_m=second) if k // 2 % 2 else one for k, one in enumerate(plan.strips))
            yield f"fly a second height, every other pair of strips at {second:g} m", replace(plan, strips=every)
        else:
            again = tuple(replace(one, height_m=second) for one in plan.strips)
            yield f"fly the strips again at {second:g} m", replace(plan, strips=(*plan.strips, *again))
    back = tuple(replace(one, heading_rad=one.heading_rad + np.pi * (k % 2)) for k, one in enumerate(plan.strips))
    if all(np.cos(one.heading_rad - plan.strips[0].heading_rad) > 0 for one in plan.strips):
        yield "fly every other strip back", replace(plan, strips=back)
    north_m = float(np.mean([one.north_m for one in plan.strips]))
    east_m = float(np.mean([one.east_m for one in plan.strips]))
    across = tuple(
        Strip(north_m, east_m, plan.strips[0].heading_rad + np.pi / 2 + np.pi * k, height, plan.strips[0].duration_s)
        for k, height in enumerate((min(heights), max(heights)))
    )
    yield "fly two more strips across these, there and back", replace(plan, strips=(*plan.strips, *across))
    measured = plan.hand_covariance.copy()
    measured[:3, :3] = np.minimum(measured[:3, :3], np.eye(3) * _TAPE_M**2)
    if plan.prior and not np.allclose(measured, plan.hand_covariance):
        words = "measure the lever to 1 cm (hand_measured.sigma_position_m: 0.01)"
        yield words, replace(plan, hand_covariance=measured)
    camera = plan.camera
    known = camera.sigmas.replaced(focal_length_m=_FOCAL_SHARE * camera.sigmas.focal_length_m)
    words = f"measure the focal length to {1e3 * known.focal_length_m:.2g} mm (camera.sigmas.focal_length_m)"
    yield words, replace(plan, camera=camera.replaced(sigmas=known))
